// The command for the inner side of surfaces.

#include <algorithm>
#include <array>

#include "app/commands/command_table.h"

namespace dubsar::app {
namespace {

constexpr std::array<std::string_view, 3> kBackFaces{"show", "tint", "hide"};

Command back_faces() {
  Command out{"back_faces", "group.parts", {{"shift+q"}}};
  out.argument = "arg.back_faces";
  for (const std::string_view name : kBackFaces) out.values.emplace_back(name);
  out.closed = out.optional = true;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    Document next = editor.document();
    const auto* const at = std::find(kBackFaces.begin(), kBackFaces.end(), next.style.back_faces);
    const std::size_t now = at == kBackFaces.end() ? 0 : static_cast<std::size_t>(at - kBackFaces.begin());
    next.style.back_faces = text.empty() ? std::string(kBackFaces[(now + 1) % kBackFaces.size()]) : text;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> back_face_commands() { return {back_faces()}; }

}  // namespace dubsar::app
