#include "core/exa/attributes.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>

#include "core/exa/symbol_coder.h"
#include "core/exa/vertex_order.h"

namespace dubsar {
namespace {

/// 0 flat, else 1 + 9 curvedness + shape: the curvedness (0 flat, 1..14) given those of the neighbours, then the shape
/// given theirs.
class ShapeCode {
 public:
  template <class Coder>
  std::uint8_t code(Coder& coder, const QuadMesh& mesh, const std::uint8_t* values, std::uint32_t v,
                    std::uint32_t first) {
    int sum = 0, count = 0, shapes = 0, latest = 9, before = 9;
    int shape_sum = 0;
    known_neighbours(mesh, v, first, [&](std::uint32_t w) {
      sum += step_of(values[w]);
      ++count;
      if (values[w] == 0) return;
      before = latest;
      latest = (values[w] - 1) % 9;
      shape_sum += latest;
      ++shapes;
    });
    const int mean = count == 0 ? 30 : (2 * sum + count / 2) / count;  // 0..28 in half steps
    const std::uint32_t step =
        steps_[static_cast<std::size_t>(mean)].code(coder, static_cast<std::uint32_t>(step_of(values[v])));
    if (step == 0) return 0;
    const int shape_mean = shapes == 0 ? 18 : (2 * shape_sum + shapes / 2) / shapes;  // 0..16
    const int apart = shapes < 2 ? 0 : std::min(3, std::abs(latest - before));
    const std::uint32_t shape = shapes_[static_cast<std::size_t>(shape_mean * 4 + apart)].code(
        coder, values[v] == 0 ? 0u : static_cast<std::uint32_t>((values[v] - 1) % 9));
    return static_cast<std::uint8_t>(1 + 9 * (step - 1) + shape);
  }

 private:
  static int step_of(std::uint8_t value) { return value == 0 ? 0 : 1 + (value - 1) / 9; }
  std::array<BitTree<4>, 31> steps_;
  std::array<BitTree<4>, 76> shapes_;
};

/// The difference from the mean of the neighbours, by how far they are apart.
class LightCode {
 public:
  template <class Coder>
  std::uint8_t code(Coder& coder, const QuadMesh& mesh, const std::uint8_t* values, std::uint32_t v,
                    std::uint32_t first) {
    int sum = 0, count = 0, low = 63, high = 0;
    known_neighbours(mesh, v, first, [&](std::uint32_t w) {
      sum += values[w];
      low = std::min<int>(low, values[w]);
      high = std::max<int>(high, values[w]);
      ++count;
    });
    const int mean = count == 0 ? 48 : (sum + count / 2) / count;
    const int apart = count == 0 ? 9 : std::min(8, high - low);
    return static_cast<std::uint8_t>(mean +
                                     numbers_[static_cast<std::size_t>(apart)].code(coder, int{values[v]} - mean));
  }

 private:
  std::array<SignedNumber, 10> numbers_;
};

/// That of the x-quad coded before around one of the corners, or another one.
class PartitionCode {
 public:
  template <class Coder>
  std::uint8_t code(Coder& coder, const QuadMesh& mesh, const std::uint8_t* values, std::uint32_t q,
                    std::uint32_t first) {
    std::array<int, 8> votes{};
    int all = 0;
    for (const std::uint32_t v : mesh.quads[q]) {
      const auto around = mesh.quads_of(v);
      const auto here = std::lower_bound(around.begin(), around.end(), q);
      if (here == around.begin() || here[-1] < first) continue;
      ++votes[values[here[-1]] & 7];
      ++all;
    }
    const auto best = static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    const auto context = static_cast<std::size_t>(all * 5 + votes[best]);
    if (coder.bit(same_[context], values[q] == best)) return static_cast<std::uint8_t>(best);
    return static_cast<std::uint8_t>(other_[best].code(coder, values[q]));
  }

 private:
  std::array<AdaptiveBit, 25> same_;
  std::array<BitTree<3>, 8> other_;
};

template <class Code>
std::vector<std::string> encode(const QuadMesh& mesh, std::span<const std::uint8_t> values, Progress& progress) {
  return encode_item_chunks(static_cast<std::int64_t>(values.size()), progress,
                            [&](std::uint32_t first, std::uint32_t end) {
                              RangeEncoder out;
                              BitSink sink{out};
                              Code code;
                              for (std::uint32_t i = first; i < end; ++i)
                                code.code(sink, mesh, values.data(), i, first);
                              return out.take();
                            });
}

template <class Code>
bool decode(const QuadMesh& mesh, std::span<const std::string_view> chunks, int highest,
            std::vector<std::uint8_t>& values, Progress& progress) {
  std::atomic<bool> broken{false};
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    RangeDecoder in(chunks[static_cast<std::size_t>(c)]);
    BitSource source{in};
    Code code;
    const auto first = static_cast<std::uint32_t>(c * kItemsPerChunk);
    const auto end = static_cast<std::uint32_t>(
        std::min<std::int64_t>(first + kItemsPerChunk, static_cast<std::int64_t>(values.size())));
    for (std::uint32_t i = first; i < end; ++i) {
      values[i] = code.code(source, mesh, values.data(), i, first);
      if (values[i] > highest) {
        broken = true;
        return;
      }
    }
  });
  return !broken;
}
}  // namespace

std::vector<std::string> encode_labels(ExaLabel label, const QuadMesh& mesh, std::span<const std::uint8_t> values,
                                       Progress& progress) {
  switch (label) {
    case ExaLabel::kShape:
      return encode<ShapeCode>(mesh, values, progress);
    case ExaLabel::kLight:
      return encode<LightCode>(mesh, values, progress);
    default:
      return encode<PartitionCode>(mesh, values, progress);
  }
}

Result<std::vector<std::uint8_t>> decode_labels(ExaLabel label, const QuadMesh& mesh,
                                                std::span<const std::string_view> chunks, Progress& progress) {
  const std::int64_t items = label == ExaLabel::kPartition ? mesh.quad_count() : mesh.vertex_count();
  if (static_cast<std::int64_t>(chunks.size()) != item_chunks(items))
    return fail(ErrorKind::kBadData, "exa: {} chunks of an attribute found, {} expected for {} items", chunks.size(),
                item_chunks(items), items);
  std::vector<std::uint8_t> values(static_cast<std::size_t>(items));
  const int highest = highest_label(label);
  const bool whole = label == ExaLabel::kShape   ? decode<ShapeCode>(mesh, chunks, highest, values, progress)
                     : label == ExaLabel::kLight ? decode<LightCode>(mesh, chunks, highest, values, progress)
                                                 : decode<PartitionCode>(mesh, chunks, highest, values, progress);
  if (progress.cancelled()) return cancelled_error();
  if (!whole) return fail(ErrorKind::kBadData, "exa: an attribute is larger than {}", highest);
  return values;
}

}  // namespace dubsar
