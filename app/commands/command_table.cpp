#include "app/commands/command_table.h"

#include <algorithm>
#include <array>

#include "core/base/text/near_word.h"

namespace dubsar::app {
namespace {

std::string listed(std::span<const std::string> words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

}  // namespace

std::pair<std::string_view, std::string> split_command(std::string_view text) {
  const std::size_t space = std::min(text.find(' '), text.size());
  std::string argument(text.substr(space));
  argument.erase(0, argument.find_first_not_of(' '));
  return {text.substr(0, space), std::move(argument)};
}

CommandTable CommandTable::standard(const std::vector<std::string>& styles) {
  CommandTable out;
  for (std::vector<Command>& part :
       std::array{window_commands(), view_commands(), look_commands(styles), shade_commands(styles), light_commands(),
                  back_face_commands(), mark_commands(), text_commands(), section_commands(), slice_commands(),
                  wedge_commands(), export_commands(), film_commands(), file_commands(), companion_commands(),
                  work_commands()})
    for (Command& command : part) out.add(std::move(command));
  return out;
}

void CommandTable::add(Command command) {
  DUBSAR_CHECK(find(command.name) == nullptr && !command.name.empty() && command.run);
  if (command.words.empty()) command.words = Text::find("command." + command.name);
  DUBSAR_CHECK(!command.words.empty());
  commands_.push_back(std::move(command));
}

std::string argument_words(const Command& command, const std::string& argument) {
  const std::string family(command.argument.id().substr(std::min<std::size_t>(4, command.argument.id().size())));
  return tr_name(family, argument);
}

const Command* CommandTable::find(std::string_view name) const {
  const auto found = std::find_if(commands_.begin(), commands_.end(), [&](const Command& c) { return c.name == name; });
  return found == commands_.end() ? nullptr : &*found;
}

Result<void> CommandTable::check(std::string_view text) const {
  const auto [name, argument] = split_command(text);
  const Command* const command = find(name);
  if (command == nullptr) {
    std::vector<std::string> names;
    for (const Command& known : commands_) names.push_back(known.name);
    return fail(ErrorKind::kUsage, "\"{}\" is no command, expected one of: {}{}", name, listed(names),
                did_you_mean(name, names));
  }
  if (argument.empty() && !command->argument.empty() && !command->optional)
    return fail(ErrorKind::kUsage, "{}: nothing found after it, expected {}", name, command->argument.english());
  if (!argument.empty() && command->argument.empty())
    return fail(ErrorKind::kUsage, "{}: \"{}\" found after it, expected nothing", name, argument);
  if (!argument.empty() && command->closed &&
      std::find(command->values.begin(), command->values.end(), argument) == command->values.end())
    return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected one of: {}", name, argument, listed(command->values));
  return {};
}

Result<void> CommandTable::run(std::string_view text, Editor& editor) const {
  DUBSAR_TRY(check(text));
  const auto [name, argument] = split_command(text);
  const Command& command = *find(name);
  if (command.enabled && !command.enabled(editor))
    return fail(ErrorKind::kUsage, "{}: there is nothing to do it to now", name);
  if (name != "close") editor.ui().leaving = false;
  return command.run(editor, argument);
}

}  // namespace dubsar::app
