#pragma once
// How a place of a surface is known (docs/evidence.md).

#include <cstddef>
#include <cstdint>

#include "core/base/text/enum_names.h"

namespace dubsar {

enum class Evidence : std::uint8_t {
  kMeasured,  ///< a surface between clay and air that the scan resolves
  kPocket,    ///< the wall of a closed pocket of air between tablet and envelope
  kFilm,      ///< contact, where the density dips: a film of air thinner than a voxel
  kInferred,  ///< contact of which the scan shows nothing: the surface around it, continued
};

inline constexpr EnumName<Evidence> kEvidences[] = {{Evidence::kMeasured, "measured"},
                                                    {Evidence::kPocket, "pocket"},
                                                    {Evidence::kFilm, "film"},
                                                    {Evidence::kInferred, "inferred"}};
inline constexpr std::size_t kEvidenceCount = static_cast<std::size_t>(Evidence::kInferred) + 1;
static_assert(names_all(kEvidences, kEvidenceCount));

/// As it stands in the arrays of meshes and files.
constexpr std::uint8_t evidence_byte(Evidence evidence) noexcept { return static_cast<std::uint8_t>(evidence); }

}  // namespace dubsar
