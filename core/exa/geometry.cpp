#include "core/exa/geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"
#include "core/exa/bitstream.h"
#include "core/exa/packed.h"

namespace dubsar {
namespace {
constexpr std::int64_t kGrain = 1 << 14;
constexpr int kNormalMax = (1 << kNormalBits) - 1;

std::uint32_t zigzag(std::int32_t v) {
  return (static_cast<std::uint32_t>(v) << 1) ^ static_cast<std::uint32_t>(v >> 31);
}
std::int32_t unzigzag(std::uint32_t v) { return static_cast<std::int32_t>(v >> 1) ^ -static_cast<std::int32_t>(v & 1); }

tl::unexpected<Error> unknown_codec(std::uint16_t codec, std::string_view what) {
  return fail(ErrorKind::kBadData, "exa: codec {} of {} is not known; a later dubsar wrote the file", codec, what);
}

template <class T>
Result<Encoded> exact(std::span<const T> items, Progress& progress) {
  DUBSAR_ASSIGN(std::string bytes, pack_items(std::as_bytes(items), sizeof(T), progress));
  return Encoded{kCodecExact, std::move(bytes)};
}

template <class T>
Result<std::vector<T>> unpacked(std::string_view bytes, std::size_t count, Progress& progress) {
  std::vector<T> items(count);
  DUBSAR_TRY(unpack_items(bytes, sizeof(T), std::as_writable_bytes(std::span(items)), progress));
  return items;
}

/// True when every item passes; looks at all of them on all threads.
template <class Test>
bool all_of(std::size_t count, const Test& test) {
  return parallel_reduce<char>(
             static_cast<std::int64_t>(count), kGrain, 1,
             [&](std::int64_t begin, std::int64_t end) {
               for (std::int64_t i = begin; i < end; ++i)
                 if (!test(static_cast<std::size_t>(i))) return char{0};
               return char{1};
             },
             [](char a, char b) { return static_cast<char>(a & b); }) != 0;
}

bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
bool same_bits(const glm::vec3& a, const glm::vec3& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

std::int64_t position_index(float coordinate) { return std::llround(static_cast<double>(coordinate) / kPositionStep); }
float position_at(std::int64_t index) { return static_cast<float>(static_cast<double>(index) * kPositionStep); }

constexpr float kLargestCurvature = 1024.0f;  // per grid step: far beyond any surface, keeps 23 bits
std::int32_t curvature_index(float k) {
  return static_cast<std::int32_t>(std::lround(static_cast<double>(k) / kCurvatureStep));
}
float curvature_at(std::int32_t index) { return static_cast<float>(index * kCurvatureStep); }

/// Octahedral map (Meyer et al. 2010): two coordinates of kNormalBits.
std::array<std::uint16_t, 2> octahedral(const glm::vec3& n) {
  glm::dvec3 p(n);
  const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
  if (!(sum > 0.0) || !std::isfinite(sum)) return {0, 0};
  p /= sum;
  if (p.z < 0.0)
    p = glm::dvec3((1.0 - std::abs(p.y)) * (p.x < 0.0 ? -1.0 : 1.0), (1.0 - std::abs(p.x)) * (p.y < 0.0 ? -1.0 : 1.0),
                   p.z);
  const auto index = [](double v) {
    return static_cast<std::uint16_t>(std::clamp<long>(std::lround((v * 0.5 + 0.5) * kNormalMax), 0, kNormalMax));
  };
  return {index(p.x), index(p.y)};
}

glm::vec3 normal_at(const std::array<std::uint16_t, 2>& index) {
  glm::dvec3 p(index[0] * 2.0 / kNormalMax - 1.0, index[1] * 2.0 / kNormalMax - 1.0, 0.0);
  p.z = 1.0 - std::abs(p.x) - std::abs(p.y);
  if (p.z < 0.0)
    p = glm::dvec3((1.0 - std::abs(p.y)) * (p.x < 0.0 ? -1.0 : 1.0), (1.0 - std::abs(p.x)) * (p.y < 0.0 ? -1.0 : 1.0),
                   p.z);
  return glm::vec3(p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
}

/// The item before, which starts anew with every packed chunk so that chunks stay independent.
std::size_t previous(std::size_t i) { return i % static_cast<std::size_t>(kPackedChunk) == 0 ? i : i - 1; }
}  // namespace

template <class T>
Encoded encode_bits(std::span<const T> values, int bits) {
  BitWriter writer;
  for (const T value : values) writer.put(value, bits);
  return {kCodecBits, writer.take()};
}

template <class T>
Result<std::vector<T>> decode_bits(std::string_view bytes, std::uint64_t count, int bits, std::string_view what) {
  if (bytes.size() != packed_bytes(count, bits))
    return fail(ErrorKind::kBadData, "exa: {} bytes of {} found, the signs need {}", bytes.size(), what,
                packed_bytes(count, bits));
  std::vector<T> values(count);
  BitReader reader(bytes);
  for (T& value : values) value = static_cast<T>(reader.get(bits));
  if (reader.padding() != 0) return fail(ErrorKind::kBadData, "exa: the last byte of {} is damaged", what);
  return values;
}

template Encoded encode_bits(std::span<const std::uint8_t>, int);
template Encoded encode_bits(std::span<const std::uint16_t>, int);
template Result<std::vector<std::uint8_t>> decode_bits(std::string_view, std::uint64_t, int, std::string_view);
template Result<std::vector<std::uint16_t>> decode_bits(std::string_view, std::uint64_t, int, std::string_view);

glm::vec3 quantised_position(const glm::vec3& p) {
  const auto rounded = [](float c) { return std::isfinite(c) ? position_at(position_index(c)) : c; };
  return {rounded(p.x), rounded(p.y), rounded(p.z)};
}

float quantised_curvature(float k) {
  if (std::isnan(k)) return k;
  return curvature_at(curvature_index(std::clamp(k, -kLargestCurvature, kLargestCurvature)));
}

glm::vec3 quantised_normal(const glm::vec3& n) {
  glm::vec3 rounded = normal_at(octahedral(n));
  for (int i = 0; i < 4; ++i) {  // on the seams of the octahedron two codes mean the same direction
    const glm::vec3 again = normal_at(octahedral(rounded));
    if (same_bits(again, rounded)) break;
    rounded = again;
  }
  return rounded;
}

Result<Encoded> encode_positions(std::span<const glm::vec3> positions, std::span<const glm::vec3> base,
                                 Progress& progress) {
  using Difference = std::array<std::uint16_t, 3>;
  std::vector<Difference> differences(positions.size());
  const bool fixed = all_of(positions.size(), [&](std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      const float p = positions[i][axis];
      if (!std::isfinite(p) || std::abs(p) > 1e6f) return false;
      const std::int64_t index = position_index(p), difference = index - position_index(base[i][axis]);
      if (!same_bits(position_at(index), p) || std::abs(difference) > 32767) return false;
      differences[i][static_cast<std::size_t>(axis)] =
          static_cast<std::uint16_t>(zigzag(static_cast<std::int32_t>(difference)));
    }
    return true;
  });
  if (!fixed) return exact(positions, progress);
  DUBSAR_ASSIGN(std::string bytes, pack_items(std::as_bytes(std::span(differences)), sizeof(Difference), progress));
  return Encoded{kCodecFixed, std::move(bytes)};
}

Result<std::vector<glm::vec3>> decode_positions(std::uint16_t codec, std::string_view bytes,
                                                std::span<const glm::vec3> base, Progress& progress) {
  if (codec == kCodecExact) {
    DUBSAR_ASSIGN(std::vector<glm::vec3> positions, unpacked<glm::vec3>(bytes, base.size(), progress));
    if (!all_of(positions.size(), [&](std::size_t i) {
          return std::isfinite(positions[i].x) && std::isfinite(positions[i].y) && std::isfinite(positions[i].z);
        }))
      return fail(ErrorKind::kBadData, "exa: a vertex position is not finite");
    return positions;
  }
  if (codec != kCodecFixed) return unknown_codec(codec, "positions");
  using Difference = std::array<std::uint16_t, 3>;
  DUBSAR_ASSIGN(const std::vector<Difference> differences, unpacked<Difference>(bytes, base.size(), progress));
  std::vector<glm::vec3> positions(base.size());
  parallel_for(static_cast<std::int64_t>(base.size()), kGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    for (int axis = 0; axis < 3; ++axis)
      positions[v][axis] =
          position_at(position_index(base[v][axis]) + unzigzag(differences[v][static_cast<std::size_t>(axis)]));
  });
  return positions;
}

Result<Encoded> encode_normals(std::span<const glm::vec3> normals, Progress& progress) {
  using Pair = std::array<std::uint16_t, 2>;
  std::vector<Pair> pairs(normals.size());
  const bool fixed = all_of(normals.size(), [&](std::size_t i) {
    pairs[i] = octahedral(normals[i]);
    return same_bits(normal_at(pairs[i]), normals[i]);
  });
  if (!fixed) return exact(normals, progress);
  std::vector<Pair> differences(pairs.size());
  parallel_for(static_cast<std::int64_t>(pairs.size()), kGrain, [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index), before = previous(i);
    for (std::size_t c = 0; c < 2; ++c) {
      const int from = before == i ? 0 : pairs[before][c];
      differences[i][c] = static_cast<std::uint16_t>(zigzag(pairs[i][c] - from));
    }
  });
  DUBSAR_ASSIGN(std::string bytes, pack_items(std::as_bytes(std::span(differences)), sizeof(Pair), progress));
  return Encoded{kCodecFixed, std::move(bytes)};
}

