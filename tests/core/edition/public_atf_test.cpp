// Files of other people: DUBSAR_ATF_FOLDER names a folder of them, for example of those that the projects pyoracc and
// nammu test with. Nothing of them is part of this project.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "core/base/files/atomic_file.h"
#include "core/edition/atf.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

TEST(PublicAtf, EveryLineIsReadAndWrittenAgainAndFewAreUnknown) {
  const char* const folder = std::getenv("DUBSAR_ATF_FOLDER");
  if (folder == nullptr) GTEST_SKIP() << "DUBSAR_ATF_FOLDER names no folder of ATF files";
  std::map<AtfKind, int> kinds;
  int files = 0, lines = 0, faults = 0, warnings = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".atf") continue;
    const std::string text = read_text_file(entry.path(), 64 << 20).value();
    const AtfFile file = read_atf(text);
    EXPECT_EQ(write_atf(file), text) << entry.path();
    ++files;
    for (const AtfLine& line : file.lines) {
      ++kinds[line.kind];
      ++lines;
      if (line.kind == AtfKind::kUnknown) std::cout << entry.path().filename().string() << " ? " << line.bytes << "\n";
    }
    for (const AtfFault& fault : check_atf(file)) {
      ++(fault.only_warning ? warnings : faults);
      if (!fault.only_warning)
        std::cout << fmt::format("{}:{}:{}: {}\n", entry.path().filename().string(), fault.line, fault.column,
                                 fault.message);
    }
  }
  for (const auto& [kind, count] : kinds) std::cout << fmt::format("{:>7} {}\n", count, name_in(kAtfKinds, kind));
  std::cout << fmt::format("{} files, {} lines, {} faults, {} warnings\n", files, lines, faults, warnings);
  EXPECT_GT(files, 0) << "no .atf in " << folder;
  EXPECT_LT(kinds[AtfKind::kUnknown], lines / 100);
}

}  // namespace
}  // namespace dubsar
