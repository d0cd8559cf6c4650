#pragma once
// Wedges drawn twice: the groove of a tail taken for a shallow wedge of its own.

#include <vector>

#include "core/script/wedge.h"

namespace dubsar {

/// Takes out each wedge that points as a deeper one does (within 15 degrees), begins on that one's axis (within a third
/// of its width) between its head and its tail's end, and is at most two thirds as deep. Keeps the order. Cost: pairs.
void drop_echoes(std::vector<ScriptWedge>& wedges);

}  // namespace dubsar
