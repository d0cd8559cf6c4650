#include "core/exa/topology.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/base/budget.h"
#include "core/base/parallel.h"
#include "core/exa/bit_spread.h"
#include "core/exa/sign_coder.h"

namespace dubsar {
namespace {
constexpr int kTopSpacing = 8, kTopCells = kBrickCells / kTopSpacing;

/// Cells along an axis: whole cells of the top lattice, at least one.
std::int64_t padded_cells(std::int64_t points) { return std::max<std::int64_t>(1, (points + 6) / 8) * 8; }
std::int64_t bricks_along(std::int64_t points) { return (padded_cells(points) + kBrickCells - 1) / kBrickCells; }
std::size_t count_of(const Dims& d) { return static_cast<std::size_t>(d.count()); }

struct Brick {
  std::array<std::int64_t, 3> low{};  ///< first point
  std::array<int, 3> cells{};         ///< finest cells
};
Brick brick_at(const Dims& dims, std::int64_t index) {
  const Dims grid = brick_grid(dims);
  const std::array<std::int64_t, 3> place{index % grid.x, index / grid.x % grid.y, index / grid.slice()};
  const std::array<std::int64_t, 3> points{dims.x, dims.y, dims.z};
  Brick brick;
  for (std::size_t a = 0; a < 3; ++a) {
    brick.low[a] = place[a] * kBrickCells;
    brick.cells[a] = static_cast<int>(std::min<std::int64_t>(kBrickCells, padded_cells(points[a]) - brick.low[a]));
  }
  return brick;
}

/// Beyond the end the last slice is repeated.
bool sign_at(const BitVolume& signs, std::int64_t x, std::int64_t y, std::int64_t z) {
  const Dims& d = signs.dims();
  return signs.get(std::min(x, d.x - 1), std::min(y, d.y - 1), std::min(z, d.z - 1));
}

BitVolume every_eighth(const BitVolume& signs) {
  BitVolume coarse(coarse_dims(signs.dims()));
  const Dims& d = coarse.dims();
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) coarse.set(x, y, z, sign_at(signs, 8 * x, 8 * y, 8 * z));
  return coarse;
}

/// The corner signs of a brick, from the volume of every eighth point.
SignLattice top_lattice(const BitVolume& coarse, const Brick& brick) {
  SignLattice top({brick.cells[0] / 8, brick.cells[1] / 8, brick.cells[2] / 8});
  for (int z = 0; z <= top.cells()[2]; ++z)
    for (int y = 0; y <= top.cells()[1]; ++y)
      for (int x = 0; x <= top.cells()[0]; ++x)
        if (coarse.get(brick.low[0] / 8 + x, brick.low[1] / 8 + y, brick.low[2] / 8 + z)) top.set(x, y, z);
  return top;
}

/// What the encoder knows of a brick: its signs and which cells of spacing 2, 4, 8 have both signs inside.
class BrickTruth {
 public:
  BrickTruth(const BitVolume& signs, const Brick& brick) : signs_(signs), brick_(brick) {
    std::array<int, 3> n{brick.cells[0] / 2, brick.cells[1] / 2, brick.cells[2] / 2};
    for (std::size_t level = 1; level <= 3; ++level) {
      cells_[level] = n;
      mixed_[level].assign(static_cast<std::size_t>(n[1] * n[2]), 0);
      for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y) mixed_[level][row(level, y, z)] = level == 1 ? pairs(y, z) : halves(level, y, z);
      for (int& c : n) c /= 2;
    }
  }
  bool sign(int x, int y, int z) const {
    return sign_at(signs_, brick_.low[0] + x, brick_.low[1] + y, brick_.low[2] + z);
  }
  bool mixed(int level, int x, int y, int z) const {
    const auto l = static_cast<std::size_t>(level);
    return mixed_[l][row(l, y, z)] >> x & 1;
  }
  bool any() const {
    return std::any_of(mixed_[3].begin(), mixed_[3].end(), [](std::uint64_t word) { return word != 0; });
  }

