#include "core/exa/topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "core/base/budget.h"
#include "core/base/parallel.h"
#include "core/exa/bitstream.h"
#include "core/exa/range_coder.h"

namespace dubsar {
namespace {
constexpr int kTop = 5;              // spacing 32: raw signs of the top lattice cost 1/32768 bit per grid point
constexpr std::size_t kStep = 4096;  // cells between looks at `progress`
constexpr std::array<int, 7> kPhases{7, 6, 5, 3, 4, 2, 1};  // bit a: the point is new along axis a

using Point = std::array<std::int64_t, 3>;
using Cell = std::array<std::uint16_t, 3>;

/// Cells of spacing 2^level along an axis; a volume one point thick has one cell without extent.
std::int64_t cells_along(std::int64_t dim, int level) {
  return std::max<std::int64_t>(1, (dim - 1 + (std::int64_t{1} << level) - 1) >> level);
}
Dims cells_of(const Dims& d, int level) {
  return {cells_along(d.x, level), cells_along(d.y, level), cells_along(d.z, level)};
}

std::vector<std::int64_t> top_coordinates(std::int64_t dim) {
  std::vector<std::int64_t> found;
  for (std::int64_t c = 0; c < dim - 1; c += std::int64_t{1} << kTop) found.push_back(c);
  found.push_back(dim - 1);
  return found;
}

/// Level 1 cells, of at most 3x3x3 points, that contain both signs.
BitVolume active_cells(const BitVolume& signs) {
  const Dims& dims = signs.dims();
  BitVolume active(cells_of(dims, 1));
  const Dims& cells = active.dims();
  const std::int64_t words = signs.words_per_row();
  parallel_chunks(cells.y * cells.z, 64, [&](std::int64_t begin, std::int64_t end) {
    std::vector<std::uint64_t> any(static_cast<std::size_t>(words) + 1), all(static_cast<std::size_t>(words) + 1);
    for (std::int64_t r = begin; r < end; ++r) {
      const std::int64_t y = r % cells.y, z = r / cells.y;
      std::fill(any.begin(), any.end(), 0);
      std::fill(all.begin(), all.end(), ~std::uint64_t{0});
      for (std::int64_t pz = 2 * z; pz <= std::min(2 * z + 2, dims.z - 1); ++pz)
        for (std::int64_t py = 2 * y; py <= std::min(2 * y + 2, dims.y - 1); ++py) {
          const std::uint64_t* row = signs.row(py, pz);
          for (std::int64_t w = 0; w < words; ++w) {
            any[static_cast<std::size_t>(w)] |= row[w];
            all[static_cast<std::size_t>(w)] &= row[w];
          }
        }
      if (dims.x % 64 != 0) all[static_cast<std::size_t>(words) - 1] |= ~std::uint64_t{0} << (dims.x % 64);
      for (std::size_t w = 0; w < static_cast<std::size_t>(words); ++w) {
        const std::uint64_t o = any[w] | any[w] >> 1 | any[w + 1] << 63 | any[w] >> 2 | any[w + 1] << 62;
        const std::uint64_t n = all[w] & (all[w] >> 1 | all[w + 1] << 63) & (all[w] >> 2 | all[w + 1] << 62);
        for (std::uint64_t mixed = o & ~n & 0x5555555555555555ULL; mixed != 0; mixed &= mixed - 1) {
          const std::int64_t x = static_cast<std::int64_t>(w) * 32 + std::countr_zero(mixed) / 2;
          if (x < cells.x) active.set(x, y, z, true);
        }
      }
    }
  });
  return active;
}

/// Cells of the next coarser level with an active child.
BitVolume coarser(const BitVolume& fine, const Dims& dims) {
  BitVolume active(dims);
  for (std::int64_t z = 0; z < fine.dims().z; ++z)
    for (std::int64_t y = 0; y < fine.dims().y; ++y) {
      const std::uint64_t* row = fine.row(y, z);
      for (std::int64_t w = 0; w < fine.words_per_row(); ++w)
        for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1)
          active.set((w * 64 + std::countr_zero(bits)) / 2, y / 2, z / 2, true);
    }
  return active;
}

void fill_ones(BitVolume& signs, const Point& low, const Point& high) {
  const std::int64_t first = low[0] >> 6, last = high[0] >> 6;
  const std::uint64_t head = ~std::uint64_t{0} << (low[0] & 63), tail = ~std::uint64_t{0} >> (63 - (high[0] & 63));
  for (std::int64_t z = low[2]; z <= high[2]; ++z)
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      std::uint64_t* row = signs.row(y, z);
      for (std::int64_t w = first; w <= last; ++w)
        row[w] |= (w == first ? head : ~std::uint64_t{0}) & (w == last ? tail : ~std::uint64_t{0});
    }
}

