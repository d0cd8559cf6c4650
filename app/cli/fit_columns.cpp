#include "app/cli/fit_columns.h"

#include <algorithm>

namespace dubsar::app {
namespace {

bool begins_letter(char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }

std::size_t letters_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_letter));
}

/// Where what is broken off goes on.
std::size_t hanging_indent(std::string_view line, std::size_t columns) {
  const std::size_t words = std::min(line.find_first_not_of(' '), line.size());
  std::size_t indent = words + 2;
  for (std::size_t at = words; (at = line.find("  ", at)) != std::string_view::npos;) {
    at = std::min(line.find_first_not_of(' ', at), line.size());
    const std::size_t column = letters_of(line.substr(0, at));
    if (column <= columns / 2 && at < line.size()) indent = column;
  }
  return std::min(indent, columns / 2);
}

void add_line(std::string& out, std::string_view line, std::size_t columns) {
  const std::size_t indent = hanging_indent(line, columns);
  for (std::size_t room = columns; letters_of(line) > room; room = columns - indent) {
    const std::size_t words = std::min(line.find_first_not_of(' '), line.size());
    std::size_t at = 0, letters = 0, end = std::string_view::npos;
    for (; at < line.size() && (letters <= room || end == std::string_view::npos); ++at) {
      if (line[at] == ' ' && at > words) end = at;
      letters += begins_letter(line[at]) ? 1 : 0;
    }
    if (end == std::string_view::npos) break;
    out += line.substr(0, line.find_last_not_of(' ', end) + 1);
    out += '\n' + std::string(indent, ' ');
    line.remove_prefix(std::min(line.find_first_not_of(' ', end), line.size()));
  }
  out += line;
}

}  // namespace

std::string fit_columns(std::string_view text, int columns) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    add_line(out, text.substr(at, end - at), static_cast<std::size_t>(std::max(columns, 1)));
    if (end < text.size()) out += '\n';
    at = end + 1;
  }
  return out;
}

}  // namespace dubsar::app
