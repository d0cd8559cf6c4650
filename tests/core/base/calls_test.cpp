// What a header offers is used by the house itself: functions that nobody but tests calls are deleted, or are the
// tests'.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <unordered_map>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

/// Comments and what stands between quotes become nothing.
std::string without_comments(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i), text.size() - 2) + 2;
    } else if (text.compare(i, 2, "R\"") == 0) {
      const std::size_t open = text.find('(', i);
      const std::string close = ")" + text.substr(i + 2, open - i - 2) + "\"";
      i = std::min(text.find(close, open), text.size() - close.size()) + close.size();
    } else if (text[i] == '"' ||
               (text[i] == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]))))) {
      const char quote = text[i];
      for (++i; i < text.size() && text[i] != quote; ++i)
        if (text[i] == '\\') ++i;
      ++i;
    } else {
      out += text[i++];
    }
  }
  return out;
}

/// Of functions that `header` declares and only its own source defines, those that nothing in `sources` calls.
std::set<std::string> uncalled(const std::map<std::string, std::string>& sources) {
  static const std::regex declared(R"((\w+[ ]|[>&*\]][ ]?)([a-z]\w*)\()"), defined(R"(\n[^\s{}#/][^;\n]*?\b(\w+)\()");
  static const std::set<std::string> no_types{"return ", "else ", "new ", "throw ", "case ", "and ", "or ", "not "};
  std::unordered_map<std::string, int> seen;
  for (const auto& [file, text] : sources)
    for (std::size_t i = 0; i < text.size(); ++i) {
      const std::size_t begin = i;
      while (i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_')) ++i;
      if (i > begin) ++seen[text.substr(begin, i - begin)];
    }
  std::set<std::string> out;
  for (const auto& [file, text] : sources) {
    if (!file.ends_with(".h")) continue;
    std::set<std::string> bodies;
    if (const auto own = sources.find(file.substr(0, file.size() - 1) + "cpp"); own != sources.end())
      for (std::sregex_iterator it(own->second.begin(), own->second.end(), defined), end; it != end; ++it)
        bodies.insert((*it)[1]);
    for (std::sregex_iterator it(text.begin(), text.end(), declared), end; it != end; ++it) {
      const std::string name = (*it)[2];
      if (no_types.contains((*it)[1])) continue;
      if (seen[name] == 1 || (seen[name] == 2 && bodies.contains(name))) out.insert(name);
    }
  }
  return out;
}

TEST(Calls, AFunctionThatNothingCallsIsFound) {
  const std::string header =
      "int used();\nint unused(int a);\nstruct A {\n  int get() const { return a_; }\n  int look() { return get(); "
      "}\n};\n";
  EXPECT_EQ(uncalled({{"a.h", without_comments(header + "// unused\n")},
                      {"a.cpp", "\nint used() {\n  return 1;\n}\n\nint unused(int a) {\n  return used();\n}\n"},
                      {"b.cpp", without_comments("\nint main() {\n  const char* c = \"look\";\n}\n")}}),
            (std::set<std::string>{"look", "unused"}));
}

// Names of functions that are declared elsewhere, too, or stand in other words, are not looked at.
TEST(Calls, WhatAHeaderOffersIsUsedByTheHouse) {
  // What a test has to see or to put in place, of things whose purpose is to be looked at.
  const std::set<std::string> for_tests{
      "check_exactly",            // what is exported, counted by tests and benchmarks
      "coarse_views",             // of the picture that is shown
      "nearest_part",             // truth of a phantom
      "on_tablet_side",           // the same
      "light_is_on",              // what a simulated device shows
      "line_name",                // for files of words
      "make_webcam_source_over",  // pictures in place of a camera
      "set_hdf5_plugin_folder",   // a machine without plug-ins
      "udev_rules",               // devices/70-dubsar.rules is compared with it
  };
  std::map<std::string, std::string> sources;
  for (const char* room : {"core", "devices", "input", "display", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(DUBSAR_SOURCE_DIR) / room))
      if (const auto kind = entry.path().extension(); kind == ".h" || kind == ".cpp")
        sources[entry.path().string()] = without_comments(read_text_file(entry.path()).value());
  ASSERT_GT(sources.size(), 700U);
  EXPECT_EQ(uncalled(sources), for_tests) << "what only tests call is deleted, or moved to them";
}

}  // namespace
}  // namespace dubsar
