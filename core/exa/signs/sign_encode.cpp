// From signs to bytes; topology.cpp goes the other way.
#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "core/base/system/parallel.h"
#include "core/exa/signs/sign_bricks.h"
#include "core/exa/signs/sign_coder.h"
#include "core/exa/signs/sign_truth.h"
#include "core/exa/signs/topology.h"

namespace dubsar {
namespace {

BitVolume every_eighth(const BitVolume& signs) {
  BitVolume coarse(coarse_dims(signs.dims()));
  const Dims& d = coarse.dims();
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) coarse.set(x, y, z, sign_at(signs, 8 * x, 8 * y, 8 * z));
  return coarse;
}

/// Codes the points of a row and the flags of a level as they are.
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
  void row(SignLattice& lattice, int level, int y, int z, std::span<const std::uint8_t> xs) {
    statistics.walk(lattice, y, z, xs, [&](int x, std::uint32_t p) {
      const bool inside = truth.sign(x << level, y << level, z << level);
      out.bit(p, inside);
      return inside;
    });
  }
};

/// The chunks of one brick by level. The first byte of the coarsest names the model: the one that is better there.
std::array<std::string, 3> encode_brick(const BrickTruth& truth, const SignLattice& top, const SignSurroundings* around,
                                        bool is_coarse) {
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
    Attempt attempt{SignBrick(top, around), SignStatistics(model, is_coarse), {}};
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
      const SignSurroundings around = surroundings_of(at, signs, 0, dims);
      std::array<std::string, 3> code =
          encode_brick(truth, top_lattice(coarse, at), at.late ? &around : nullptr, is_coarse);
      for (std::size_t level = 0; level < kBrickLevels; ++level)
        chunks[level][static_cast<std::size_t>(index)] = std::move(code[level]);
    }
    progress.advance(1);
  });
  if (progress.cancelled()) return cancelled_error();
  return chunks;
}

}  // namespace

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

}  // namespace dubsar