 private:
  std::size_t row(std::size_t level, int y, int z) const { return static_cast<std::size_t>(z * cells_[level][1] + y); }
  /// 129 points of a row: the words that it starts with and the last point.
  struct RowBits {
    std::uint64_t low = 0, high = 0;
    bool last = false;
  };
  RowBits row_bits(int y, int z) const {
    const Dims& d = signs_.dims();
    const std::uint64_t* words = signs_.row(std::min(brick_.low[1] + y, d.y - 1), std::min(brick_.low[2] + z, d.z - 1));
    const std::int64_t first = brick_.low[0] / 64, count = signs_.words_per_row(), points = d.x - brick_.low[0];
    RowBits bits;
    if (points >= 129) return {words[first], words[first + 1], (words[first + 2] & 1) != 0};
    bits.low = words[first];
    if (first + 1 < count) bits.high = words[first + 1];
    bits.last = signs_.get(d.x - 1, std::min(brick_.low[1] + y, d.y - 1), std::min(brick_.low[2] + z, d.z - 1));
    if (!bits.last) return bits;
    if (points < 64) bits.low |= ~std::uint64_t{0} << points;
    if (points <= 64)
      bits.high = ~std::uint64_t{0};
    else if (points < 128)
      bits.high |= ~std::uint64_t{0} << (points - 64);
    return bits;
  }
  std::uint64_t pairs(int y, int z) const {
    RowBits any, all{~std::uint64_t{0}, ~std::uint64_t{0}, true};
    for (int p = 0; p < 9; ++p) {
      const RowBits bits = row_bits(2 * y + p % 3, 2 * z + p / 3);
      any = {any.low | bits.low, any.high | bits.high, any.last || bits.last};
      all = {all.low & bits.low, all.high & bits.high, all.last && bits.last};
    }
    const auto three = [](std::uint64_t w, bool next, auto join) {  // bit i with bits i + 1 and i + 2
      return join(join(w, w >> 1), w >> 2 | std::uint64_t{next} << 62);
    };
    const auto both = [](std::uint64_t a, std::uint64_t b) { return a & b; };
    const auto either = [](std::uint64_t a, std::uint64_t b) { return a | b; };
    const std::uint64_t low = three(any.low, any.high & 1, either) & ~three(all.low, all.high & 1, both);
    const std::uint64_t high = three(any.high, any.last, either) & ~three(all.high, all.last, both);
    const std::uint64_t mixed = even_bits(low) | even_bits(high) << 32;
    const int n = cells_[1][0];
    return n >= 64 ? mixed : mixed & ((std::uint64_t{1} << n) - 1);
  }
  std::uint64_t halves(std::size_t level, int y, int z) const {
    std::uint64_t any = 0;
    for (int p = 0; p < 4; ++p) any |= mixed_[level - 1][row(level - 1, 2 * y + p % 2, 2 * z + p / 2)];
    return even_bits(any | any >> 1);
  }

  const BitVolume& signs_;
  Brick brick_;
  std::array<std::array<int, 3>, 4> cells_{};
  std::array<std::vector<std::uint64_t>, 4> mixed_;
};

struct EncodeBrick {
  const BrickTruth& truth;
  SignStatistics& statistics;
  RangeEncoder& out;
  bool flag(int context, int level, int x, int y, int z) {
    const bool hidden = truth.mixed(level, x, y, z);
    out.bit(statistics.flag(context), hidden);
    return hidden;
  }
  void begin(const SignLattice& lattice, int level, int phase) { statistics.begin(lattice, level, phase); }
  bool point(const SignLattice&, int level, int x, int y, int z) {
    const bool inside = truth.sign(x << level, y << level, z << level);
    out.bit(statistics.predict(x, y, z), inside);
    statistics.learn(inside);
    return inside;
  }
};

struct DecodeBrick {
  SignStatistics& statistics;
  RangeDecoder& in;
  std::uint64_t points = 0;
  bool flag(int context, int, int, int, int) { return in.bit(statistics.flag(context)); }
  void begin(const SignLattice& lattice, int level, int phase) { statistics.begin(lattice, level, phase); }
  bool point(const SignLattice&, int, int x, int y, int z) {
    const bool inside = in.bit(statistics.predict(x, y, z));
    statistics.learn(inside);
    ++points;
    return inside;
  }
};

/// The chunks of one brick by level. The first byte of the coarsest names the model: the one that is better there.
std::array<std::string, 3> encode_brick(const BrickTruth& truth, const SignLattice& top, bool is_coarse) {
  struct Attempt {
    SignBrick brick;
    SignStatistics statistics;
    std::array<std::string, 3> code;
    void refine(const BrickTruth& by, std::size_t level) {
      RangeEncoder out;
      EncodeBrick coder{by, statistics, out};
      brick.refine(coder, static_cast<int>(level));
      code[level] = out.take();
    }
    std::size_t bytes() const { return code[1].size() + code[2].size(); }
  };
  std::optional<Attempt> best;
  for (const std::size_t model : kSignModelsTried) {
    Attempt attempt{SignBrick(top), SignStatistics(model, is_coarse), {}};
    attempt.refine(truth, 2);
    attempt.refine(truth, 1);
    attempt.code[2].insert(attempt.code[2].begin(), static_cast<char>(model));
    if (!best || attempt.bytes() < best->bytes()) best = std::move(attempt);
  }
  best->refine(truth, 0);
  return best->code;
}

