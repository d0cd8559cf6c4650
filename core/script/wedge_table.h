#pragma once
// Wedges as a table for other programs.

#include <span>
#include <string>

#include "core/script/find_wedges.h"
#include "core/script/marks/script_marks.h"

namespace dubsar {

/// The first row of the table.
inline constexpr const char* kWedgeColumns =
    "id,side,column,line,order,kind,head_x,head_y,head_z,tip_x,tip_y,tip_z,tail_x,tail_y,tail_z,nx,ny,nz,depth_mm,"
    "length_mm,width_mm,opening_deg,pressed_after,confidence,evidence,by";

/// One row a wedge in the order of reading, lines end with LF, numbers with a point whatever the locale; mm in the
/// frame of the scan. The last column, empty in all rows, has the seal of the text as its name (sealed_text.h), so that
/// a table that somebody corrected is told from ours. `by` says whose each wedge is (kWedgeBys).
std::string wedges_csv(std::span<const ScriptWedge> wedges);
/// The same fields as objects under "wedges", with what is usual and how the tablet lies; rulings, cracks and
/// seals (outlines) as places on the surface. `made_by`: program, version.
std::string wedges_json(const WedgesFound& found, const std::string& made_by, const ScriptMarks& marks = {});

}  // namespace dubsar
