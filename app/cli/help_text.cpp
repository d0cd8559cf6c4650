#include "app/cli/help_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

#include "app/document/file_kinds.h"
#include "core/base/text/near_word.h"

namespace dubsar::app {
namespace {

constexpr int kFewestColumns = 40, kMostColumns = 110, kUsualColumns = 80;
constexpr int kNameColumns = 28;  // names of options; below 70 columns what they do stands below them

const auto kAny = [](const CLI::App* const) { return true; };

/// Words from column `first` on, in lines that begin at `indent`.
std::string wrapped(std::string_view text, int first, int indent, int columns) {
  std::string out;
  int column = first;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const auto length = static_cast<int>(end);
    if (column > indent && column + (column > first ? 1 : 0) + length > columns) {
      out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
      column = indent;
    } else if (column > first) {
      out += ' ';
      ++column;
    }
    out += text.substr(0, end);
    column += length;
    if (column == first) ++column;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out + "\n";
}

/// A name and what it does, beside it or below it.
std::string entry(const std::string& name, const std::string& what, int columns, int indent) {
  std::string out = "  " + name;
  if (static_cast<int>(out.size()) + 2 > indent)
    out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
  else
    out.append(static_cast<std::size_t>(indent) - out.size(), ' ');
  return out + wrapped(what, indent, indent, columns);
}

int option_indent(int columns) { return columns < 70 ? 6 : kNameColumns; }

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr || app.get_parent()->get_name().empty()
             ? app.get_name()
             : full_name(*app.get_parent()) + " " + app.get_name();
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::string value_word(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type == "INT" || type == "UINT" || type == "FLOAT" ? "N" : type.empty() ? "TEXT" : type;
}

std::string option_name(const CLI::Option& option) {
  std::string name;
  for (const std::string& letter : option.get_snames()) name += (name.empty() ? "-" : ", -") + letter;
  for (const std::string& word : option.get_lnames()) name += (name.empty() ? "--" : ", --") + word;
  return takes_value(option) ? name + " " + value_word(option) : name;
}

std::string options_text(const CLI::App& app, const std::string& title, int columns) {
  std::string out;
  for (const CLI::Option* const option : app.get_options()) {
    const bool help = option->check_lname("help");
    if (option->get_positional() || (help && app.get_name().empty())) continue;  // each group has a --help of its own
    const std::string what = help ? "this page" : option->get_description();
    out += entry(option_name(*option), what + (option->get_required() ? " (needed)" : ""), columns,
                 option_indent(columns));
  }
  return out.empty() ? "" : "\n" + title + "\n" + out;
}

/// Verbs in lines, examples as they are.
std::string footer_text(const std::string& footer, int columns) {
  std::string out = "\n";
  std::string_view text = footer;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const bool example = line.starts_with(" ");
    out += example ? std::string(line) + "\n" : wrapped(line, 0, 0, columns);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// Names of verbs or commands, those of options when `option`.
std::vector<std::string> names_in(const CLI::App& app, bool option) {
  std::vector<std::string> names;
  if (!option)
    for (const CLI::App* const part : app.get_subcommands(kAny))
      if (!part->get_name().empty()) names.push_back(part->get_name());
  const auto add = [&](const CLI::App& from) {
    for (const CLI::Option* const known : from.get_options())
      for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
  };
  if (!option) return names;
  for (const CLI::App* at = &app; at != nullptr; at = at->get_parent()) {
    add(*at);
    for (const CLI::App* const part : at->get_subcommands(kAny))
      if (part->get_name().empty()) add(*part);  // a group of options
    if (at->get_fallthrough() == false) break;
  }
  return names;
}

/// What can be done with a file that was named instead of a verb.
std::string verb_for_file(const std::string& word) {
  std::error_code ignored;
  if (!std::filesystem::exists(word, ignored)) return {};
  if (names_a_surface(word)) return "; to see this surface: dubsar view " + word;
  if (names_a_scan(word) || names_a_slice(word)) return "; to make surfaces of this scan: dubsar process " + word;
  return "; to see what is in this file: dubsar info " + word;
}

/// The first option or argument that is needed and not there.
const CLI::Option* missing_option(const CLI::App& app) {
  for (const CLI::Option* const option : app.get_options())
    if (option->get_required() && option->count() == 0) return option;
  for (const CLI::App* const part : app.get_subcommands(kAny))
    if (part->get_name().empty())
      if (const CLI::Option* const found = missing_option(*part)) return found;
  return nullptr;
}

std::string first_example(const CLI::App& app) {
  const std::string footer = app.get_footer(), wanted = "dubsar " + full_name(app).substr(sizeof "dubsar");
  const std::size_t at = footer.find(wanted);
  return at == std::string::npos ? "" : footer.substr(at, footer.find('\n', at) - at);
}

std::string unknown_text(const CLI::App& app, const std::string& word) {
  const std::string where = full_name(app), name = word.substr(0, word.find('='));
  if (word.starts_with("-"))
    return fmt::format("{} has no option {}{}", where, name, did_you_mean(name, names_in(app, true)));
  const auto commands = names_in(app, false);
  if (commands.empty()) return fmt::format("\"{}\" is more than {} expects", word, where);
  const bool program = app.get_parent() == nullptr;
  return fmt::format("{} has no {} \"{}\", expected one of: {}{}{}", where, program ? "verb" : "command", word,
                     fmt::join(commands, ", "), did_you_mean(word, commands), program ? verb_for_file(word) : "");
}

}  // namespace

int help_columns() {
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    winsize size{};
    if (::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
      return std::clamp<int>(size.ws_col, kFewestColumns, kMostColumns);
  }
  const char* const told = std::getenv("COLUMNS");
  const int columns = told != nullptr ? std::atoi(told) : 0;
  return columns > 0 ? std::clamp(columns, kFewestColumns, kMostColumns) : kUsualColumns;
}

const CLI::App& chosen_app(const CLI::App& root) {
  for (const CLI::App* const part : root.get_subcommands(kAny))
    if (!part->get_name().empty() && part->parsed()) return chosen_app(*part);
  return root;
}

std::string help_text(const CLI::App& app, int columns) {
  const std::string name = full_name(app);
  const bool program = app.get_parent() == nullptr;
  std::string out = wrapped(program ? app.get_description() : name + ": " + app.get_description(), 0, 0, columns);
  const std::vector<std::string> commands = names_in(app, false);
  std::string use = "Use: " + name;
  if (!commands.empty()) use += program ? " VERB ..." : " COMMAND ...";
  for (const CLI::Option* const option : app.get_options())
    if (option->get_positional())
      use += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
  out += "\n" + wrapped(program ? use : use + " [options]", 0, 5, columns);
  std::string places;
  for (const CLI::Option* const option : app.get_options())
    if (option->get_positional())
      places += entry(option->get_name(), option->get_description(), columns, option_indent(columns));
  if (!places.empty()) out += "\n" + places;
  if (!commands.empty()) {
    out += program ? "\nVerbs\n" : "\nCommands\n";
    std::size_t longest = 0;
    for (const std::string& command : commands) longest = std::max(longest, command.size());
    for (const CLI::App* const part : app.get_subcommands(kAny))
      if (!part->get_name().empty())
        out += entry(part->get_name(), part->get_description(), columns, static_cast<int>(longest) + 4);
    out += "\n" +
           wrapped(fmt::format("{} {} --help says what it takes.", name, program ? "VERB" : "COMMAND"), 0, 0, columns);
  }
  out += options_text(app, "Options", columns);
  for (const CLI::App* const part : app.get_subcommands(kAny))
    if (part->get_name().empty()) out += options_text(*part, part->get_group(), columns);
  return out + footer_text(app.get_footer(), columns);
}

std::string refusal_text(const CLI::App& root, const CLI::ParseError& error, const std::vector<std::string>& words) {
  const CLI::App& at = chosen_app(root);
  const std::string hint = fmt::format(" ({} --help says more)", full_name(at));
  if (&at == &root && !words.empty() && !words[0].starts_with("-")) return unknown_text(root, words[0]) + hint;
  std::vector<std::string> unknown = at.remaining(false);
  if (&at != &root)
    for (const std::string& word : root.remaining(true)) unknown.push_back(word);
  for (const std::string& word : unknown)
    if (word.starts_with("-")) return unknown_text(at, word) + hint;
  if (!unknown.empty()) return unknown_text(at, unknown.front()) + hint;
  if (error.get_name() == "RequiredError") {
    if (const CLI::Option* const missing = missing_option(at)) {
      const std::string example = first_example(at);
      return fmt::format("{}: {} is missing, expected: {}{}", full_name(at), missing->get_name(),
                         missing->get_description(), example.empty() ? hint : "; for example: " + example);
    }
    return fmt::format("{} expects one of: {}{}", full_name(at), fmt::join(names_in(at, false), ", "), hint);
  }
  std::string what = error.what();
  if (const std::string mark = "Could not convert: "; what.starts_with(mark)) {
    what.erase(0, mark.size());
    const std::size_t equals = what.find(" = ");
    if (equals != std::string::npos)
      what = fmt::format("{}: \"{}\" found, expected a number", what.substr(0, equals), what.substr(equals + 3));
  } else if (error.get_name() == "ArgumentMismatch" && what.find("missing") != std::string::npos) {
    what = what.substr(0, what.find(':')) + " found without what shall follow it";
  }
  return what + hint;
}

}  // namespace dubsar::app