/// One chunk a brick and level.
Result<std::array<std::vector<std::string>, 3>> encode_bricks(const BitVolume& signs, const BitVolume& coarse,
                                                              bool is_coarse, Progress& progress) {
  const Dims& dims = signs.dims();
  std::array<std::vector<std::string>, 3> chunks;
  for (auto& level : chunks) level.resize(count_of(brick_grid(dims)));
  parallel_for(brick_grid(dims).count(), 1, [&](std::int64_t index) {
    if (progress.cancelled()) return;
    const Brick at = brick_at(dims, index);
    const BrickTruth truth(signs, at);
    if (truth.any()) {
      std::array<std::string, 3> code = encode_brick(truth, top_lattice(coarse, at), is_coarse);
      for (std::size_t level = 0; level < kBrickLevels; ++level)
        chunks[level][static_cast<std::size_t>(index)] = std::move(code[level]);
    }
    progress.advance(1);
  });
  if (progress.cancelled()) return cancelled_error();
  return chunks;
}

/// The points that a brick owns: all but those of its far sides that the next brick has, too.
struct Owned {
  std::array<std::int64_t, 3> low{}, end{};
};
Owned owned_by(const Brick& brick, int level, const Dims& points, bool all_sides) {
  const std::array<std::int64_t, 3> size{points.x, points.y, points.z};
  Owned owned;
  for (std::size_t a = 0; a < 3; ++a) {
    owned.low[a] = brick.low[a] >> level;
    const std::int64_t far = owned.low[a] + (brick.cells[a] >> level);
    owned.end[a] = std::min(size[a], all_sides || far + 1 >= size[a] ? far + 1 : far);
  }
  return owned;
}

/// Sets bits [first, first + count) of a row from `bits`, which are 0 beyond count.
void put_bits(std::uint64_t* row, std::int64_t first, std::uint64_t bits) {
  row[first >> 6] |= bits << (first & 63);
  if ((first & 63) != 0 && bits >> (64 - (first & 63)) != 0) row[(first >> 6) + 1] |= bits >> (64 - (first & 63));
}

/// `bits_of(y, z, from)`: 64 signs of a row of the brick.
template <class BitsOf>
void store(const Owned& owned, const BitsOf& bits_of, BitVolume& out) {
  for (std::int64_t z = owned.low[2]; z < owned.end[2]; ++z)
    for (std::int64_t y = owned.low[1]; y < owned.end[1]; ++y)
      for (std::int64_t x = owned.low[0]; x < owned.end[0]; x += 64) {
        std::uint64_t bits = bits_of(static_cast<int>(y - owned.low[1]), static_cast<int>(z - owned.low[2]),
                                     static_cast<int>(x - owned.low[0]));
        if (owned.end[0] - x < 64) bits &= (std::uint64_t{1} << (owned.end[0] - x)) - 1;
        if (bits != 0) put_bits(out.row(y, z), x, bits);
      }
}

/// Signs of a brick that are not worth a second look.
constexpr std::uint64_t kAlwaysCoded = 1 << 17;

