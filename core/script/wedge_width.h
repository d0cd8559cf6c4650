#pragma once
// How wide and deep the wedges of a surface usually are.

#include "core/script/surface_levels.h"
#include "core/script/wedge_sites.h"

namespace dubsar {

/// Four sizes an octave apart are tried on some of the surface, from a hundredth of its size on, and on a coarse mesh
/// the least that it shows; that which explains most is made better by the widths of what was found. `width_mm` above 0
/// is the width, and the depth alone is found. 0 and 0 where nothing looks like a wedge. Cost: some s, whatever the
/// size.
WedgeScale wedge_scale(SurfaceLevels& surface, double width_mm);

}  // namespace dubsar
