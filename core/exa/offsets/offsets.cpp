#include "core/exa/offsets/offsets.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/base/system/budget.h"
#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/exa/coding/range_coder.h"
#include "core/exa/offsets/offset_choice.h"
#include "core/exa/offsets/offset_model.h"
#include "core/exa/offsets/offset_rows.h"
#include "core/exa/signs/brick_items.h"
#include "core/exa/signs/topology.h"

namespace dubsar {
namespace {
std::array<std::int64_t, 3> brick_low(const Dims& grid, std::int64_t index) {
  return {index % grid.x * kBrickCells, index / grid.x % grid.y * kBrickCells, index / grid.slice() * kBrickCells};
}

/// Middle of an offset's interval in 1 / 64 of a grid step.
int middle_of(std::uint32_t offset, int bits) { return static_cast<int>((2 * offset + 1) << 5 >> bits); }

const AdaptiveBit kJoined(kProbabilityOne / 2, 6);
}  // namespace

namespace {
constexpr int kTrial = 2048;  ///< edges that decide which model a brick takes

/// The offsets of a brick, or of its first `most` edges.
std::string encode_offsets(const SurfaceSamples& samples, const BrickItems& items, std::size_t model, int most) {
  const int bits = std::min(samples.offset_bits, kModelledBits), rest = samples.offset_bits - bits;
  const OffsetModel& network = OffsetModel::instance(model);
  const OffsetTable& table = OffsetTable::instance();
  OffsetWindow window(items.signs());
  OffsetRows rows(network, window);
  RangeEncoder out;
  int count = 0;
  items.edges([&](int z) { window.begin_slice(z); },
              [&](int axis, int y, int z, std::span<const std::uint8_t> xs, std::uint32_t number) {
                if (count >= most) return;
                count += static_cast<int>(xs.size());
                rows.row(axis, y, z, xs, [&](std::size_t i, const OffsetEstimate& estimate) {
                  const std::uint32_t offset = samples.offsets[number + i], symbol = offset >> rest;
                  if (bits == OffsetTable::kBits) {
                    const OffsetTable::Starts& starts = table.starts(estimate);
                    out.symbol(starts[symbol], OffsetTable::end(starts, symbol) - starts[symbol]);
                  } else {
                    const OffsetDistribution likely(estimate, bits);
                    const std::uint32_t start = likely.start(symbol);
                    out.symbol(start, likely.start(symbol + 1) - start);
                  }
                  out.raw(offset & ((1u << rest) - 1), rest);
                  return middle_of(offset, samples.offset_bits);
                });
              });
  return count == 0 ? std::string() : static_cast<char>(model) + out.take();
}

/// The model that is better for the first edges; kOffsetModels: the brick has none.
std::size_t better_model(const SurfaceSamples& samples, const BrickItems& items) {
  std::size_t best = kOffsetModels, least = ~std::size_t{0};
  for (std::size_t model = 0; model < kOffsetModels; ++model) {
    const std::size_t bytes = encode_offsets(samples, items, model, kTrial).size();
    if (bytes != 0 && bytes < least) best = model, least = bytes;
  }
  return best;
}

std::string encode_offsets(const SurfaceSamples& samples, const BrickItems& items) {
  const std::size_t model = better_model(samples, items);
  if (model == kOffsetModels) return {};
  return encode_offsets(samples, items, model, std::numeric_limits<int>::max());
}

/// What offsets of OffsetTable::kBits bits cost, in bits, by estimate and offset.
class OffsetCosts {
 public:
  static double of(double share) { return -std::log2(share / 65536.0); }
  static const OffsetCosts& instance() {
    static const OffsetCosts costs;
    return costs;
  }
  OffsetCosts() : rows_(32 * 256) {
    for (int spread = 0; spread < 32; ++spread)
      for (int mean = -128; mean < 128; ++mean) {
        const OffsetTable::Starts& starts = OffsetTable::instance().starts({mean, spread});
        for (std::uint32_t k = 0; k < 16; ++k)
          rows_[row(spread, mean)][k] = of(static_cast<double>(OffsetTable::end(starts, k) - starts[k]));
      }
  }
  const std::array<double, 16>& row_of(const OffsetEstimate& e) const { return rows_[row(e.spread, e.mean)]; }

