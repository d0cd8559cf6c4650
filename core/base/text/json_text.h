#pragma once
// JSON from files that are not trusted: size and depth are limited before the parser sees a byte.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

inline constexpr std::size_t kJsonMaxBytes = std::size_t{8} << 20;
inline constexpr int kJsonMaxDepth = 32;

/// Parses one JSON text (UTF-8, no comments). `what` names it in the error text. kBadData: too long, too deep, broken:
/// "WHAT, line 6, column 3: a comma is missing before "objects"" (json_fault.h).
Result<nlohmann::json> parse_json(std::string_view text, std::string_view what, std::size_t max_bytes = kJsonMaxBytes);

/// The version that a file of ours says it has: {"format": FORMAT, "version": N, ...}. kBadData: another format, or a
/// version outside of oldest..newest. `what` names it.
Result<int> json_version(const nlohmann::json& object, std::string_view format, int oldest, int newest,
                         std::string_view what);

/// One line of plain ASCII; characters that are not UTF-8 are replaced.
std::string dump_json(const nlohmann::json& json);

/// The same over several lines, in UTF-8: for files and streams that people read too. Every JSON that holds names from
/// files or of files goes through one of these: nlohmann's own dump() throws on what is not UTF-8.
std::string dump_json_lines(const nlohmann::json& json);

/// The same, each list of numbers in one line: a place is a line, and a path of places a line for each.
std::string dump_json_rows(const nlohmann::json& json);

}  // namespace dubsar
