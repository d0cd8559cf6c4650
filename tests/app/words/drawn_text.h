#pragma once
// What Dear ImGui drew, read back from its triangles: which letters, where, and what of them lies outside of where may
// be drawn. So no text gets past, however it was drawn.

#include <imgui.h>

#include <map>
#include <string>
#include <vector>

namespace dubsar::app {

struct DrawnLetter {
  unsigned code = 0;
  ImVec2 from, to;      ///< pixels of the layout
  bool inside = false;  ///< of what the list may draw on, from left to right
  int list = 0;         ///< windows are lists
};

inline std::vector<DrawnLetter> drawn_letters() {
  std::map<std::pair<float, float>, unsigned> codes;  // by the upper left corner in the picture of letters
  for (const ImFont* const font : ImGui::GetIO().Fonts->Fonts)
    for (const ImFontGlyph& glyph : font->Glyphs)
      if (glyph.Visible) codes[{glyph.U0, glyph.V0}] = glyph.Codepoint;
  std::vector<DrawnLetter> out;
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    for (const ImDrawCmd& command : list.CmdBuffer)
      for (unsigned k = 0; k + 5 < command.ElemCount; ++k) {
        const auto vertex = [&](unsigned i) -> const ImDrawVert& {
          return list.VtxBuffer[static_cast<int>(list.IdxBuffer[static_cast<int>(command.IdxOffset + k + i)] +
                                                 command.VtxOffset)];
        };
        const ImDrawVert &a = vertex(0), &b = vertex(2);
        const auto found = codes.find({a.uv.x, a.uv.y});
        if (found == codes.end() || b.uv.x <= a.uv.x || b.uv.y <= a.uv.y) continue;
        const ImVec4& clip = command.ClipRect;
        if (ImColor(a.col).Value.y < 0.15f) {  // a shadow, under a letter of the same place
          k += 5;
          continue;
        }
        out.push_back({found->second, a.pos, b.pos, a.pos.x >= clip.x - 1.0f && b.pos.x <= clip.z + 1.0f, l});
        k += 5;
      }
  }
  return out;
}

inline void add_utf8(std::string& out, unsigned code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0 | code >> 6);
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    out += static_cast<char>(0xe0 | code >> 12);
    out += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  }
}

/// Those that overlap: two letters of which one hides more than a third of the other one's width and height.
inline std::vector<std::string> overlapping(const std::vector<DrawnLetter>& letters) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < letters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const DrawnLetter &a = letters[i], &b = letters[j];
      const float w = std::min(a.to.x, b.to.x) - std::max(a.from.x, b.from.x),
                  h = std::min(a.to.y, b.to.y) - std::max(a.from.y, b.from.y);
      if (w < 0.34f * std::min(a.to.x - a.from.x, b.to.x - b.from.x) || w < 1.5f ||
          h < 0.34f * std::min(a.to.y - a.from.y, b.to.y - b.from.y) || h < 1.5f)
        continue;
      std::string text;
      for (std::size_t k = j < 6 ? 0 : j - 6; k < std::min(letters.size(), j + 6); ++k) add_utf8(text, letters[k].code);
      text += " / ";
      for (std::size_t k = i < 6 ? 0 : i - 6; k < std::min(letters.size(), i + 6); ++k) add_utf8(text, letters[k].code);
      out.push_back(std::move(text));
      j = i;
    }
  return out;
}

}  // namespace dubsar::app
