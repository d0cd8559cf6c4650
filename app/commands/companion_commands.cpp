// Commands for another surface beside this one, and the difference between the two.

#include <filesystem>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/document/file_kinds.h"
#include "core/base/files/file_fingerprint.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr double kUsualDifferenceMm = 0.25;  // as of dubsar compare
constexpr double kLeastDifferenceMm = 0.001;

bool has_companion(const Editor& editor) { return !editor.document().companion.path.empty(); }

void put(Editor& editor, Companion companion, std::string_view why) {
  Document next = editor.document();
  next.companion = std::move(companion);
  editor.change(std::move(next), why);
}

/// Without a name: away with what is there, or the next of the open files, or the dialogue.
Command set_beside() {
  Command out{"set_beside", "group.tablet", {{"shift+y"}}, "arg.surface"};
  out.optional = true;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    Choosing& choosing = editor.ui().choosing;
    std::string file = text;
    if (file.empty()) {
      if (has_companion(editor)) {
        put(editor, {}, why);
        return {};
      }
      file = editor.place().next_file();
      if (file.empty()) {
        choosing.beside = choosing.open = !choosing.open;
        return {};
      }
    }
    DUBSAR_TRY(check_surface_file(file));
    std::error_code error;
    Companion companion{fs::absolute(file, error).lexically_normal().string(), {}};
    DUBSAR_ASSIGN(companion.content, file_checksum(file));
    put(editor, std::move(companion), why);
    choosing.open = false;
    return {};
  };
  return out;
}

Command take_away() {
  Command out{"take_away", "group.tablet", {}};
  out.enabled = has_companion;
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    put(editor, {}, why);
    return {};
  };
  return out;
}

Command difference() {
  Command out{"difference", "group.tablet", {{"shift+d"}}, "arg.difference"};
  out.values = {"0.1", "0.25", "1", "none"};
  out.optional = true;
  out.enabled = has_companion;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    Companion companion = editor.document().companion;
    double mm = companion.difference_mm > 0 || text == "none" ? 0.0 : kUsualDifferenceMm;
    if (!text.empty() && text != "none") {
      DUBSAR_ASSIGN(mm, number_argument("difference", text, kLeastDifferenceMm, kMostDifferenceMm));
    }
    companion.difference_mm = mm;
    put(editor, std::move(companion), why);
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> companion_commands() {
  std::vector<Command> out;
  out.push_back(set_beside());
  out.push_back(take_away());
  out.push_back(difference());
  return out;
}

}  // namespace dubsar::app
