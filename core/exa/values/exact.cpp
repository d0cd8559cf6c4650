#include "core/exa/values/exact.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include "core/exa/coding/symbol_coder.h"
#include "core/exa/values/same_bits.h"
#include "core/exa/values/vertex_order.h"

namespace dubsar {
namespace {
constexpr int kMostSteps = 511;

/// The bytes of a difference, highest first; a byte's models depend on the byte before.
class DifferenceCode {
 public:
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    const std::uint32_t top = bytes_[0].code(coder, value >> 24);
    const std::uint32_t second = (top == 0 || top == 255 ? bytes_[1] : bytes_[2]).code(coder, value >> 16 & 255);
    const std::uint32_t third = bytes_[3].code(coder, value >> 8 & 255);
    return top << 24 | second << 16 | third << 8 | bytes_[4].code(coder, value & 255);
  }

 private:
  std::array<BitTree<8>, 5> bytes_;
};

class EscapeCode {
 public:
  /// For vertices [first, end) of a mesh.
  EscapeCode(const QuadMesh& mesh, std::uint32_t first, std::uint32_t end)
      : mesh_(mesh), first_(first), near_(end - first, 0) {}
  /// Does a vertex escape? Asked in rising order.
  template <class Coder>
  bool flag(Coder& coder, std::uint32_t v, bool value) {
    const bool gone = coder.steady_bit(flags_[near_[v - first_]], value);
    if (gone) tell_neighbours(v);
    return gone;
  }
  template <class Coder>
  glm::ivec3 steps(Coder& coder, const glm::ivec3& k) {
    glm::ivec3 coded;
    for (int a = 0; a < 3; ++a) coded[a] = numbers_[static_cast<std::size_t>(a)].code(coder, k[a]);
    return coded;
  }

 private:
  /// Few vertices escape: they tell the later ones around them, instead of those asking all before.
  void tell_neighbours(std::uint32_t v) {
    const std::uint32_t end = first_ + static_cast<std::uint32_t>(near_.size());
    for (const std::uint32_t q : mesh_.quads_of(v)) {
      if (!mesh_.has_doubled(q)) {
        const auto& quad = mesh_.quads[q];
        const std::uint32_t at = quad[0] == v ? 0 : quad[1] == v ? 1 : quad[2] == v ? 2 : 3;
        tell(v, quad[(at + 3) % 4], end);
        tell(v, quad[(at + 1) % 4], end);
        continue;
      }
      const Polygon polygon = mesh_.polygon(q);
      int at = 0;
      while (polygon.vertex[static_cast<std::size_t>(at)] != v) ++at;
      for (const int side : {at + polygon.size - 1, at + 1})
        tell(v, polygon.vertex[static_cast<std::size_t>(side % polygon.size)], end);
    }
  }
  void tell(std::uint32_t v, std::uint32_t w, std::uint32_t end) {
    if (w > v && w < end && near_[w - first_] < 7) ++near_[w - first_];
  }

  const QuadMesh& mesh_;
  std::uint32_t first_;
  std::vector<std::uint8_t> near_;  ///< neighbours that have escaped, at most 7
  std::array<AdaptiveBit, 8> flags_;
  std::array<SignedNumber, 3> numbers_;
};

}  // namespace

std::vector<std::string> encode_floats(std::span<const float> values, std::size_t columns, Progress& progress) {
  return encode_item_chunks(static_cast<std::int64_t>(values.size() / columns), progress,
                            [&](std::uint32_t first, std::uint32_t end) {
                              RangeEncoder out;
                              BitSink sink{out};
                              std::vector<DifferenceCode> codes(columns);
                              std::vector<std::uint32_t> before(columns, 0);
                              for (std::size_t i = first; i < end; ++i)
                                for (std::size_t c = 0; c < columns; ++c) {
                                  const auto bits = std::bit_cast<std::uint32_t>(values[i * columns + c]);
                                  codes[c].code(sink, bits - before[c]);
                                  before[c] = bits;
                                }
                              return out.take();
                            });
}

