#pragma once
// The header of a PLY file.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/mesh_io/mesh_text.h"

namespace dubsar {

enum class PlyScalar : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };
enum class PlyEncoding { kAscii, kLittle, kBig };

std::size_t ply_scalar_bytes(PlyScalar type) noexcept;
inline bool ply_is_integer(PlyScalar type) noexcept { return type < PlyScalar::kF32; }

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::kF32;
  bool list = false;
  PlyScalar count_type = PlyScalar::kU8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  MeshTextReader text;
  std::size_t body = 0;  ///< offset of the first byte after the header
};

/// kBadData with the offending line; at most 64 elements and 1024 properties.
Result<PlyHeader> parse_ply_header(std::string_view bytes);

}  // namespace dubsar
