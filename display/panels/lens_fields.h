#pragma once
// The figures of a lens sheet in JSON, under the names that profiles and calibrations have for them.

#include "core/base/numbers/inch.h"
#include "core/base/text/json_fields.h"
#include "display/optics/lens.h"

namespace dubsar {

constexpr int kMostPanelPx = 16384;  ///< a side

/// Fills pitch, slope, center, fringe, inversion and cell pattern; what is wrong becomes a complaint of `fields`.
void read_lens_figures(JsonFields& fields, LookingGlassFigures& sheet, const char* invert_name,
                       const char* pattern_name);

/// Subpixel cells, at most 10: {"R": [x, y], "G": ..., "B": ...} or the maker's {"ROffsetX": x, ...}, pixels, -2 to 2.
void read_lens_cells(const nlohmann::json& cells, JsonFields& fields, LookingGlassFigures& sheet);

}  // namespace dubsar
