#pragma once
// How much a side bulges, beside what is written on it.

#include "core/mesh/writing/height_map.h"

namespace dubsar {

/// How far the middle of the side stands above its rim, mm: of the curved sheet (a quadratic one) that touches what
/// nobody wrote on. Impressions and holes are left out. 0 where too little is known. The sheet is that of the inner
/// four fifths each way, where edges are not yet rounded.
double side_rise_mm(const HeightMap& map);

}  // namespace dubsar
