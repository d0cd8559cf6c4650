#include "core/exa/labels/contact_offsets.h"

#include <algorithm>
#include <atomic>

#include "core/base/system/parallel.h"
#include "core/exa/coding/range_coder.h"
#include "core/exa/offsets/offset_choice.h"
#include "core/exa/offsets/offset_model.h"
#include "core/exa/offsets/offset_rows.h"
#include "core/exa/signs/brick_items.h"
#include "core/exa/signs/topology.h"

namespace dubsar {
namespace {

std::array<std::int64_t, 3> low_of_brick(const Dims& grid, std::int64_t index) {
  return {index % grid.x * kBrickCells, index / grid.x % grid.y * kBrickCells, index / grid.slice() * kBrickCells};
}

/// The tablet's clay as inside, all else as outside: its active edges are those of the tablet's surface.
SurfaceSamples tablet_of(const KnownContact& contact) {
  SurfaceSamples tablet;
  tablet.dims = contact.samples.dims;
  tablet.offset_bits = contact.samples.offset_bits;
  tablet.closed = contact.samples.closed;
  tablet.signs = BitVolume(tablet.dims);
  parallel_for(tablet.dims.z, 1, [&](std::int64_t z) {
    for (std::int64_t y = 0; y < tablet.dims.y; ++y)
      for (std::int64_t w = 0; w < tablet.signs.words_per_row(); ++w)
        tablet.signs.row(y, z)[w] = contact.labels.tablet_word(w, y, z);
  });
  return tablet;
}

/// 1 for each brick in which an edge of the contact begins.
std::vector<std::uint8_t> bricks_with_contact(const KnownContact& contact, const Dims& grid) {
  std::vector<std::uint8_t> found(static_cast<std::size_t>(grid.count()), 0);
  const auto brick = [](std::int32_t at, std::int64_t bricks) {
    return std::min<std::int64_t>(at / kBrickCells, bricks - 1);
  };
  for (const GridEdge& e : contact.edges.all())
    found[static_cast<std::size_t>((brick(e.z, grid.z) * grid.y + brick(e.y, grid.y)) * grid.x + brick(e.x, grid.x))] =
        1;
  return found;
}

/// Goes through the tablet's edges of a brick: code(number, estimate) gives the offset of an edge of the contact.
template <class Code>
void walk_contact(const KnownContact& contact, const BrickItems& items, const std::array<std::int64_t, 3>& low,
                  std::size_t model, const Code& code) {
  OffsetWindow window(items.signs());
  OffsetRows rows(OffsetModel::instance(model), window);
  const BitVolume& clay = contact.samples.signs;
  items.edges(
      [&](int z) { window.begin_slice(z); },
      [&](int axis, int y, int z, std::span<const std::uint8_t> xs, std::uint32_t) {
        rows.row(axis, y, z, xs, [&](std::size_t i, const OffsetEstimate& estimate) {
          const std::int64_t gx = low[0] + xs[i], gy = low[1] + y, gz = low[2] + z;
          const bool touches = clay.get(gx, gy, gz) && clay.get(gx + (axis == 0), gy + (axis == 1), gz + (axis == 2));
          const std::uint32_t offset = touches ? code(contact.edges.number(axis, gx, gy, gz), estimate)
                                               : contact.samples.offsets[contact.index.quad_of(axis, gx, gy, gz)];
          return static_cast<int>((2 * offset + 1) << 5 >> contact.samples.offset_bits);
        });
      });
}

}  // namespace

Result<std::vector<std::string>> encode_contact_offsets(const KnownContact& contact,
                                                        std::span<const std::uint16_t> offsets, Progress& progress) {
  const SurfaceSamples tablet = tablet_of(contact);
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(tablet));
  const Dims grid = brick_grid(tablet.dims);
  const std::vector<std::uint8_t> wanted = bricks_with_contact(contact, grid);
  const int bits = std::min(tablet.offset_bits, kModelledBits), rest = tablet.offset_bits - bits;
  std::vector<std::string> chunks(wanted.size());
  progress.begin("encode contact", grid.count(), "brick");
  parallel_for(grid.count(), 1, [&](std::int64_t brick) {
    progress.advance(1);
    if (wanted[static_cast<std::size_t>(brick)] == 0 || progress.cancelled()) return;
    const auto low = low_of_brick(grid, brick);
    const BrickItems items(tablet, index, low);
    std::string& best = chunks[static_cast<std::size_t>(brick)];
    for (std::size_t model = 0; model < kOffsetModels; ++model) {
      RangeEncoder out;
      walk_contact(contact, items, low, model, [&](std::uint32_t number, const OffsetEstimate& estimate) {
        const std::uint32_t offset = offsets[number], symbol = offset >> rest;
        const OffsetDistribution likely(estimate, bits);
        const std::uint32_t start = likely.start(symbol);
        out.symbol(start, likely.start(symbol + 1) - start);
        out.raw(offset & ((1u << rest) - 1), rest);
        return offset;
      });
      std::string chunk = static_cast<char>(model) + out.take();
      if (best.empty() || chunk.size() < best.size()) best = std::move(chunk);
    }
  });
  if (progress.cancelled()) return cancelled_error();
  progress.end();
  return chunks;
}

Result<std::vector<std::uint16_t>> decode_contact_offsets(std::span<const std::string_view> chunks,
                                                          const KnownContact& contact, Progress& progress) {
  const Dims grid = brick_grid(contact.samples.dims);
  if (chunks.size() != static_cast<std::size_t>(grid.count()))
    return fail(ErrorKind::kBadData, "exa: {} chunks of the contact's offsets found, {} bricks expected", chunks.size(),
                grid.count());
  const SurfaceSamples tablet = tablet_of(contact);
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(tablet));
  const int bits = std::min(tablet.offset_bits, kModelledBits), rest = tablet.offset_bits - bits;
  const std::vector<std::uint8_t> wanted = bricks_with_contact(contact, grid);
  std::vector<std::uint16_t> offsets(contact.edges.all().size(), 0);
  std::atomic<bool> broken{false};
  progress.begin("decode contact", grid.count(), "brick");
  parallel_for(grid.count(), 1, [&](std::int64_t brick) {
    progress.advance(1);
    const std::string_view chunk = chunks[static_cast<std::size_t>(brick)];
    if (chunk.empty() || wanted[static_cast<std::size_t>(brick)] == 0 || progress.cancelled()) return;
    const auto model = static_cast<unsigned char>(chunk[0]);
    if (model >= kOffsetModels) {
      broken = true;
      return;
    }
    const auto low = low_of_brick(grid, brick);
    RangeDecoder in(chunk.substr(1));
    walk_contact(contact, BrickItems(tablet, index, low), low, model,
                 [&](std::uint32_t number, const OffsetEstimate& estimate) {
                   const OffsetDistribution likely(estimate, bits);
                   const std::uint32_t symbol = likely.find(in.place()), start = likely.start(symbol);
                   in.symbol(start, likely.start(symbol + 1) - start);
                   const std::uint32_t offset = symbol << rest | in.raw(rest);
                   offsets[number] = static_cast<std::uint16_t>(offset);
                   return offset;
                 });
  });
  if (progress.cancelled()) return cancelled_error();
  if (broken) return fail(ErrorKind::kBadData, "exa: a brick of the contact's offsets names a model that is not known");
  progress.end();
  return offsets;
}

}  // namespace dubsar