 private:
  static std::size_t row(int spread, int mean) {
    return static_cast<std::size_t>(spread) * 256 + static_cast<std::size_t>(mean + 128);
  }
  std::vector<std::array<double, 16>> rows_;
};

void choose_brick_offsets(SurfaceSamples& samples, const BrickItems& items, OffsetPrices& prices) {
  const std::size_t model = better_model(samples, items);
  if (model == kOffsetModels) return;
  const OffsetModel& network = OffsetModel::instance(model);
  const OffsetCosts& costs = OffsetCosts::instance();
  OffsetWindow window(items.signs());
  OffsetRows rows(network, window);
  const auto choose = [&](std::uint32_t number, const OffsetEstimate& estimate) {
    const auto [first, last] = prices.range(number);
    if (first >= last) return;
    std::array<double, std::size_t{1} << kModelledBits> price;
    prices.prices(number, first, last, price.data());
    const auto cost = [&](int offset) {
      const auto symbol = static_cast<std::uint32_t>(offset);
      if (samples.offset_bits == OffsetTable::kBits) return costs.row_of(estimate)[symbol];
      const OffsetDistribution likely(estimate, samples.offset_bits);
      return OffsetCosts::of(static_cast<double>(likely.start(symbol + 1) - likely.start(symbol)));
    };
    double least = std::numeric_limits<double>::infinity();
    int best = first;
    for (int offset = first; offset <= last; ++offset) {
      const double all = price[static_cast<std::size_t>(offset - first)] + cost(offset);
      if (all < least) best = offset, least = all;
    }
    prices.take(number, best);
    samples.offsets[number] = static_cast<std::uint16_t>(best);
  };
  items.edges([&](int z) { window.begin_slice(z); },
              [&](int axis, int y, int z, std::span<const std::uint8_t> xs, std::uint32_t number) {
                rows.row(axis, y, z, xs, [&](std::size_t i, const OffsetEstimate& estimate) {
                  const auto edge = static_cast<std::uint32_t>(number + i);
                  choose(edge, estimate);
                  return middle_of(samples.offsets[edge], samples.offset_bits);
                });
              });
}

std::string encode_faces(const SurfaceSamples& samples, const BrickItems& items) {
  RangeEncoder out;
  AdaptiveBit joined = kJoined;
  bool any = false;
  items.faces([&](std::uint32_t number) {
    out.bit(joined, samples.joined[number] != 0);
    any = true;
  });
  std::string bytes = out.take();
  if (any && bytes.empty()) bytes.push_back('\0');
  return any ? bytes : std::string();
}
}  // namespace

Result<SampleCode> encode_samples(const SurfaceSamples& samples, Progress& progress) {
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(samples));
  const Dims grid = brick_grid(samples.dims);
  SampleCode code;
  code.offsets.resize(static_cast<std::size_t>(grid.count()));
  code.faces.resize(code.offsets.size());
  progress.begin("encode offsets", grid.count(), "brick");
  parallel_for(grid.count(), 1, [&](std::int64_t i) {
    if (progress.cancelled()) return;
    const BrickItems items(samples, index, brick_low(grid, i));
    code.offsets[static_cast<std::size_t>(i)] = encode_offsets(samples, items);
    code.faces[static_cast<std::size_t>(i)] = encode_faces(samples, items);
    progress.advance(1);
  });
  if (progress.cancelled()) return cancelled_error();
  progress.end();
  return code;
}

Result<void> choose_offsets(SurfaceSamples& samples, OffsetPrices& prices, Progress& progress) {
  DUBSAR_CHECK(samples.offset_bits <= kModelledBits);
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(samples));
  const Dims grid = brick_grid(samples.dims);
  for (std::int64_t turn = 0; turn < 8; ++turn)  // bricks side by side have vertices in common: not at the same time
    parallel_for(grid.count(), 1, [&](std::int64_t i) {
      const std::int64_t x = i % grid.x, y = i / grid.x % grid.y, z = i / grid.slice();
      if (progress.cancelled() || (x & 1) + 2 * (y & 1) + 4 * (z & 1) != turn) return;
      choose_brick_offsets(samples, BrickItems(samples, index, brick_low(grid, i)), prices);
    });
  if (progress.cancelled()) return cancelled_error();
  return {};
}

