#pragma once
// Where a tracker stands before the screen: the words at= and turn= of a source's options.

#include <string_view>

#include "core/base/pose.h"
#include "core/base/result.h"

namespace dubsar {

/// Takes the option if it is one of a placement, and says whether it was: "at" is X/Y/Z in millimetres from
/// the panel's centre, "turn" is X/Y/Z in degrees, turned about z first, then x, then y, all axes of the
/// screen frame. kUsage: not three finite numbers, further than 10 m. `screen_from_device` changes only then.
Result<bool> read_placement(std::string_view key, std::string_view value, Pose& screen_from_device);

/// A hand tracker that lies on the table, 200 mm below the middle of the panel and 150 mm before it.
Pose table_placement();

}  // namespace dubsar
