#include "core/exa/signs/topology.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>

#include "core/base/system/budget.h"
#include "core/base/system/parallel.h"
#include "core/exa/coding/shared_words.h"
#include "core/exa/signs/sign_bricks.h"
#include "core/exa/signs/sign_coder.h"

namespace dubsar {
namespace {
std::int64_t bricks_along(std::int64_t points) { return (padded_cells(points) + kBrickCells - 1) / kBrickCells; }

struct DecodeBrick {
  SignStatistics& statistics;
  RangeDecoder& in;
  std::uint64_t points = 0;
  bool flag(int context, int, int, int, int) { return in.bit(statistics.flag(context)); }
  void begin(const SignLattice& lattice, int level, int phase) { statistics.begin(lattice, level, phase); }
  void row(SignLattice& lattice, int, int y, int z, std::span<const std::uint8_t> xs) {
    points += xs.size();
    RangeDecoder own = in;  // in registers
    statistics.walk(lattice, y, z, xs, [&own](int, std::uint32_t p) { return own.bit(p); });
    in = own;
  }
};

/// The points that a brick stores: all of its own, and those of its far sides that the next brick has, too.
struct Owned {
  std::array<std::int64_t, 3> low{}, end{};
  std::array<std::int64_t, 3> far{};  ///< the far sides
  bool shared = false;                ///< other bricks may store points of the same words at the same time, anywhere
};
Owned owned_by(const Brick& brick, int level, const Dims& points, bool all_sides) {
  const std::array<std::int64_t, 3> size{points.x, points.y, points.z};
  Owned owned;
  for (std::size_t a = 0; a < 3; ++a) {
    owned.low[a] = brick.low[a] >> level;
    const std::int64_t far = owned.low[a] + (brick.cells[a] >> level);
    owned.far[a] = far;
    owned.end[a] = std::min(size[a], all_sides || far + 1 >= size[a] ? far + 1 : far);
  }
  return owned;
}

/// Sets bits [first, first + count) of a row from `bits`, which are 0 beyond count.
void put_bits(std::uint64_t* row, std::int64_t first, std::uint64_t bits, bool shared) {
  or_words(row + (first >> 6), bits << (first & 63), shared);
  if ((first & 63) != 0 && bits >> (64 - (first & 63)) != 0)
    or_words(row + (first >> 6) + 1, bits >> (64 - (first & 63)), shared);
}

/// `bits_of(y, z, from)`: 64 signs of a row of the brick. Only words on its sides can have points of other bricks.
template <class BitsOf>
void store(const Owned& owned, const BitsOf& bits_of, BitVolume& out) {
  for (std::int64_t z = owned.low[2]; z < owned.end[2]; ++z)
    for (std::int64_t y = owned.low[1]; y < owned.end[1]; ++y) {
      const bool side =
          owned.shared || z == owned.low[2] || y == owned.low[1] || z >= owned.far[2] || y >= owned.far[1];
      for (std::int64_t x = owned.low[0]; x < owned.end[0]; x += 64) {
        std::uint64_t bits = bits_of(static_cast<int>(y - owned.low[1]), static_cast<int>(z - owned.low[2]),
                                     static_cast<int>(x - owned.low[0]));
        if (owned.end[0] - x < 64) bits &= (std::uint64_t{1} << (owned.end[0] - x)) - 1;
        if (bits != 0) put_bits(out.row(y, z), x, bits, side || (x & 63) != 0 || x + 64 > owned.far[0]);
      }
    }
}

/// No brick with so many active edges has more coded signs.
constexpr std::uint64_t most_in_brick(std::uint64_t edges) { return 64 * edges + 4096; }

/// What decode_bricks() is asked for.
struct BrickOrder {
  const std::array<std::vector<std::string_view>, 3>& chunks;
  Dims dims;
  const BitVolume& coarse;
  bool is_coarse = false, late_bricks = true;
  int level = 0;
  const std::optional<GridBox>& box;
  std::uint64_t most_points = 0;
  std::vector<std::uint8_t> lost = {};
};

/// Decodes bricks one by one; any number of threads.
class BrickDecoder {
 public:
  /// `out`: the points of spacing 2^level.
  BrickDecoder(const BrickOrder& order, BitVolume& out) : order_(order), out_(out) {}

