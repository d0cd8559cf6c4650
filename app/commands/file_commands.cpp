// Commands for the surfaces that are open, and to open others. They change no document and are not undone: each file
// has a history of its own.

#include <filesystem>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

Command file_command(std::string name, std::vector<DefaultKey> keys, Text argument = {}) {
  return {std::move(name), kFileGroup, std::move(keys), argument};
}

Command open() {
  Command out = file_command("open", {{"ctrl+o"}}, "arg.surface");
  out.optional = true;
  out.run = [](Editor& editor, const std::string& file) -> Result<void> {
    Choosing& choosing = editor.ui().choosing;
    if (file.empty()) {
      choosing = {!choosing.open, false, choosing.folder};
      return {};
    }
    DUBSAR_TRY(editor.place().open_file(file));
    choosing.open = false;
    return {};
  };
  return out;
}

Command open_folder() {
  Command out = file_command("open_folder", {}, "arg.folder");
  out.values = {".."};
  out.run = [](Editor& editor, const std::string& folder) -> Result<void> {
    Choosing& choosing = editor.ui().choosing;
    const fs::path from(choosing.folder.empty() ? editor.place().present_folder() : choosing.folder);
    std::error_code error;
    const fs::path next = fs::weakly_canonical(from / folder, error);
    if (error || !fs::is_directory(next, error))
      return fail(ErrorKind::kNoInput, "open_folder: {} is no folder", (from / folder).string());
    choosing.folder = next.string();
    choosing.open = true;
    return {};
  };
  return out;
}

Command open_recent() {
  Command out = file_command("open_recent", {}, "arg.recent");
  out.values = {"1", "2", "3"};
  out.run = [](Editor& editor, const std::string& number) -> Result<void> {
    DUBSAR_ASSIGN(const double which, number_argument("open_recent", number, 1.0, 10.0));
    DUBSAR_TRY(editor.place().open_recent(static_cast<std::size_t>(which)));
    editor.ui().choosing.open = false;
    return {};
  };
  return out;
}

Command step(std::string name, int by, std::vector<DefaultKey> keys) {
  Command out = file_command(std::move(name), std::move(keys));
  out.run = [by](Editor& editor, const std::string&) { return editor.place().switch_file(by); };
  return out;
}

Command stop_opening() {
  Command out = file_command("stop_opening", {});
  out.run = [](Editor& editor, const std::string&) -> Result<void> {
    if (!editor.place().stop_opening()) editor.place().say(tr("say.no_file_is_read"));
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> file_commands() {
  std::vector<Command> out;
  out.push_back(open());
  out.push_back(open_folder());
  out.push_back(open_recent());
  out.push_back(step("next_file", 1, {{"ctrl+page_down"}}));
  out.push_back(step("previous_file", -1, {{"ctrl+page_up"}}));
  out.push_back(stop_opening());
  return out;
}

}  // namespace dubsar::app
