#pragma once
// What is said of a wedge: its points, sizes, and how far to trust it.

#include "core/script/explain_relief.h"
#include "core/script/wedge.h"

namespace dubsar {

/// Side, line and order are not known yet; the kind is that of an imprint without a line of text.
ScriptWedge measured_wedge(const PlacedImprint& placed, const WedgeScale& scale);

/// Of being a wedge at this place with this direction, 0..1.
double wedge_confidence(const PlacedImprint& placed, const WedgeScale& scale);

}  // namespace dubsar
