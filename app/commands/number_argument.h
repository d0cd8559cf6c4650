#pragma once
// Numbers that commands are told.

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar::app {

/// kUsage unless all of the text is a number of `low` to `high`.
Result<double> number_argument(std::string_view command, const std::string& text, double low, double high);

}  // namespace dubsar::app
