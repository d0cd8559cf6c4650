#pragma once
// Blocks of the surface's geometry: face decisions, edge offsets, smoothed positions, normals, curvatures. Each encoder
// names the codec it took, so that better ones can be added without touching the container.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace dubsar {

inline constexpr std::uint16_t kCodecBits = 1;   ///< numbers of N bits without gaps
inline constexpr std::uint16_t kCodecExact = 2;  ///< the items themselves through the general entropy stage
inline constexpr std::uint16_t kCodecFixed = 3;  ///< fixed-point differences through the general entropy stage

inline constexpr double kPositionStep = 1.0 / 1024.0;   ///< grid steps; half of it is the largest error per axis
inline constexpr double kCurvatureStep = 1.0 / 4096.0;  ///< per grid step; the flat class ends at 2^-6
inline constexpr int kNormalBits = 12;                  ///< per octahedral coordinate: less than .06 degrees

struct Encoded {
  std::uint16_t codec = 0;
  std::string bytes;
};

/// Values of at most `bits` bits.
template <class T>
Encoded encode_bits(std::span<const T> values, int bits);
/// kBadData unless `bytes` hold exactly `count` values.
template <class T>
Result<std::vector<T>> decode_bits(std::string_view bytes, std::uint64_t count, int bits, std::string_view what);

/// What the fixed-point codecs store: rounding a value twice gives the same value as rounding it once.
glm::vec3 quantised_position(const glm::vec3& p);
float quantised_curvature(float k);
glm::vec3 quantised_normal(const glm::vec3& n);

/// Positions as differences from `base` (the unsmoothed mesh): kCodecFixed when all are quantised, else kCodecExact.
/// Lossless in both cases.
Result<Encoded> encode_positions(std::span<const glm::vec3> positions, std::span<const glm::vec3> base,
                                 Progress& progress);
Result<std::vector<glm::vec3>> decode_positions(std::uint16_t codec, std::string_view bytes,
                                                std::span<const glm::vec3> base, Progress& progress);

/// Unit normals as octahedral coordinates, differences along the vertex order; kCodecExact when not quantised.
Result<Encoded> encode_normals(std::span<const glm::vec3> normals, Progress& progress);
Result<std::vector<glm::vec3>> decode_normals(std::uint16_t codec, std::string_view bytes, std::size_t count,
                                              Progress& progress);

/// One curvature array, differences along the vertex order; kCodecExact when not quantised.
Result<Encoded> encode_curvatures(std::span<const float> k, Progress& progress);
Result<std::vector<float>> decode_curvatures(std::uint16_t codec, std::string_view bytes, std::size_t count,
                                             Progress& progress);

/// Small numbers up to `highest`, one byte each through the general entropy stage.
Result<Encoded> encode_labels(std::span<const std::uint8_t> labels, Progress& progress);
/// kBadData when a label is larger than `highest`.
Result<std::vector<std::uint8_t>> decode_labels(std::uint16_t codec, std::string_view bytes, std::size_t count,
                                                int highest, std::string_view what, Progress& progress);

}  // namespace dubsar
