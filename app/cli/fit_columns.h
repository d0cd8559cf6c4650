#pragma once
// Text for a terminal: what is too long for it goes on in another line, below its own words.

#include <string>
#include <string_view>

namespace dubsar::app {

/// Breaks lines of more than `columns` letters (1 or more) between words. What follows begins below the last column of
/// a table that was begun, which two spaces or more set apart, but left of the middle; else two letters farther in than
/// the line. Words that are longer than the room stay whole, rows of tables that fit stay as they are.
std::string fit_columns(std::string_view text, int columns);

}  // namespace dubsar::app