/// Encoder and decoder walk the same way; Coder says what a bit is.
template <class Coder>
class Walk {
 public:
  Walk(Coder& coder, Progress& progress) : coder_(coder), progress_(progress), dims_(coder.signs().dims()) {
    size_ = {dims_.x, dims_.y, dims_.z};
    point_models_.resize(3 * (kCentreModels + 3 * kFaceModels + 3 * kEdgeModels));
  }

  Result<void> run() {
    DUBSAR_TRY(top());
    for (level_ = kTop - 1; level_ >= 0; --level_) {
      step_ = std::int64_t{1} << level_;
      parents_along_ = {parents_.dims().x, parents_.dims().y, parents_.dims().z};
      for (const int phase : kPhases) {
        for (std::size_t c = 0; c < list_.size(); ++c) {
          new_points(list_[c], phase);
          if (c % kStep == 0) DUBSAR_TRY(look());
        }
      }
      DUBSAR_TRY(children());
      progress_.advance(1);
    }
    return look();
  }

 private:
  static constexpr std::size_t kCentreModels = 1 << 11, kFaceModels = 1 << 9, kEdgeModels = 1 << 13;

  Result<void> look() const {
    if (progress_.cancelled()) return cancelled_error();
    if (coder_.exhausted()) return fail(ErrorKind::kBadData, "exa: the sign code ends too early");
    return {};
  }

  bool sign(const Point& p) const { return coder_.signs().get(p[0], p[1], p[2]); }

  Point low(const Cell& cell, int level) const {
    return {std::int64_t{cell[0]} << level, std::int64_t{cell[1]} << level, std::int64_t{cell[2]} << level};
  }
  Point high(const Point& low_corner, int level) const {
    Point p;
    for (std::size_t a = 0; a < 3; ++a) p[a] = std::min(low_corner[a] + (std::int64_t{1} << level), size_[a] - 1);
    return p;
  }
  /// Number of corners that are inside, 0..8.
  int inside_corners(const Point& a, const Point& b) const {
    int count = 0;
    for (int c = 0; c < 8; ++c) count += sign({c & 1 ? b[0] : a[0], c & 2 ? b[1] : a[1], c & 4 ? b[2] : a[2]}) ? 1 : 0;
    return count;
  }

  /// Is the cell active? Codes a flag where its corners agree and it has an inside; fills inactive cells.
  bool activity(const Cell& cell, int level, const BitVolume& known) {
    const Point a = low(cell, level), b = high(a, level);
    const int corners = inside_corners(a, b);
    if (corners != 0 && corners != 8) return true;
    int near = 0;
    if (cell[0] > 0) near += known.get(cell[0] - 1, cell[1], cell[2]) ? 1 : 0;
    if (cell[1] > 0) near += known.get(cell[0], cell[1] - 1, cell[2]) ? 1 : 0;
    if (cell[2] > 0) near += known.get(cell[0], cell[1], cell[2] - 1) ? 1 : 0;
    if (coder_.flag(flag_models_[static_cast<std::size_t>(level * 8 + near * 2 + corners / 8)], cell, level))
      return true;
    if (corners == 8) coder_.fill(a, b);
    return false;
  }

  Result<void> top() {
    const auto xs = top_coordinates(size_[0]), ys = top_coordinates(size_[1]), zs = top_coordinates(size_[2]);
    for (const std::int64_t z : zs)
      for (const std::int64_t y : ys)
        for (const std::int64_t x : xs) coder_.raw({x, y, z});
    parents_ = BitVolume(cells_of(dims_, kTop));
    const Dims& cells = parents_.dims();
    for (std::int64_t z = 0; z < cells.z; ++z)
      for (std::int64_t y = 0; y < cells.y; ++y) {
        for (std::int64_t x = 0; x < cells.x; ++x) {
          const Cell cell{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(z)};
          if (!activity(cell, kTop, parents_)) continue;
          parents_.set(x, y, z, true);
          list_.push_back(cell);
        }
        DUBSAR_TRY(look());
      }
    return {};
  }

  Result<void> children() {
    if (level_ == 0) return {};
    const std::uint64_t most = list_.size() * 8 * sizeof(Cell);
    if (most > (std::uint64_t{256} << 20)) DUBSAR_TRY(check_memory("exa signs", most));
    std::vector<Cell> next;
    next.reserve(list_.size() * 3);
    BitVolume active(cells_of(dims_, level_));
    const std::array<std::int64_t, 3> along{active.dims().x, active.dims().y, active.dims().z};
    for (std::size_t c = 0; c < list_.size(); ++c) {
      for (int octant = 0; octant < 8; ++octant) {
        Cell child;
        bool exists = true;
        for (std::size_t a = 0; a < 3; ++a) {
          const int index = 2 * list_[c][a] + (octant >> a & 1);
          exists = exists && index < along[a];
          child[a] = static_cast<std::uint16_t>(index);
        }
        if (!exists || !activity(child, level_, active)) continue;
        active.set(child[0], child[1], child[2], true);
        next.push_back(child);
      }
      if (c % kStep == 0) DUBSAR_TRY(look());
    }
    list_ = std::move(next);
    parents_ = std::move(active);
    return {};
  }

