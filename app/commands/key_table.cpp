#include "app/commands/key_table.h"

#include "app/words/text.h"

namespace dubsar::app {

std::string key_chord(const InputEvent& event) {
  const std::string& key = event.key;
  const bool hides_shift = key.size() != 1 || (key[0] >= 'a' && key[0] <= 'z');
  const bool chord = (event.modifiers & (kControl | kAlt)) != 0;
  std::string out;
  if (event.modifiers & kControl) out += "ctrl+";
  if (event.modifiers & kAlt) out += "alt+";
  if ((event.modifiers & kShift) != 0 && (hides_shift || chord)) out += "shift+";
  return out + key;
}

std::string key_words(std::string_view chord) {
  std::string out;
  for (bool first = true; !chord.empty(); first = false) {
    const std::size_t plus = chord.size() > 1 ? chord.find('+', 1) : std::string_view::npos;
    std::string word(chord.substr(0, plus));
    chord.remove_prefix(plus == std::string_view::npos ? chord.size() : plus + 1);
    const Text known = Text::find("key." + word);
    bool begins = known.empty();
    if (!begins) word = tr(known);
    for (char& c : word) {
      if (c == '_') c = ' ';
      if (begins && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
      begins = known.empty() && c == ' ';
    }
    out += (first ? "" : "+") + word;
  }
  return out;
}

Result<KeyTable> KeyTable::create(const CommandTable& commands, const std::map<std::string, std::string>& changes) {
  KeyTable out(commands);
  for (const auto& [key, text] : changes) {
    if (text == "none") continue;
    if (const auto fits = commands.check(text); !fits)
      return fail(ErrorKind::kConfig, "mapping: keys: {} is \"{}\": {}", key, text, fits.error().message);
    out.rows_.push_back({key, text});
  }
  for (const Command& command : commands.all())
    for (const DefaultKey& row : command.keys)
      if (!changes.contains(row.key))
        out.rows_.push_back({row.key, row.argument.empty() ? command.name : command.name + " " + row.argument});
  return out;
}

std::string KeyTable::command_for(std::string_view key, const Editor& editor) const {
  for (const Row& row : rows_) {
    if (row.key != key) continue;
    const Command* const command = commands_->find(split_command(row.text).first);
    if (!command->enabled || command->enabled(editor)) return row.text;
  }
  return {};
}

std::vector<std::string> KeyTable::keys_for(std::string_view text) const {
  std::vector<std::string> out;
  for (const Row& row : rows_)
    if (row.text == text) out.push_back(row.key);
  return out;
}

}  // namespace dubsar::app