Result<std::vector<glm::vec3>> decode_normals(std::uint16_t codec, std::string_view bytes, std::size_t count,
                                              Progress& progress) {
  if (codec == kCodecExact) return unpacked<glm::vec3>(bytes, count, progress);
  if (codec != kCodecFixed) return unknown_codec(codec, "normals");
  using Pair = std::array<std::uint16_t, 2>;
  DUBSAR_ASSIGN(const std::vector<Pair> differences, unpacked<Pair>(bytes, count, progress));
  std::vector<glm::vec3> normals(count);
  parallel_chunks(static_cast<std::int64_t>(count), kPackedChunk, [&](std::int64_t begin, std::int64_t end) {
    Pair now{0, 0};
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      for (std::size_t c = 0; c < 2; ++c)
        now[c] = static_cast<std::uint16_t>(std::clamp(now[c] + unzigzag(differences[i][c]), 0, kNormalMax));
      normals[i] = normal_at(now);
    }
  });
  return normals;
}

Result<Encoded> encode_curvatures(std::span<const float> k, Progress& progress) {
  std::vector<std::int32_t> indices(k.size());
  const bool fixed = all_of(k.size(), [&](std::size_t i) {
    if (!(std::abs(k[i]) <= kLargestCurvature)) return false;
    indices[i] = curvature_index(k[i]);
    return same_bits(curvature_at(indices[i]), k[i]);
  });
  if (!fixed) return exact(k, progress);
  std::vector<std::uint32_t> differences(k.size());
  parallel_for(static_cast<std::int64_t>(k.size()), kGrain, [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index), before = previous(i);
    differences[i] = zigzag(indices[i] - (before == i ? 0 : indices[before]));
  });
  DUBSAR_ASSIGN(std::string bytes, pack_items(std::as_bytes(std::span(differences)), sizeof(std::uint32_t), progress));
  return Encoded{kCodecFixed, std::move(bytes)};
}

