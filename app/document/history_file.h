#pragma once
// The steps of a document as text, so that undo outlives the session.

#include <string>
#include <string_view>

#include "app/document/history.h"
#include "core/base/result.h"

namespace dubsar::app {

inline constexpr std::string_view kHistoryFormat = "dubsar history";
/// Steps in each direction that are kept, the nearest, and the documents behind them as text together: reading them
/// takes less than a tenth of a second.
inline constexpr std::size_t kMostKeptSteps = 200, kMostKeptBytes = std::size_t{8} << 20;

/// The document, and what each step changes of it as JSON Patch (RFC 6902), from the present outwards.
std::string format_history(const History& history);
/// kBadData for what is no such text, or of a newer version. Steps do not merge with what comes next.
Result<History> parse_history(std::string_view text, std::string_view source);

}  // namespace dubsar::app