  /// The new points of one kind that a parent owns: those in its half-open box, and at the end of the volume those on
  /// its far side.
  void new_points(const Cell& cell, int phase) {
    const Point a = low(cell, level_ + 1);
    Point p;
    std::array<int, 3> options{1, 1, 1};
    std::array<bool, 3> has_middle;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      has_middle[axis] = a[axis] + step_ < size_[axis] - 1;
      if (phase >> axis & 1) {
        if (!has_middle[axis]) return;
      } else if (cell[axis] + 1 == parents_along_[axis] && size_[axis] > 1) {
        options[axis] = 2;
      }
    }
    for (int oz = 0; oz < options[2]; ++oz)
      for (int oy = 0; oy < options[1]; ++oy)
        for (int ox = 0; ox < options[0]; ++ox) {
          const std::array<int, 3> far{ox, oy, oz};
          if (!all_active(cell, phase, far)) continue;
          Neighbours n;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t end = std::min(a[axis] + 2 * step_, size_[axis] - 1);
            if (phase >> axis & 1) {
              p[axis] = a[axis] + step_;
              n.below[axis] = a[axis];
              n.above[axis] = end;
              n.before[axis] = p[axis] - 2 * step_;
            } else if (far[axis]) {
              p[axis] = end;
              n.below[axis] = has_middle[axis] ? a[axis] + step_ : -1;
              n.above[axis] = -1;
              n.before[axis] = a[axis];
            } else {
              p[axis] = a[axis];
              n.below[axis] = a[axis] - step_;
              n.above[axis] = has_middle[axis] ? a[axis] + step_ : -1;
              n.before[axis] = a[axis] - 2 * step_;
            }
          }
          coder_.point(point_models_[model(p, n, phase)], p);
        }
  }

  /// Coordinates next to a point along each axis, -1 or less where there is none: for new axes the parent's ends,
  /// otherwise the middles of the parents on both sides; `before` is the previous point of the same kind.
  struct Neighbours {
    Point below, above, before;
  };

  bool all_active(const Cell& cell, int phase, const std::array<int, 3>& far) const {
    for (int side = 1; side < 8; ++side) {  // bit a: the parent below along axis a
      bool touches = true;
      std::array<std::int64_t, 3> other{cell[0], cell[1], cell[2]};
      for (std::size_t a = 0; a < 3; ++a) {
        if (!(side >> a & 1)) continue;
        touches = touches && !(phase >> a & 1) && !far[a] && --other[a] >= 0;
      }
      if (touches && !parents_.get(other[0], other[1], other[2])) return false;
    }
    return true;
  }

  std::size_t at(Point p, std::size_t axis, std::int64_t coordinate) const {
    if (coordinate < 0) return 0;
    p[axis] = coordinate;
    return sign(p) ? 1 : 0;
  }
  std::size_t at(Point p, std::size_t axis_a, std::int64_t a, std::size_t axis_b, std::int64_t b) const {
    if (a < 0 || b < 0) return 0;
    p[axis_a] = a;
    p[axis_b] = b;
    return sign(p) ? 1 : 0;
  }

  std::size_t model(const Point& p, const Neighbours& n, int phase) const {
    std::size_t context = at(p, 0, n.before[0]) | at(p, 1, n.before[1]) << 1 | at(p, 2, n.before[2]) << 2;
    const std::size_t base =
        static_cast<std::size_t>(std::min(level_, 2)) * (kCentreModels + 3 * kFaceModels + 3 * kEdgeModels);
    if (phase == 7) {
      for (int c = 0; c < 8; ++c)
        context =
            context << 1 |
            (sign({c & 1 ? n.above[0] : n.below[0], c & 2 ? n.above[1] : n.below[1], c & 4 ? n.above[2] : n.below[2]})
                 ? 1u
                 : 0u);
      return base + context;
    }
    if (std::popcount(static_cast<unsigned>(phase)) == 2) {
      const auto c = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(7 - phase)));
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      for (const std::int64_t pa : {n.below[a], n.above[a]})
        for (const std::int64_t pb : {n.below[b], n.above[b]}) context = context << 1 | at(p, a, pa, b, pb);
      context = context << 2 | at(p, c, n.below[c]) << 1 | at(p, c, n.above[c]);
      return base + kCentreModels + c * kFaceModels + context;
    }
    const auto a = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(phase)));
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    context = context << 2 | at(p, a, n.below[a]) << 1 | at(p, a, n.above[a]);
    context = context << 2 | at(p, b, n.below[b]) << 1 | at(p, b, n.above[b]);
    context = context << 2 | at(p, c, n.below[c]) << 1 | at(p, c, n.above[c]);
    for (const std::int64_t pb : {n.below[b], n.above[b]})
      for (const std::int64_t pc : {n.below[c], n.above[c]}) context = context << 1 | at(p, b, pb, c, pc);
    return base + kCentreModels + 3 * kFaceModels + a * kEdgeModels + context;
  }

  Coder& coder_;
  Progress& progress_;
  Dims dims_;
  std::array<std::int64_t, 3> size_{}, parents_along_{};
  int level_ = kTop;
  std::int64_t step_ = 1;
  std::vector<Cell> list_;  ///< active parents, in an order in which neighbours at lower coordinates come first
  BitVolume parents_;
  std::vector<AdaptiveBit> point_models_;
  std::array<AdaptiveBit, (kTop + 1) * 8> flag_models_;
};