Result<std::vector<float>> decode_curvatures(std::uint16_t codec, std::string_view bytes, std::size_t count,
                                             Progress& progress) {
  if (codec == kCodecExact) return unpacked<float>(bytes, count, progress);
  if (codec != kCodecFixed) return unknown_codec(codec, "curvatures");
  DUBSAR_ASSIGN(const std::vector<std::uint32_t> differences, unpacked<std::uint32_t>(bytes, count, progress));
  std::vector<float> k(count);
  parallel_chunks(static_cast<std::int64_t>(count), kPackedChunk, [&](std::int64_t begin, std::int64_t end) {
    std::uint32_t now = 0;  // damaged differences wrap around instead of overflowing
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      now += static_cast<std::uint32_t>(unzigzag(differences[i]));
      k[i] = curvature_at(static_cast<std::int32_t>(now));
    }
  });
  return k;
}

Result<Encoded> encode_labels(std::span<const std::uint8_t> labels, Progress& progress) {
  return exact(labels, progress);
}

Result<std::vector<std::uint8_t>> decode_labels(std::uint16_t codec, std::string_view bytes, std::size_t count,
                                                int highest, std::string_view what, Progress& progress) {
  if (codec != kCodecExact) return unknown_codec(codec, what);
  DUBSAR_ASSIGN(std::vector<std::uint8_t> labels, unpacked<std::uint8_t>(bytes, count, progress));
  for (const std::uint8_t label : labels)
    if (label > highest) return fail(ErrorKind::kBadData, "exa: {} {} found, expected 0..{}", what, label, highest);
  return labels;
}

}  // namespace dubsar
