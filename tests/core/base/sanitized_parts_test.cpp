// The sanitized suite is run in parts, one a revision (`do`, CONTRIBUTING.md): together they are the suite.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

const fs::path kTree(DUBSAR_SOURCE_DIR);

std::string text_in(const fs::path& file) { return read_text_file(kTree / file).value_or(""); }

/// What stands between the quotes in the list of `do`.
std::vector<std::string> parts() {
  const std::string script = text_in("do");
  const std::size_t begin = script.find("\nsanitized_parts=("), end = script.find("\n)", begin);
  std::vector<std::string> out;
  if (begin == std::string::npos || end == std::string::npos) return out;
  const std::string list = script.substr(begin, end - begin);
  const std::regex part("\"([^\"]+)\"");
  for (std::sregex_iterator it(list.begin(), list.end(), part), none; it != none; ++it) out.push_back((*it)[1]);
  return out;
}

TEST(SanitizedParts, AreTheFoldersOfTheTestsWhoseCasesNeedNothingSpecial) {
  std::set<std::string> expected;  // "program" for what runs the program
  for (const auto& entry : fs::recursive_directory_iterator(kTree / "tests")) {
    if (entry.path().filename() != "CMakeLists.txt") continue;
    const fs::path below = fs::relative(entry.path(), kTree / "tests");
    const std::string room = below.begin()->string();
    const bool divided = room == "core" || room == "app";
    const std::string folder = divided ? below.parent_path().generic_string() : room;
    const std::string lists = read_text_file(entry.path()).value_or("");
    const std::regex test(R"(dubsar_test\((\w+)([^)]*)\))"), label(R"(LABEL\s+(\w+))"), first(R"(SOURCES\s+(\w+)/)");
    for (std::sregex_iterator it(lists.begin(), lists.end(), test), none; it != none; ++it) {
      const std::string words = (*it)[2];
      std::smatch match;
      const std::string name = std::regex_search(words, match, label) ? std::string(match[1]) : "unit";
      if (name == "app") expected.insert("program");
      if (name != "unit" && name != "gl" && name != "replay") continue;
      const bool below_app = folder == "app" && std::regex_search(words, match, first);
      expected.insert(below_app ? folder + "/" + std::string(match[1]) : folder);
    }
  }
  ASSERT_GE(expected.size(), 6U);
  std::set<std::string> found, lines;
  for (const std::string& part : parts()) {
    std::istringstream words(part);
    EXPECT_TRUE(lines.insert(part).second) << part << " stands there twice";
    for (std::string room; words >> room && std::isalpha(static_cast<unsigned char>(room[0]));) found.insert(room);
  }
  EXPECT_EQ(found, expected);
  for (const std::string& line : lines) {  // of cases that take turns none is left out
    const std::size_t turn = line.find(" -I ");
    if (turn == std::string::npos) continue;
    const std::string of = line.substr(line.rfind(','));
    for (int i = 1; i <= std::stoi(of.substr(1)); ++i)
      EXPECT_TRUE(lines.contains(line.substr(0, turn) + " -I " + std::to_string(i) + "," + of)) << line;
  }
}

TEST(SanitizedParts, EachOneHasItsTurnAndContinuousIntegrationTakesIt) {
  EXPECT_TRUE(std::regex_search(text_in(".ci/run"), std::regex(R"(\n\./do asan turn\b)")));
  const std::string script = text_in("do");
  const std::size_t begin = script.find("\nsanitized_parts=("),
                    end = script.find("\n}\n", script.find("part_of_revision()"));
  ASSERT_TRUE(begin != std::string::npos && end != std::string::npos);
  const fs::path folder = fs::temp_directory_path() / ("dubsar_turns_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::string counts, names;
  for (std::size_t i = 0; i < parts().size(); ++i) {
    counts += " " + std::to_string(5 * parts().size() + i);
    std::ostringstream name;
    name << std::hex << std::setw(7) << std::setfill('0') << i;
    names += " " + name.str();
  }
  // A git of which nothing is asked but how many revisions there are, then one that does not know.
  const std::string commands =
      script.substr(begin, end + 3 - begin) + "for n in" + counts +
      "; do\n"
      "git() { case \"$*\" in *shallow*) echo false ;; *count*) echo $n ;; *) return 1 ;; esac; }\n"
      "part_of_revision\ndone\n"
      "for n in" +
      names +
      "; do\n"
      "git() { case \"$*\" in *shallow*) echo true ;; *short*) echo $n ;; *) return 1 ;; esac; }\n"
      "part_of_revision\ndone\n"
      "git() { return 128; }\npart_of_revision\n";
  std::ofstream(folder / "turns.sh") << commands;
  FILE* const pipe = ::popen(("bash -eu " + (folder / "turns.sh").string()).c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
  EXPECT_EQ(::pclose(pipe), 0);
  fs::remove_all(folder);
  std::string expected;
  for (int round = 0; round < 2; ++round)
    for (const std::string& part : parts()) expected += part + "\n";
  EXPECT_EQ(said, expected + parts().front() + "\n");
}

}  // namespace
}  // namespace dubsar
