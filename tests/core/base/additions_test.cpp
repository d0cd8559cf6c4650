// docs/architecture.md, "To add ...": what no sample proves is proven by reading the sources. Sinks: layering_test.cpp.
// Attributes: vertex_attributes_test.cpp. Devices: drivers_test.cpp. Actions: commands_test.cpp.

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

const fs::path kRoot(DUBSAR_SOURCE_DIR);

std::string text_of(const fs::path& file) { return read_text_file(kRoot / file).value_or(""); }

/// What is found of the first group of a pattern.
std::set<std::string> all_of(const std::string& text, const std::string& pattern) {
  std::set<std::string> out;
  const std::regex expression(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it) out.insert((*it)[1]);
  return out;
}

/// The files that a line of "To add ..." links to.
std::set<std::string> files_to_touch(const std::string& what) {
  const std::string page = text_of("docs/architecture.md");
  const std::size_t begin = page.find("- **" + what + "**");
  EXPECT_NE(begin, std::string::npos) << what;
  return begin == std::string::npos
             ? std::set<std::string>()
             : all_of(page.substr(begin, page.find("\n- **", begin + 1) - begin), R"(\]\(\.\./([^)]+)\))");
}

TEST(Additions, AFilterIsItsValueWhatItDoesAndItsOracle) {
  const std::string header = text_of("core/filter/denoise.h");
  const std::size_t begin = header.find("enum class DenoiseMethod");
  ASSERT_NE(begin, std::string::npos);
  const auto methods = all_of(header.substr(begin, header.find("};", begin) - begin), R"((k[A-Z]\w+),)");
  ASSERT_GE(methods.size(), 4U);
  std::set<std::string> touched{"tests/core/filter/filter_oracle.h"};
  for (const char* room : {"core", "devices", "input", "display", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / room)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      // Who uses one filter for a purpose names it; who tells filters apart names two, and is touched by a third.
      const std::string file = fs::relative(entry.path(), kRoot).string();
      if (all_of(text_of(file), R"(DenoiseMethod::(k\w+))").size() > 1) touched.insert(file);
    }
  EXPECT_EQ(touched, files_to_touch("a filter"));
  const std::string oracle = text_of("tests/core/filter/denoise_test.cpp");
  EXPECT_NE(oracle.find("for (const auto& method : kDenoiseMethods)"), std::string::npos)
      << "a new filter is compared with its oracle, and so with the others, because it stands in the table";
}

TEST(Additions, TheListsOfThePageNameTheirPlaces) {
  EXPECT_TRUE(files_to_touch("an attribute of vertices").contains("core/mesh/vertex_attributes.h"));
  EXPECT_TRUE(files_to_touch("an action").contains("app/commands"));
  EXPECT_TRUE(files_to_touch("a device").contains("devices/drivers.cpp"));
  EXPECT_TRUE(files_to_touch("a sink").contains("display/sinks/catalog/sink_catalog.cpp"));
}

TEST(Additions, AFrameOfALeapGoesThroughAtMostTwelveFilesEachOfWhichHandsItToTheNext) {
  const std::string page = text_of("docs/leap.md");
  const std::regex row(R"re(\n\| (\d+) \| \[[^\]]+\]\(\.\./([^)]+)\) \| (?:`(\w+)`)? ?\|)re");
  std::vector<std::string> files, calls;
  for (std::sregex_iterator it(page.begin(), page.end(), row), end; it != end; ++it) {
    EXPECT_EQ((*it)[1], std::to_string(files.size() + 1));
    files.push_back((*it)[2]);
    calls.push_back((*it)[3]);
  }
  ASSERT_GE(files.size(), 2U) << "docs/leap.md has no list of the way of a frame";
  EXPECT_LE(files.size(), 12U);
  EXPECT_EQ(files.front(), "devices/transport/usb_transport.cpp");
  EXPECT_EQ(files.back(), "app/stage/stage.cpp");
  for (std::size_t i = 0; i + 1 < files.size(); ++i)
    for (const std::string& side : {files[i], files[i + 1]})
      EXPECT_TRUE(std::regex_search(text_of(side), std::regex("\\b" + calls[i] + "\\b")))
          << side << " has nothing called " << calls[i] << ", by which " << files[i] << " hands frames to "
          << files[i + 1];
}

}  // namespace
}  // namespace dubsar