  void decode(std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    const Brick at = brick_at(order_.dims, index);
    Owned owned =
        owned_by(at, order_.level, out_.dims(), order_.box.has_value() || order_.late_bricks || !order_.lost.empty());
    owned.shared = !order_.late_bricks;
    SignLattice top = top_lattice(order_.coarse, at);
    if (order_.chunks[2][i].empty()) {
      if (top.get(0, 0, 0))
        store(
            owned, [](int, int, int) { return ~std::uint64_t{0}; }, out_);
      return;
    }
    const auto model = static_cast<unsigned char>(order_.chunks[2][i][0]);
    if (model >= kSignModels) {
      broken_ = true;
      return;
    }
    const SignSurroundings around = surroundings_of(at, out_, order_.level, order_.dims);
    SignBrick brick(std::move(top), at.late && order_.late_bricks ? &around : nullptr);
    SignStatistics statistics(model, order_.is_coarse);
    std::uint64_t coded = 0;
    for (int l = kBrickLevels - 1; l >= order_.level; --l) {
      RangeDecoder in(order_.chunks[static_cast<std::size_t>(l)][i].substr(l == 2 ? 1 : 0));
      DecodeBrick coder{statistics, in};
      brick.refine(coder, l);
      coded += coder.points;
      if ((points_ += coder.points) > order_.most_points || too_many_) return;
    }
    const SignLattice& lattice = brick.lattice();
    if (order_.level == 0 && coded > 4096 && coded > most_in_brick(lattice.active_edges())) {
      too_many_ = true;
      return;
    }
    store(
        owned, [&](int y, int z, int from) { return lattice.word(y, z, from); }, out_);
  }

  bool stopped() const { return too_many_ || broken_ || points_ > order_.most_points; }
  Result<void> result() const {
    if (too_many_) return fail(ErrorKind::kBadData, "exa: a brick codes more signs than its surface can need");
    if (points_ > order_.most_points)
      return fail(ErrorKind::kBadData, "exa: more than {} signs are coded, which the surface cannot need",
                  order_.most_points);
    if (broken_) return fail(ErrorKind::kBadData, "exa: a brick of signs names a model that is not known");
    return {};
  }

 private:
  const BrickOrder& order_;
  BitVolume& out_;
  std::atomic<bool> broken_{false}, too_many_{false};
  std::atomic<std::uint64_t> points_{0};
};

Result<void> decode_bricks(const BrickOrder& order, BitVolume& out, Progress& progress) {
  const std::int64_t bricks = brick_grid(order.dims).count();
  for (int l = order.level; l < kBrickLevels; ++l)
    if (order.chunks[static_cast<std::size_t>(l)].size() != static_cast<std::size_t>(bricks))
      return fail(ErrorKind::kBadData, "exa: {} chunks of signs found, {} bricks expected",
                  order.chunks[static_cast<std::size_t>(l)].size(), bricks);
  const std::vector<std::uint8_t> needed =
      order.box ? bricks_of_box(order.dims, *order.box, order.late_bricks) : std::vector<std::uint8_t>();
  std::array<std::vector<std::int64_t>, 2> turns;  // those that the others know first
  for (std::int64_t i = 0; i < bricks; ++i)
    if ((!order.box || needed[static_cast<std::size_t>(i)] != 0) &&
        (order.lost.empty() || order.lost[static_cast<std::size_t>(i)] == 0))
      turns[order.late_bricks && brick_at(order.dims, i).late ? 1 : 0].push_back(i);
  BrickDecoder decoder(order, out);
  for (const std::vector<std::int64_t>& turn : turns)
    parallel_for(static_cast<std::int64_t>(turn.size()), 1, [&](std::int64_t i) {
      if (progress.cancelled() || decoder.stopped()) return;
      decoder.decode(turn[static_cast<std::size_t>(i)]);
      progress.advance(1);
    });
  if (progress.cancelled()) return cancelled_error();
  return decoder.result();
}
/// Points that only lost bricks have get the sign of the nearest of every eighth.
void fill_lost(const BitVolume& eighth, const Dims& dims, int level, const std::vector<std::uint8_t>& lost,
               BitVolume& out) {
  const Dims grid = brick_grid(dims), points = out.dims();
  // The bricks along an axis that have a point: one, or two on a side.
  const auto bricks_of = [&](std::int64_t at, std::int64_t count) {
    const std::int64_t last = std::min(at / kBrickCells, count - 1);
    return std::array<std::int64_t, 2>{at % kBrickCells == 0 && at > 0 ? std::min(at / kBrickCells - 1, last) : last,
                                       last};
  };
  parallel_for(points.z, 1, [&](std::int64_t z) {
    const auto bz = bricks_of(z << level, grid.z);
    for (std::int64_t y = 0; y < points.y; ++y) {
      const auto by = bricks_of(y << level, grid.y);
      for (std::int64_t x = 0; x < points.x; ++x) {
        const auto bx = bricks_of(x << level, grid.x);
        bool known = false;
        for (const std::int64_t k : bz)
          for (const std::int64_t j : by)
            for (const std::int64_t i : bx) known |= lost[static_cast<std::size_t>((k * grid.y + j) * grid.x + i)] == 0;
        if (!known)
          out.set(x, y, z, eighth.get(((x << level) + 4) / 8, ((y << level) + 4) / 8, ((z << level) + 4) / 8));
      }
    }
  });
}
}  // namespace

std::vector<std::uint8_t> lost_with(const Dims& dims, std::vector<std::uint8_t> lost, bool late_bricks) {
  if (lost.empty() || !late_bricks) return lost;
  const Dims grid = brick_grid(dims);
  const std::array<std::int64_t, 3> along{grid.x, grid.y, grid.z}, step{1, grid.x, grid.slice()};
  const std::vector<std::uint8_t> damaged = lost;
  for (std::int64_t i = 0; i < grid.count(); ++i) {
    const Brick brick = brick_at(dims, i);
    if (damaged[static_cast<std::size_t>(i)] == 0 || brick.late) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      if (brick.low[a] > 0) lost[static_cast<std::size_t>(i - step[a])] = 1;
      if (brick.low[a] / kBrickCells + 1 < along[a]) lost[static_cast<std::size_t>(i + step[a])] = 1;
    }
  }
  return lost;
}

