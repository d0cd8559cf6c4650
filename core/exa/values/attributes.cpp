#include "core/exa/values/attributes.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdlib>
#include <span>

#include "core/base/system/large_pages.h"
#include "core/exa/coding/symbol_coder.h"
#include "core/exa/values/known_levels.h"
#include "core/exa/values/vertex_order.h"

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
    const std::uint32_t shape =
        shapes_[static_cast<std::size_t>(shape_mean) * 4 + static_cast<std::size_t>(apart)].code(
            coder, values[v] == 0 ? 0u : static_cast<std::uint32_t>((values[v] - 1) % 9));
    return static_cast<std::uint8_t>(1 + 9 * (step - 1) + shape);
  }

 private:
  static int step_of(std::uint8_t value) { return value == 0 ? 0 : 1 + (value - 1) / 9; }
  std::array<BitTree<4>, 31> steps_;
  std::array<BitTree<4>, 76> shapes_;
};

/// Light as the neighbours let expect it, and how far they are apart.
struct LightContext {
  int expected = 48, apart = 9;
};
[[gnu::always_inline]] inline LightContext light_context(const LevelsAround& levels, const QuadMesh& mesh,
                                                         std::uint32_t v) {
  const KnownLevels known = levels.of(mesh, v);
  if (known.shares == 0) return {};
  return {known.mean(), std::min(8, known.highest - known.lowest)};
}
/// Steps from the expected level to the nearest that can be had.
int light_steps(int level, int expected, int step) {
  const int apart = level - expected;
  return (apart + (apart < 0 ? -step / 2 : step / 2)) / step;
}
int light_at(int expected, int steps, int step) { return std::clamp(expected + steps * step, 0, 63); }

/// The difference from what the neighbours let expect, by how far they are apart.
class LightCode {
 public:
  LightCode(int step, std::uint32_t first, std::uint32_t end) : step_(step), levels_(first, end) {}
  template <class Coder>
  [[gnu::always_inline]] std::uint8_t code(Coder& coder, const QuadMesh& mesh, const std::uint8_t* values,
                                           std::uint32_t v, std::uint32_t) {
    const LightContext context = light_context(levels_, mesh, v);
    const int wanted = Coder::kWrites ? light_steps(values[v], context.expected, step_) : 0;
    const int steps = numbers_[static_cast<std::size_t>(context.apart)].code(coder, wanted);
    const auto level = static_cast<std::uint8_t>(light_at(context.expected, steps, step_));
    levels_.set(v, level);
    return level;
  }

 private:
  int step_;
  LevelsAround levels_;
  std::array<SignedNumber, 10> numbers_;
};

/// Votes for 0..7, a byte each; the value with most, the lowest of equals.
std::size_t most_votes(std::uint64_t votes) {
  if (votes == 0) return 0;
  const auto lowest = static_cast<std::size_t>(std::countr_zero(votes)) / 8;
  if (votes >> 8 * lowest < 256) return lowest;  // all agree, the usual case
  std::size_t best = lowest;
  for (std::size_t value = lowest + 1; value < 8; ++value)
    if ((votes >> 8 * value & 255) > (votes >> 8 * best & 255)) best = value;
  return best;
}

/// The value of the last x-quad of a chunk around each vertex. X-quads and vertices are in the order of their cells, so
/// the vertices of a chunk lie within two slices and a few rows of the grid.
class LastAround {
 public:
  LastAround(const QuadMesh& mesh, std::uint32_t first, std::uint32_t end) : mesh_(mesh) {
    if (first == end) return;
    std::uint32_t last = 0;
    low_ = ~std::uint32_t{0};
    const auto see = [&](std::uint32_t v) {
      low_ = std::min(low_, v);
      last = std::max(last, v);
    };
    for (const std::uint32_t v : std::span(mesh.quads[first].data(), 4 * std::size_t{end - first})) see(v);
    for (auto d = std::lower_bound(mesh.doubled.begin(), mesh.doubled.end(), first,
                                   [](const DoubledCorner&corner, std::uint32_t q) { return corner.quad < q; });
         d != mesh.doubled.end() && d->quad < end; ++d)
      see(d->vertex);
    values_.assign(last - low_ + 1, kNone);
  }
  static constexpr std::uint8_t kNone = 255;
  std::uint8_t of(std::uint32_t v) const { return values_[v - low_]; }
  void set(std::uint32_t q, std::uint8_t value) {
    each_vertex(q, [&](std::uint32_t v) { values_[v - low_] = value; });
  }

