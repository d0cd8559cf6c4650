#pragma once
// Displays by their text, where a test knows that it is right.

#include <string_view>

#include "display/sinks/catalog/sink_spec.h"

namespace dubsar::testing {

inline SinkSpec spec(std::string_view text) { return parse_sink_spec(text).value(); }

}  // namespace dubsar::testing