Result<void> decode_samples(std::span<const std::string_view> offsets, std::span<const std::string_view> faces,
                            SurfaceSamples& samples, Progress& progress, FarSides far_sides) {
  DUBSAR_TRY(check_signs(samples));
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(samples));
  return decode_samples(offsets, faces, index, samples, progress, far_sides);
}

Result<void> decode_samples(std::span<const std::string_view> offsets, std::span<const std::string_view> faces,
                            const EdgeIndex& index, SurfaceSamples& samples, Progress& progress, FarSides far_sides) {
  const Dims grid = brick_grid(samples.dims);
  for (const std::size_t found : {offsets.size(), faces.size()})
    if (found != static_cast<std::size_t>(grid.count()))
      return fail(ErrorKind::kBadData, "exa: {} chunks of offsets or face decisions found, {} bricks expected", found,
                  grid.count());
  const SampleCounts& counts = index.counts();
  DUBSAR_TRY(check_memory("exa offsets", static_cast<std::uint64_t>(counts.edges * 2 + counts.faces)));
  samples.offsets.clear();
  resize_large(samples.offsets, static_cast<std::size_t>(counts.edges));
  samples.joined.assign(static_cast<std::size_t>(counts.faces), 0);
  const int bits = std::min(samples.offset_bits, kModelledBits), rest = samples.offset_bits - bits;
  std::atomic<bool> broken{false};
  progress.begin("decode offsets", grid.count(), "brick");
  parallel_for(grid.count(), 1, [&](std::int64_t i) {
    if (progress.cancelled()) return;
    const auto slot = static_cast<std::size_t>(i);
    if (offsets[slot].empty() && faces[slot].empty()) return;
    const BrickItems items(samples, index, brick_low(grid, i), far_sides);
    if (!offsets[slot].empty()) {
      const auto model = static_cast<unsigned char>(offsets[slot][0]);
      if (model >= kOffsetModels) {
        broken = true;
        return;
      }
      const OffsetModel& network = OffsetModel::instance(model);
      OffsetWindow window(items.signs());
      RangeDecoder in(offsets[slot].substr(1));
      OffsetRows rows(network, window);
      items.edges([&](int z) { window.begin_slice(z); },
                  [&](int axis, int y, int z, std::span<const std::uint8_t> xs, std::uint32_t number) {
                    std::uint16_t* to = samples.offsets.data() + number;
                    if (bits + rest == OffsetTable::kBits) return rows.decode(axis, y, z, xs, in, to);
                    rows.row(axis, y, z, xs, [&](std::size_t k, const OffsetEstimate& estimate) {
                      const OffsetDistribution likely(estimate, bits);
                      const std::uint32_t symbol = likely.find(in.place()), start = likely.start(symbol);
                      in.symbol(start, likely.start(symbol + 1) - start);
                      const std::uint32_t offset = symbol << rest | in.raw(rest);
                      to[k] = static_cast<std::uint16_t>(offset);
                      return middle_of(offset, bits + rest);
                    });
                  });
    }
    if (!faces[slot].empty()) {
      RangeDecoder in(faces[slot]);
      AdaptiveBit joined = kJoined;
      items.faces([&](std::uint32_t number) { samples.joined[number] = in.bit(joined) ? 1 : 0; });
    }
    progress.advance(1);
  });
  if (progress.cancelled()) return cancelled_error();
  if (broken) return fail(ErrorKind::kBadData, "exa: a brick of offsets names a model that is not known");
  progress.end();
  return {};
}

void put_crossings_half_way(SurfaceSamples& samples, const EdgeIndex& index, std::size_t brick) {
  const BrickItems items(samples, index, brick_low(brick_grid(samples.dims), static_cast<std::int64_t>(brick)));
  const auto half = static_cast<std::uint16_t>(1U << (samples.offset_bits - 1));
  items.edges([](int) {},
              [&](int, int, int, std::span<const std::uint8_t> xs, std::uint32_t number) {
                std::fill_n(samples.offsets.begin() + number, xs.size(), half);
              });
}

}  // namespace dubsar