Dims brick_grid(const Dims& dims) { return {bricks_along(dims.x), bricks_along(dims.y), bricks_along(dims.z)}; }

Dims coarse_dims(const Dims& dims) {
  return {padded_cells(dims.x) / 8 + 1, padded_cells(dims.y) / 8 + 1, padded_cells(dims.z) / 8 + 1};
}

Dims level_dims(const Dims& dims, int level) {
  return {((dims.x - 1) >> level) + 1, ((dims.y - 1) >> level) + 1, ((dims.z - 1) >> level) + 1};
}

std::size_t coarse_chunk_count(const Dims& dims) { return 1 + kBrickLevels * count_of(brick_grid(coarse_dims(dims))); }

std::vector<std::uint8_t> bricks_of_box(const Dims& dims, const GridBox& box, bool late_bricks) {
  const Dims grid = brick_grid(dims);
  std::vector<std::uint8_t> needed(count_of(grid), 0);
  for (std::int64_t i = 0; i < grid.count(); ++i) {
    const Brick brick = brick_at(dims, i);
    bool touched = true;
    for (std::size_t a = 0; a < 3; ++a)
      touched = touched && brick.low[a] <= box.high[a] && brick.low[a] + brick.cells[a] >= box.low[a];
    if (!touched) continue;
    needed[static_cast<std::size_t>(i)] = 1;
    if (!brick.late || !late_bricks) continue;
    const std::array<std::int64_t, 3> along{grid.x, grid.y, grid.z}, step{1, grid.x, grid.slice()};
    for (std::size_t a = 0; a < 3; ++a) {
      if (brick.low[a] > 0) needed[static_cast<std::size_t>(i - step[a])] = 1;
      if (brick.low[a] / kBrickCells + 1 < along[a]) needed[static_cast<std::size_t>(i + step[a])] = 1;
    }
  }
  return needed;
}

Result<BitVolume> decode_signs(const SignChunks& chunks, const Dims& dims, int level, const std::optional<GridBox>& box,
                               std::uint64_t most_points, Progress& progress) {
  DUBSAR_CHECK(level >= 0 && level <= kBrickLevels);
  const Dims coarse = coarse_dims(dims), top = coarse_dims(coarse), points = level_dims(dims, level);
  DUBSAR_TRY(check_memory("exa signs", static_cast<std::uint64_t>((points.x + 63) / 64 * points.y * points.z +
                                                                  (coarse.x + 63) / 64 * coarse.y * coarse.z) *
                                           8));
  progress.begin("decode signs", brick_grid(dims).count() + brick_grid(coarse).count(), "brick");
  if (chunks.coarse.size() != coarse_chunk_count(dims) || chunks.coarse[0].size() != (count_of(top) + 7) / 8)
    return fail(ErrorKind::kBadData, "exa: {} chunks of coarse signs found, {} expected", chunks.coarse.size(),
                coarse_chunk_count(dims));
  BitVolume raw(top);
  std::size_t bit = 0;
  for (std::int64_t z = 0; z < top.z; ++z)
    for (std::int64_t y = 0; y < top.y; ++y)
      for (std::int64_t x = 0; x < top.x; ++x, ++bit) raw.set(x, y, z, chunks.coarse[0][bit / 8] >> bit % 8 & 1);
  std::array<std::vector<std::string_view>, 3> middle;
  const std::size_t bricks = count_of(brick_grid(coarse));
  for (std::size_t l = 0; l < kBrickLevels; ++l) {
    const auto first = chunks.coarse.begin() + static_cast<std::ptrdiff_t>(1 + (kBrickLevels - 1 - l) * bricks);
    middle[l].assign(first, first + static_cast<std::ptrdiff_t>(bricks));
  }
  BitVolume eighth(coarse);
  const std::optional<GridBox> none;
  DUBSAR_TRY(decode_bricks({middle, coarse, raw, true, chunks.late_bricks, 0, none, most_points}, eighth, progress));
  BitVolume signs(points);
  if (level == kBrickLevels) {
    for (std::int64_t z = 0; z < points.z; ++z)
      for (std::int64_t y = 0; y < points.y; ++y)
        for (std::int64_t x = 0; x < points.x; ++x) signs.set(x, y, z, eighth.get(x, y, z));
  } else {
    const std::vector<std::uint8_t> lost = lost_with(dims, chunks.lost, chunks.late_bricks);
    DUBSAR_TRY(decode_bricks({chunks.bricks, dims, eighth, false, chunks.late_bricks, level, box, most_points, lost},
                             signs, progress));
    if (!lost.empty()) fill_lost(eighth, dims, level, lost, signs);
  }
  progress.end();
  return signs;
}

}  // namespace dubsar
