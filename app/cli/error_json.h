#pragma once
// A failure as programs read it, on stdout where --json - was asked for.

#include <nlohmann/json.hpp>
#include <string>

#include "core/base/result.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {

inline nlohmann::json error_object(const Error& error) {
  return {{"message", error.message}, {"exit_code", exit_code(error.kind)}};
}

inline std::string error_json(const Error& error) { return dump_json_lines({{"error", error_object(error)}}) + "\n"; }

}  // namespace dubsar::app