 private:
  template <class Visit>
  void each_vertex(std::uint32_t q, const Visit& visit) const {
    for (const std::uint32_t v : mesh_.quads[q]) visit(v);
    if (!mesh_.has_doubled(q)) return;
    const Polygon polygon = mesh_.polygon(q);
    for (int i = 0; i < polygon.size; ++i) visit(polygon.vertex[static_cast<std::size_t>(i)]);
  }

  const QuadMesh& mesh_;
  std::uint32_t low_ = 0;
  std::vector<std::uint8_t> values_;
};

/// That of the x-quad coded before around one of the corners, or another one.
class PartitionCode {
 public:
  PartitionCode(const QuadMesh& mesh, std::uint32_t first, std::uint32_t end) : last_(mesh, first, end) {}
  template <class Coder>
  std::uint8_t code(Coder& coder, const QuadMesh& mesh, const std::uint8_t* values, std::uint32_t q, std::uint32_t) {
    std::uint64_t votes = 0;  // of four corners: their number fits a byte, too
    for (const std::uint32_t v : mesh.quads[q]) votes += kVotes[last_.of(v)];
    const std::size_t best = most_votes(votes);
    const auto context = static_cast<std::size_t>(5 * (votes * 0x0101010101010101u >> 56) + (votes >> 8 * best & 255));
    auto value = static_cast<std::uint8_t>(best);
    if (!coder.steady_bit(same_[context], values[q] == best))
      value = static_cast<std::uint8_t>(other_[best].code(coder, values[q]));
    last_.set(q, value);
    return value;
  }

 private:
  /// By value; none for LastAround::kNone.
  static constexpr std::array<std::uint64_t, 256> kVotes = [] {
    std::array<std::uint64_t, 256> votes{};
    for (std::size_t value = 0; value < LastAround::kNone; ++value) votes[value] = std::uint64_t{1} << 8 * (value & 7);
    return votes;
  }();

  LastAround last_;
  std::array<AdaptiveBit, 25> same_;
  std::array<BitTree<3>, 8> other_;
};

/// A small number per vertex: that of most known neighbours, or another one.
class EnumCode {
 public:
  template <class Coder>
  std::uint8_t code(Coder& coder, const QuadMesh& mesh, const std::uint8_t* values, std::uint32_t v,
                    std::uint32_t first) {
    if (v == first) one_value_ = true;
    const std::size_t context = one_value_ && v != first ? context_of_one(mesh, values[first], v, first)
                                                         : context_of_votes(mesh, values, v, first);
    const std::size_t best = context / 16;
    std::uint8_t value = static_cast<std::uint8_t>(best);
    if (!coder.steady_bit(same_[context], values[v] == best))
      value = static_cast<std::uint8_t>(other_[best].code(coder, values[v]));
    one_value_ = one_value_ && (v == first || value == values[first]);
    return value;
  }

 private:
  static std::size_t context_of_votes(const QuadMesh& mesh, const std::uint8_t* values, std::uint32_t v,
                                      std::uint32_t first) {
    std::array<int, 8> votes{};
    int all = 0;
    known_surroundings(mesh, v, first, [&](std::uint32_t w, int share) {
      votes[values[w] & 7] += share;
      all += share;
    });
    const auto best = static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    return best * 16 + (all == 0 ? 8 : static_cast<std::size_t>(std::min(7, all - votes[best])));
  }
  /// The same where all values so far are one.
  static std::size_t context_of_one(const QuadMesh& mesh, std::uint8_t value, std::uint32_t v, std::uint32_t first) {
    return has_known_surroundings(mesh, v, first) ? std::size_t{value & 7u} * 16 : 8;
  }

  bool one_value_ = true;
  std::array<AdaptiveBit, 128> same_;
  std::array<BitTree<3>, 8> other_;
};

template <class Code, class... Args>
std::string encode_chunk(const QuadMesh& mesh, std::span<const std::uint8_t> values, std::uint32_t first,
                         std::uint32_t end, const Args&... args) {
  RangeEncoder out;
  BitSink sink{out};
  Code code(args...);
  for (std::uint32_t i = first; i < end; ++i) code.code(sink, mesh, values.data(), i, first);
  return out.take();
}

/// The first byte of a chunk of light is the step. Nothing where steps of this size do not lead to all levels.
std::string encode_light_chunk(const QuadMesh& mesh, std::span<const std::uint8_t> values, std::uint32_t first,
                               std::uint32_t end, int step) {
  RangeEncoder out;
  BitSink sink{out};
  LightCode code(step, first, end);
  for (std::uint32_t i = first; i < end; ++i)
    if (code.code(sink, mesh, values.data(), i, first) != values[i]) return {};
  return static_cast<char>(step) + out.take();
}
std::string encode_light_chunk(const QuadMesh& mesh, std::span<const std::uint8_t> values, std::uint32_t first,
                               std::uint32_t end) {
  std::string code = encode_light_chunk(mesh, values, first, end, kLightStep);
  return code.empty() ? encode_light_chunk(mesh, values, first, end, 1) : code;
}

