// The walls of the house (README, Rooms): which room may include which, and that each third-party C
// API is included by exactly one source file.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

struct Include {
  std::string file, target;
};

std::vector<Include> all_includes() {
  std::vector<Include> includes;
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  for (const char* room : {"core", "devices", "input", "display", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(DUBSAR_SOURCE_DIR) / room)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      std::smatch match;
      for (std::string line; std::getline(file, line);)
        if (std::regex_search(line, match, pattern))
          includes.push_back({fs::relative(entry.path(), DUBSAR_SOURCE_DIR).string(), match[1]});
    }
  return includes;
}

bool starts_with(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

TEST(Layering, RoomsIncludeOnlyWhatIsBelowThem) {
  const std::map<std::string, std::vector<const char*>> forbidden{
      {"core/", {"devices/", "input/", "display/", "app/", "epoxy/", "GLFW/", "EGL/"}},
      {"core/base/", {"core/volume/", "core/surface/", "core/exa/", "core/mesh_io/", "core/pipeline/"}},
      {"core/phantom/", {"core/surface/", "core/exa/", "core/mesh_io/", "core/pipeline/", "core/image_io/"}},
      {"core/volume/", {"core/phantom/", "core/surface/", "core/exa/", "core/mesh_io/", "core/pipeline/"}},
      {"core/surface/", {"core/phantom/", "core/exa/", "core/mesh_io/", "core/pipeline/"}},
      {"core/exa/", {"core/mesh_io/", "core/pipeline/"}},
      {"core/mesh_io/", {"core/pipeline/"}},
      {"devices/",
       {"input/", "display/", "app/", "core/volume/", "core/surface/", "core/exa/", "core/mesh_io/", "core/pipeline/"}},
      {"input/", {"display/", "app/", "core/volume/", "core/surface/", "core/exa/", "core/mesh_io/", "core/pipeline/"}},
      {"display/", {"input/", "app/", "devices/"}},
  };
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 10u);
  for (const auto& [file, target] : includes)
    for (const auto& [room, targets] : forbidden)
      for (const char* wall : targets)
        EXPECT_FALSE(starts_with(file, room.c_str()) && starts_with(target, wall)) << file << " includes " << target;
}

TEST(Layering, EachThirdPartyCApiIsIncludedByOneSourceFile) {
  const std::vector<std::string> apis{
      "hdf5.h",          "hidapi", "libusb",   "GLFW/glfw3.h", "tiffio.h", "embree3/rtcore.h", "opencv2/videoio.hpp",
      "opencv2/dnn.hpp", "png.h",  "EGL/egl.h"};
  for (const std::string& api : apis) {
    std::set<std::string> users;
    for (const auto& [file, target] : all_includes())
      if (starts_with(target, api.c_str())) users.insert(file);
    std::string names;
    for (const auto& user : users) names += user + " ";
    EXPECT_LE(users.size(), 1u) << api << " is included by " << names;
  }
}

}  // namespace