/// `out`: the points of spacing 2^level of a volume of `dims` points.
Result<void> decode_bricks(const std::array<std::vector<std::string_view>, 3>& chunks, const Dims& dims,
                           const BitVolume& coarse, bool is_coarse, int level, const std::optional<GridBox>& box,
                           std::uint64_t most_points, BitVolume& out, Progress& progress) {
  const std::int64_t bricks = brick_grid(dims).count();
  for (int l = level; l < kBrickLevels; ++l)
    if (chunks[static_cast<std::size_t>(l)].size() != static_cast<std::size_t>(bricks))
      return fail(ErrorKind::kBadData, "exa: {} chunks of signs found, {} bricks expected",
                  chunks[static_cast<std::size_t>(l)].size(), bricks);
  // Words of 64 points are shared by bricks of a row at coarse levels: one row of bricks at a time.
  // Bricks of a box write their far sides, too: all in one row.
  const std::int64_t row = box ? bricks : brick_grid(dims).x;
  std::atomic<bool> broken{false}, too_many{false};
  std::atomic<std::uint64_t> points{0};
  parallel_for(bricks / row, 1, [&](std::int64_t r) {
    for (std::int64_t index = r * row; index < (r + 1) * row; ++index) {
      if (progress.cancelled() || too_many) return;
      const auto i = static_cast<std::size_t>(index);
      const Brick at = brick_at(dims, index);
      bool wanted = true;
      for (std::size_t a = 0; box && a < 3; ++a)
        wanted = wanted && at.low[a] <= box->high[a] && at.low[a] + at.cells[a] >= box->low[a];
      if (!wanted) continue;
      const Owned owned = owned_by(at, level, out.dims(), box.has_value());
      SignLattice top = top_lattice(coarse, at);
      if (chunks[2][i].empty()) {
        const std::uint64_t fill = top.get(0, 0, 0) ? ~std::uint64_t{0} : 0;
        if (fill != 0)
          store(
              owned, [fill](int, int, int) { return fill; }, out);
      } else {
        const auto model = static_cast<unsigned char>(chunks[2][i][0]);
        if (model >= kSignModels) {
          broken = true;
          return;
        }
        SignBrick brick(std::move(top));
        SignStatistics statistics(model, is_coarse);
        std::uint64_t coder_points = 0;
        for (int l = kBrickLevels - 1; l >= level; --l) {
          RangeDecoder in(chunks[static_cast<std::size_t>(l)][i].substr(l == 2 ? 1 : 0));
          DecodeBrick coder{statistics, in};
          brick.refine(coder, l);
          coder_points += coder.points;
          if ((points += coder.points) > most_points || too_many) return;
        }
        const SignLattice& lattice = brick.lattice();
        if (level == 0 && coder_points > kAlwaysCoded && coder_points > most_coded_signs(lattice.active_edges())) {
          too_many = true;
          return;
        }
        store(
            owned, [&](int y, int z, int from) { return lattice.word(y, z, from); }, out);
      }
      progress.advance(1);
    }
  });
  if (progress.cancelled()) return cancelled_error();
  if (too_many) return fail(ErrorKind::kBadData, "exa: a brick codes more signs than its surface can need");
  if (points > most_points)
    return fail(ErrorKind::kBadData, "exa: more than {} signs are coded, which the surface cannot need", most_points);
  if (broken) return fail(ErrorKind::kBadData, "exa: a brick of signs names a model that is not known");
  return {};
}
}  // namespace

Dims brick_grid(const Dims& dims) { return {bricks_along(dims.x), bricks_along(dims.y), bricks_along(dims.z)}; }

Dims coarse_dims(const Dims& dims) {
  return {padded_cells(dims.x) / 8 + 1, padded_cells(dims.y) / 8 + 1, padded_cells(dims.z) / 8 + 1};
}

Dims level_dims(const Dims& dims, int level) {
  return {((dims.x - 1) >> level) + 1, ((dims.y - 1) >> level) + 1, ((dims.z - 1) >> level) + 1};
}

std::size_t coarse_chunk_count(const Dims& dims) { return 1 + kBrickLevels * count_of(brick_grid(coarse_dims(dims))); }

Result<SignCode> encode_signs(const BitVolume& signs, Progress& progress) {
  const BitVolume coarse = every_eighth(signs), top = every_eighth(coarse);
  progress.begin("encode signs", brick_grid(signs.dims()).count() + brick_grid(coarse.dims()).count(), "brick");
  SignCode code;
  std::string raw((count_of(top.dims()) + 7) / 8, '\0');
  std::size_t bit = 0;
  for (std::int64_t z = 0; z < top.dims().z; ++z)
    for (std::int64_t y = 0; y < top.dims().y; ++y)
      for (std::int64_t x = 0; x < top.dims().x; ++x, ++bit)
        if (top.get(x, y, z)) raw[bit / 8] = static_cast<char>(raw[bit / 8] | 1 << bit % 8);
  code.coarse.push_back(std::move(raw));
  DUBSAR_ASSIGN(auto middle, encode_bricks(coarse, top, true, progress));
  for (std::size_t level = kBrickLevels; level-- > 0;)
    for (std::string& chunk : middle[level]) code.coarse.push_back(std::move(chunk));
  DUBSAR_ASSIGN(code.bricks, encode_bricks(signs, coarse, false, progress));
  progress.end();
  return code;
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
  DUBSAR_TRY(decode_bricks(middle, coarse, raw, true, 0, std::nullopt, most_points, eighth, progress));
  BitVolume signs(points);
  if (level == kBrickLevels) {
    for (std::int64_t z = 0; z < points.z; ++z)
      for (std::int64_t y = 0; y < points.y; ++y)
        for (std::int64_t x = 0; x < points.x; ++x) signs.set(x, y, z, eighth.get(x, y, z));
  } else {
    DUBSAR_TRY(decode_bricks(chunks.bricks, dims, eighth, false, level, box, most_points, signs, progress));
  }
  progress.end();
  return signs;
}

}  // namespace dubsar