/// False: a value out of range.
template <class Code>
bool decode_chunk(Code code, RangeDecoder in, const QuadMesh& mesh, std::uint32_t first, std::uint32_t end, int highest,
                  std::vector<std::uint8_t>& values) {
  BitSource source{in};
  for (std::uint32_t i = first; i < end; ++i) {
    values[i] = code.code(source, mesh, values.data(), i, first);
    if (values[i] > highest) return false;
  }
  return true;
}

bool decode_chunk(ExaLabel label, std::string_view bytes, const QuadMesh& mesh, std::uint32_t first, std::uint32_t end,
                  std::vector<std::uint8_t>& values) {
  const int highest = highest_label(label);
  switch (label) {
    case ExaLabel::kShape:
      return decode_chunk(ShapeCode(), RangeDecoder(bytes), mesh, first, end, highest, values);
    case ExaLabel::kEnum:
      return decode_chunk(EnumCode(), RangeDecoder(bytes), mesh, first, end, highest, values);
    case ExaLabel::kPartition:
      return decode_chunk(PartitionCode(mesh, first, end), RangeDecoder(bytes), mesh, first, end, highest, values);
    case ExaLabel::kLight: {
      const int step = bytes.empty() ? 0 : bytes[0];
      return (step == 1 || step == kLightStep) &&
             decode_chunk(LightCode(step, first, end), RangeDecoder(bytes.substr(1)), mesh, first, end, highest,
                          values);
    }
  }
  return false;
}
}  // namespace

void settle_light(const QuadMesh& mesh, std::span<std::uint8_t> light, Progress& progress) {
  parallel_for(item_chunks(static_cast<std::int64_t>(light.size())), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    const auto first = static_cast<std::uint32_t>(c * kItemsPerChunk);
    const auto end = static_cast<std::uint32_t>(
        std::min<std::int64_t>(first + kItemsPerChunk, static_cast<std::int64_t>(light.size())));
    LevelsAround levels(first, end);
    for (std::uint32_t v = first; v < end; ++v) {
      const int expected = light_context(levels, mesh, v).expected;
      light[v] = static_cast<std::uint8_t>(light_at(expected, light_steps(light[v], expected, kLightStep), kLightStep));
      levels.set(v, light[v]);
    }
  });
}

std::vector<std::string> encode_labels(ExaLabel label, const QuadMesh& mesh, std::span<const std::uint8_t> values,
                                       Progress& progress) {
  return encode_item_chunks(static_cast<std::int64_t>(values.size()), progress,
                            [&](std::uint32_t first, std::uint32_t end) {
                              switch (label) {
                                case ExaLabel::kShape:
                                  return encode_chunk<ShapeCode>(mesh, values, first, end);
                                case ExaLabel::kLight:
                                  return encode_light_chunk(mesh, values, first, end);
                                case ExaLabel::kEnum:
                                  return encode_chunk<EnumCode>(mesh, values, first, end);
                                default:
                                  return encode_chunk<PartitionCode>(mesh, values, first, end, mesh, first, end);
                              }
                            });
}

Result<std::vector<std::uint8_t>> decode_labels(ExaLabel label, const QuadMesh& mesh,
                                                std::span<const std::string_view> chunks, Progress& progress,
                                                std::int64_t items) {
  if (items < 0) items = label == ExaLabel::kPartition ? mesh.quad_count() : mesh.vertex_count();
  if (static_cast<std::int64_t>(chunks.size()) != item_chunks(items))
    return fail(ErrorKind::kBadData, "exa: {} chunks of an attribute found, {} expected for {} items", chunks.size(),
                item_chunks(items), items);
  auto values = large_array<std::vector<std::uint8_t>>(static_cast<std::size_t>(items));
  std::atomic<bool> whole{true};
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    const auto first = static_cast<std::uint32_t>(c * kItemsPerChunk);
    const auto end = static_cast<std::uint32_t>(std::min<std::int64_t>(first + kItemsPerChunk, items));
    if (!decode_chunk(label, chunks[static_cast<std::size_t>(c)], mesh, first, end, values)) whole = false;
  });
  if (progress.cancelled()) return cancelled_error();
  if (!whole) return fail(ErrorKind::kBadData, "exa: an attribute is larger than {}", highest_label(label));
  return values;
}

}  // namespace dubsar
