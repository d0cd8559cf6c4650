#include "core/exa/labels/label_plane.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "core/base/system/parallel.h"
#include "core/exa/coding/range_coder.h"
#include "core/exa/labels/label_brick.h"
#include "core/exa/signs/topology.h"

namespace dubsar {
namespace {

constexpr std::int64_t kLabelBricksAtOnce = 64;  ///< decoded before they are put together: 16 MiB

struct LabelSink {
  static constexpr bool kWrites = true;
  RangeEncoder& out;
  bool bit(AdaptiveBit& model, bool value) {
    out.bit(model, value);
    return value;
  }
  bool bit(std::uint32_t p, bool value) {
    out.bit(p, value);
    return value;
  }
};
struct LabelSource {
  static constexpr bool kWrites = false;
  RangeDecoder& in;
  bool bit(AdaptiveBit& model, bool) { return in.bit(model); }
  bool bit(std::uint32_t p, bool) { return in.bit(p); }
};

struct LabelBox {
  std::array<std::int64_t, 3> low{};
  std::array<int, 3> points{};
};
LabelBox label_box(const Dims& dims, std::int64_t brick) {
  const Dims grid = brick_grid(dims);
  const std::array<std::int64_t, 3> at{brick % grid.x, brick / grid.x % grid.y, brick / grid.slice()},
      size{dims.x, dims.y, dims.z};
  LabelBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = at[a] * kBrickCells;
    const std::int64_t left = size[a] - box.low[a];  // the far side of the last brick belongs to it
    box.points[a] = static_cast<int>(left <= kBrickCells + 1 ? left : kBrickCells);
  }
  return box;
}

/// The clay of a brick, without points that belong to the next.
LabelRows rows_of(const BitVolume& signs, const LabelBox& box) {
  LabelRows rows;
  rows.points = box.points;
  rows.clay.resize(static_cast<std::size_t>(box.points[1]) * static_cast<std::size_t>(box.points[2]));
  rows.envelope.resize(rows.clay.size());
  const std::int64_t first = box.low[0] / 64;
  for (int z = 0; z < box.points[2]; ++z)
    for (int y = 0; y < box.points[1]; ++y)
      for (std::int64_t w = 0; 64 * w < box.points[0]; ++w)
        rows.clay[rows.row(y, z)][static_cast<std::size_t>(w)] = signs.row(box.low[1] + y, box.low[2] + z)[first + w];
  return rows;
}

}  // namespace

Result<std::vector<std::string>> encode_label_plane(const BitVolume& signs, const EnvelopeBits& envelope,
                                                    Progress& progress) {
  const std::int64_t bricks = brick_grid(signs.dims()).count();
  std::vector<std::string> chunks(static_cast<std::size_t>(bricks));
  progress.begin("encode labels", bricks, "brick");
  parallel_for(bricks, 1, [&](std::int64_t i) {
    if (progress.cancelled()) return;
    progress.advance(1);
    const LabelBox box = label_box(signs.dims(), i);
    LabelRows rows = rows_of(signs, box);
    bool any = false;
    for (int z = 0; z < box.points[2]; ++z)
      for (int y = 0; y < box.points[1]; ++y)
        for (std::size_t w = 0; w < LabelRows::kWords; ++w) {
          const std::uint64_t clay = rows.clay[rows.row(y, z)][w];
          if (clay == 0) continue;
          const std::uint64_t own =
              clay & envelope.word(box.low[0] / 64 + static_cast<std::int64_t>(w), box.low[1] + y, box.low[2] + z);
          rows.envelope[rows.row(y, z)][w] = own;
          any = any || own != 0;
        }
    if (!any) return;
    RangeEncoder out;
    LabelSink sink{out};
    LabelBrick(rows).code(sink, [](std::uint64_t) { return true; });
    std::string& chunk = chunks[static_cast<std::size_t>(i)];
    chunk = out.take();
    if (chunk.empty()) chunk.push_back('\0');
  });
  if (progress.cancelled()) return cancelled_error();
  progress.end();
  return chunks;
}

Result<EnvelopeBits> decode_label_plane(std::span<const std::string_view> chunks, const BitVolume& signs,
                                        std::uint64_t most_points, Progress& progress) {
  const std::int64_t bricks = brick_grid(signs.dims()).count();
  if (chunks.size() != static_cast<std::size_t>(bricks))
    return fail(ErrorKind::kBadData, "exa: {} chunks of labels found, {} bricks expected", chunks.size(), bricks);
  EnvelopeBits envelope(signs.dims());
  std::atomic<std::uint64_t> coded{0};
  std::atomic<bool> too_many{false};
  progress.begin("decode labels", bricks, "brick");
  std::vector<LabelRows> decoded(std::min<std::size_t>(chunks.size(), kLabelBricksAtOnce));
  for (std::int64_t first = 0; first < bricks; first += kLabelBricksAtOnce) {
    const std::int64_t count = std::min<std::int64_t>(kLabelBricksAtOnce, bricks - first);
    parallel_for(count, 1, [&](std::int64_t i) {
      progress.advance(1);
      LabelRows& rows = decoded[static_cast<std::size_t>(i)];
      rows = {};
      const std::string_view chunk = chunks[static_cast<std::size_t>(first + i)];
      if (chunk.empty() || progress.cancelled() || too_many) return;
      rows = rows_of(signs, label_box(signs.dims(), first + i));
      RangeDecoder in(chunk);
      LabelSource source{in};
      const bool fits =
          LabelBrick(rows).code(source, [&](std::uint64_t more) { return (coded += more) <= most_points; });
      if (!fits) too_many = true;
    });
    if (progress.cancelled()) return cancelled_error();
    if (too_many)
      return fail(ErrorKind::kBadData, "exa: more than {} labels are coded, the most that a surface of this file has",
                  most_points);
    for (std::int64_t i = 0; i < count; ++i) {
      const LabelRows& rows = decoded[static_cast<std::size_t>(i)];
      if (rows.clay.empty()) continue;
      const LabelBox box = label_box(signs.dims(), first + i);
      for (int z = 0; z < box.points[2]; ++z)
        for (int y = 0; y < box.points[1]; ++y)
          for (std::size_t w = 0; w < LabelRows::kWords; ++w)
            if (const std::uint64_t own = rows.envelope[rows.row(y, z)][w]; own != 0)
              envelope.set_word(box.low[0] / 64 + static_cast<std::int64_t>(w), box.low[1] + y, box.low[2] + z, own);
    }
  }
  envelope.compact(signs);
  progress.end();
  return envelope;
}

}  // namespace dubsar
