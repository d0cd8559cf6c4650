#pragma once
// Bit-plane work on one row of grid points: sign packing, counting and filling of active edges and ambiguous faces.
// One word of 64 points at a time, the values of inactive points are read once (packing) and never again.

#include <algorithm>
#include <array>
#include <cstdint>

namespace dubsar {

/// Rows that make a piece of work worth a thread, whatever the thread count.
constexpr std::int64_t rows_per_chunk(std::int64_t nx) noexcept { return std::max<std::int64_t>(16, (1 << 17) / nx); }

/// Sign rows of the points (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1); null where the grid ends.
struct SignRows {
  const std::uint64_t* here = nullptr;
  const std::uint64_t* next_y = nullptr;
  const std::uint64_t* next_z = nullptr;
  const std::uint64_t* next_yz = nullptr;
};

/// The values of the same rows.
struct ValueRows {
  const float* here = nullptr;
  const float* next_y = nullptr;
  const float* next_z = nullptr;
  const float* next_yz = nullptr;
};

/// Active edges and ambiguous faces, per axis, that start in one row.
struct RowItems {
  std::array<std::uint32_t, 3> edges{};
  std::array<std::uint32_t, 3> faces{};
};

/// words[x / 64] bit x % 64 = values[x] >= isovalue (NaN: 0); padding bits 0. Writes (nx + 63) / 64 words.
void pack_signs(const float* values, std::int64_t nx, float isovalue, std::uint64_t* words);

/// Among the points below x of a row: inside points; points where two rows differ; points that differ from their next.
std::uint32_t count_ones(const std::uint64_t* row, std::int64_t x) noexcept;
std::uint32_t count_differences(const std::uint64_t* a, const std::uint64_t* b, std::int64_t x) noexcept;
std::uint32_t count_changes(const std::uint64_t* row, std::int64_t x) noexcept;

RowItems count_row(const SignRows& rows, std::int64_t nx);

/// The values at both ends of an active edge.
struct EdgeEnds {
  float from, to;
};

/// Writes the ends of the active edges and the face decisions of one row in canonical order (surface_samples.h).
/// `items` is count_row() of the same rows.
void fill_row(const SignRows& rows, const ValueRows& values, std::int64_t nx, float isovalue, const RowItems& items,
              EdgeEnds* ends, std::uint8_t* joined);

/// offsets[i] = quantise_crossing(ends[i].from, ends[i].to, isovalue, bits).
void quantise_crossings(const EdgeEnds* ends, std::size_t count, float isovalue, int bits, std::uint16_t* offsets);

/// Place of the crossing between two values of different sign: min(2^bits - 1, floor(t 2^bits)), t = v0 / (v0 - v1)
/// with v = value - isovalue; t = 0.5 where that is not finite.
std::uint16_t quantise_crossing(float value0, float value1, float isovalue, int bits) noexcept;

/// Asymptotic decider of an ambiguous face with values a, d at one diagonal, b, c at the other: true when the inside
/// corners are joined, that is when the saddle value lies above the isovalue. Symmetric in the order of the corners,
/// so that both cells of the face agree; ties and NaN: not joined.
bool joins_inside(float a, float b, float c, float d, float isovalue) noexcept;

}  // namespace dubsar
