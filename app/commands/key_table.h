#pragma once
// Which key runs which command: the commands' own keys, and what a mapping file changes about them.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/command_table.h"
#include "input/input_event.h"

namespace dubsar::app {

/// The name of a key with what is held beside it: "ctrl+z", "shift+left", "alt+1", "?". Shift is named where it does
/// not show in what the key types.
std::string key_chord(const InputEvent& event);

/// A chord as people say it: "Ctrl+Page Up", "Shift+N", "F1" for "ctrl+page_up", "shift+n", "f1".
std::string key_words(std::string_view chord);

class KeyTable {
 public:
  /// `changes` by key: a command's text, or "none". kConfig, with the key, when a text cannot be said.
  static Result<KeyTable> create(const CommandTable& commands, const std::map<std::string, std::string>& changes = {});

  /// What the key does now: the first of its commands that is enabled; empty: nothing.
  std::string command_for(std::string_view key, const Editor& editor) const;
  /// Keys that say exactly this ("side reverse"), in the order of the table.
  std::vector<std::string> keys_for(std::string_view text) const;
  const CommandTable& commands() const noexcept { return *commands_; }

 private:
  struct Row {
    std::string key, text;
  };
  explicit KeyTable(const CommandTable& commands) : commands_(&commands) {}
  const CommandTable* commands_;  // outlives this
  std::vector<Row> rows_;
};

}  // namespace dubsar::app
