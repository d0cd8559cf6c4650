#pragma once
// All commands by typing: words find them, Enter does what is marked.

#include <string>
#include <string_view>
#include <vector>

#include "app/commands/key_table.h"

namespace dubsar::app {

struct PaletteRow {
  std::string text;   ///< "side reverse"
  std::string words;  ///< "turn to a side: reverse"
  std::string key;    ///< the first of its keys; empty: none
  bool ready = true;  ///< false: it has to be told more
  friend bool operator==(const PaletteRow&, const PaletteRow&) = default;
};

/// Commands in whose names, words, headings or arguments all of the typed words begin, in the order of the table, those
/// first whose name begins with what was typed; at most `most`. What can be said as it was typed stands first of all.
std::vector<PaletteRow> palette_rows(const KeyTable& keys, std::string_view typed, std::size_t most);

/// Draws it into the current frame while `open`, and appends what was chosen (and "palette", which closes it).
void draw_palette(bool open, const KeyTable& keys, float width, float height, std::vector<std::string>& commands);

}  // namespace dubsar::app