Result<void> decode_floats(std::span<const std::string_view> chunks, std::size_t columns, std::string_view what,
                           std::span<float> values, Progress& progress) {
  const auto items = static_cast<std::int64_t>(values.size() / columns);
  if (static_cast<std::int64_t>(chunks.size()) != item_chunks(items))
    return fail(ErrorKind::kBadData, "exa: {} chunks of {} found, {} expected", chunks.size(), what,
                item_chunks(items));
  std::atomic<bool> broken{false};
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t chunk) {
    if (progress.cancelled()) return;
    RangeDecoder in(chunks[static_cast<std::size_t>(chunk)]);
    BitSource source{in};
    std::vector<DifferenceCode> codes(columns);
    std::vector<std::uint32_t> before(columns, 0);
    const std::int64_t first = chunk * kItemsPerChunk, end = std::min(first + kItemsPerChunk, items);
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i)
      for (std::size_t c = 0; c < columns; ++c) {
        before[c] += codes[c].code(source, 0);
        const auto value = std::bit_cast<float>(before[c]);
        values[i * columns + c] = value;
        if (!std::isfinite(value)) broken = true;
      }
  });
  if (progress.cancelled()) return cancelled_error();
  if (broken) return fail(ErrorKind::kBadData, "exa: a number of {} is not finite", what);
  return {};
}

glm::vec3 escaped(const glm::vec3& base, const glm::ivec3& k) {
  return glm::vec3(glm::dvec3(base) + kEscapeStep * glm::dvec3(k));
}

std::optional<glm::ivec3> escape_to(const glm::vec3& base, const glm::vec3& wanted) {
  glm::ivec3 k;
  for (int a = 0; a < 3; ++a) {
    const double steps = (double{wanted[a]} - double{base[a]}) / kEscapeStep;
    if (!(std::abs(steps) <= kMostSteps)) return std::nullopt;
    k[a] = static_cast<int>(std::lround(steps));
  }
  return k;
}

std::optional<std::vector<std::string>> encode_escapes(const QuadMesh& mesh, std::span<const glm::vec3> moved,
                                                       Progress& progress) {
  std::atomic<bool> possible{true};
  auto chunks = encode_item_chunks(mesh.vertex_count(), progress, [&](std::uint32_t first, std::uint32_t end) {
    RangeEncoder out;
    BitSink sink{out};
    EscapeCode code(mesh, first, end);
    for (std::uint32_t v = first; v < end; ++v) {
      const bool gone = !same_bits(mesh.positions[v], moved[v]);
      code.flag(sink, v, gone);
      if (!gone) continue;
      const auto k = escape_to(mesh.positions[v], moved[v]);
      if (!k || !same_bits(escaped(mesh.positions[v], *k), moved[v])) {
        possible = false;
        break;
      }
      code.steps(sink, *k);
    }
    return out.take();
  });
  if (!possible) return std::nullopt;
  return chunks;
}

Result<void> decode_escapes(std::span<const std::string_view> chunks, QuadMesh& mesh, Progress& progress) {
  if (static_cast<std::int64_t>(chunks.size()) != item_chunks(mesh.vertex_count()))
    return fail(ErrorKind::kBadData, "exa: {} chunks of escapes found, {} expected", chunks.size(),
                item_chunks(mesh.vertex_count()));
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    RangeDecoder in(chunks[static_cast<std::size_t>(c)]);
    BitSource source{in};
    const auto first = static_cast<std::uint32_t>(c * kItemsPerChunk);
    const auto end = static_cast<std::uint32_t>(std::min((c + 1) * kItemsPerChunk, mesh.vertex_count()));
    EscapeCode code(mesh, first, end);
    for (std::uint32_t v = first; v < end; ++v) {
      if (code.flag(source, v, false)) mesh.positions[v] = escaped(mesh.positions[v], code.steps(source, {}));
    }
  });
  if (progress.cancelled()) return cancelled_error();
  return {};
}

}  // namespace dubsar
