// The guide: its keys and commands are those of the program.

#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "app/commands/key_table.h"
#include "core/base/files/atomic_file.h"
#include "display/render/shading.h"

namespace dubsar::app {
namespace {

CommandTable commands() {
  std::vector<std::string> styles;
  for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
  return CommandTable::standard(styles);
}

std::vector<std::string> lines_of_guide() {
  std::istringstream text(read_text_file(DUBSAR_GUIDE).value());
  std::vector<std::string> out;
  for (std::string line; std::getline(text, line);) out.push_back(line);
  return out;
}

TEST(Guide, EveryKeyDoesWhatItsRowSays) {
  const CommandTable table = commands();
  const KeyTable keys = KeyTable::create(table).value();
  const std::regex row(R"(^\| `([^`]+)` \| `([^`]+)`.*\|$)");
  int rows = 0;
  for (const std::string& line : lines_of_guide()) {
    std::smatch found;
    if (!std::regex_match(line, found, row)) {
      EXPECT_FALSE(line.starts_with("| `")) << "a row that is not read: " << line;
      continue;
    }
    ++rows;
    const auto bound = keys.keys_for(found[2].str());
    EXPECT_NE(std::find(bound.begin(), bound.end(), found[1].str()), bound.end()) << line;
  }
  EXPECT_GE(rows, 45);
}

TEST(Guide, EveryCommandInItCanBeSaid) {
  const CommandTable table = commands();
  const std::regex code("`([a-z_]+)( [^`]*)?`");
  int said = 0;
  for (const std::string& line : lines_of_guide()) {
    if (line.starts_with("```")) continue;
    for (std::sregex_iterator at(line.begin(), line.end(), code), end; at != end; ++at) {
      if (table.find((*at)[1].str()) == nullptr) continue;  // a key
      const auto fits = table.check((*at)[1].str() + (*at)[2].str());
      EXPECT_TRUE(fits) << line << ": " << fits.error().message;
      ++said;
    }
  }
  EXPECT_GE(said, 55);
}

TEST(Guide, EveryCommandOfTheProgramStandsInTheScriptThatRunsThemAll) {
  const std::string text = read_text_file(DUBSAR_EVERY_COMMAND).value();
  const CommandTable table = commands();
  for (const Command& command : table.all())
    EXPECT_TRUE(std::regex_search(text, std::regex("[0-9] " + command.name + "( |\n)"))) << command.name;
}

}  // namespace
}  // namespace dubsar::app