class SignEncoder {
 public:
  explicit SignEncoder(const BitVolume& signs) : signs_(signs) {
    active_[1] = active_cells(signs);
    for (int level = 2; level <= kTop; ++level)
      active_[static_cast<std::size_t>(level)] =
          coarser(active_[static_cast<std::size_t>(level) - 1], cells_of(signs.dims(), level));
  }
  const BitVolume& signs() const { return signs_; }
  bool exhausted() const { return false; }
  void raw(const Point& p) { top_.put(signs_.get(p[0], p[1], p[2]) ? 1 : 0, 1); }
  void point(AdaptiveBit& model, const Point& p) { coder_.code(model, signs_.get(p[0], p[1], p[2])); }
  bool flag(AdaptiveBit& model, const Cell& cell, int level) {
    const bool active = active_[static_cast<std::size_t>(level)].get(cell[0], cell[1], cell[2]);
    coder_.code(model, active);
    return active;
  }
  void fill(const Point&, const Point&) {}
  std::string take() { return top_.take() + coder_.take(); }

 private:
  const BitVolume& signs_;
  std::array<BitVolume, kTop + 1> active_;
  BitWriter top_;
  RangeEncoder coder_;
};

class SignDecoder {
 public:
  SignDecoder(const Dims& dims, std::string_view top, std::string_view rest) : signs_(dims), top_(top), coder_(rest) {}
  const BitVolume& signs() const { return signs_; }
  bool exhausted() const { return coder_.past_end(); }
  void raw(const Point& p) { signs_.set(p[0], p[1], p[2], top_.get(1) != 0); }
  void point(AdaptiveBit& model, const Point& p) { signs_.set(p[0], p[1], p[2], coder_.decode(model)); }
  bool flag(AdaptiveBit& model, const Cell&, int) { return coder_.decode(model); }
  void fill(const Point& low, const Point& high) { fill_ones(signs_, low, high); }
  bool finished() const { return coder_.at_end() && top_.padding() == 0; }
  BitVolume take() { return std::move(signs_); }

 private:
  BitVolume signs_;
  BitReader top_;
  RangeDecoder coder_;
};
}  // namespace

Result<std::string> encode_signs(const BitVolume& signs, Progress& progress) {
  progress.begin("encode signs", kTop, "level");
  SignEncoder encoder(signs);
  DUBSAR_TRY(Walk(encoder, progress).run());
  progress.end();
  return encoder.take();
}

Result<BitVolume> decode_signs(std::string_view bytes, const Dims& dims, Progress& progress) {
  const std::uint64_t top =
      top_coordinates(dims.x).size() * top_coordinates(dims.y).size() * top_coordinates(dims.z).size();
  const std::uint64_t top_bytes = packed_bytes(top, 1);
  if (top_bytes > bytes.size())
    return fail(ErrorKind::kBadData, "exa: {} bytes of signs for {}x{}x{} points, expected at least {}", bytes.size(),
                dims.x, dims.y, dims.z, top_bytes);
  DUBSAR_TRY(check_memory("exa signs", static_cast<std::uint64_t>((dims.x + 63) / 64 * dims.y * dims.z) * 10));
  progress.begin("decode signs", kTop, "level");
  SignDecoder decoder(dims, bytes.substr(0, top_bytes), bytes.substr(top_bytes));
  DUBSAR_TRY(Walk(decoder, progress).run());
  if (!decoder.finished()) return fail(ErrorKind::kBadData, "exa: the sign code has bytes that do not belong to it");
  progress.end();
  return decoder.take();
}

}  // namespace dubsar
