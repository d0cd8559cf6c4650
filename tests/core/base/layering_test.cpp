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
  for (const char* room : {"core", "devices", "input", "display", "app", "tests/people"})
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
  // Rooms of core from the bottom up; each includes only itself and what stands before it.
  const std::vector<std::string> floors{"base",    "image_io", "hdf5",    "volume",  "filter", "phantom",
                                        "mesh",    "refine",   "rays",    "extract", "relief", "parts",
                                        "contact", "exa",      "mesh_io", "pipeline"};
  std::map<std::string, std::vector<std::string>> forbidden{
      {"core/", {"devices/", "input/", "display/", "app/", "epoxy/", "GLFW/", "EGL/"}},
      {"core/hdf5/", {"core/image_io/"}},
      {"core/phantom/", {"core/image_io/"}},
      {"core/mesh_io/", {"core/exa/"}},
      {"display/", {"input/", "app/", "devices/"}},
      {"display/optics/", {"display/panels/", "display/render/", "display/sinks/", "epoxy/"}},
      {"display/panels/", {"display/render/", "display/sinks/", "epoxy/"}},
      {"display/render/", {"display/sinks/"}},
      // Simulated visitors share nothing with what recognises them.
      {"tests/people/", {"input/gestures/", "input/people/", "input/navigation/", "devices/", "display/", "app/"}},
  };
  for (std::size_t floor = 0; floor < floors.size(); ++floor) {
    auto& walls = forbidden["core/" + floors[floor] + "/"];
    for (std::size_t above = floor + 1; above < floors.size(); ++above) walls.push_back("core/" + floors[above] + "/");
    if (floor < 2) continue;  // devices and input use base, and pictures of cameras
    for (const char* room : {"devices/", "input/"}) forbidden[room].push_back("core/" + floors[floor] + "/");
  }
  forbidden["devices/"].insert(forbidden["devices/"].end(), {"input/", "display/", "app/"});
  forbidden["input/"].insert(forbidden["input/"].end(), {"display/", "app/"});
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 10u);
  for (const auto& [file, target] : includes)
    for (const auto& [room, targets] : forbidden)
      for (const std::string& wall : targets)
        EXPECT_FALSE(starts_with(file, room.c_str()) && starts_with(target, wall.c_str()))
            << file << " includes " << target;
}

// One folder speaks to HDF5, and hides it: what its sources share is not included by anybody else.
TEST(Layering, Hdf5IsBehindTheDoorOfItsRoom) {
  const std::set<std::string> doors{"core/hdf5/chunk_filters.h", "core/hdf5/hdf5_dataset.h", "core/hdf5/hdf5_file.h",
                                    "core/hdf5/hdf5_filters.h", "core/hdf5/hdf5_writer.h"};
  std::set<std::string> users;
  for (const auto& [file, target] : all_includes()) {
    const bool inside = starts_with(file, "core/hdf5/");
    if (target == "hdf5.h") users.insert(file);
    EXPECT_TRUE(inside || !starts_with(target, "core/hdf5/") || doors.contains(target))
        << file << " includes " << target;
    EXPECT_FALSE(doors.contains(file) && target == "core/hdf5/library.h") << file << " shows the library to its users";
  }
  EXPECT_EQ(users, std::set<std::string>{"core/hdf5/library.h"});
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The rooms of the app: targets of app/CMakeLists.txt, the folders of their sources, and all that they link there.
struct AppRoom {
  std::set<std::string> folders, links;
};

std::map<std::string, AppRoom> app_rooms() {
  const std::string text = text_of(fs::path(DUBSAR_SOURCE_DIR) / "app/CMakeLists.txt");
  const std::regex room(R"(dubsar_library\((\w+)[^\n]* WALLED\s([^)]*)\))"), folder(R"(\s([a-z_]+)/)"),
      link(R"(\bdubsar_\w+)");
  const auto words = [](const std::string& where, const std::regex& what, std::size_t group) {
    std::set<std::string> out;
    for (std::sregex_iterator it(where.begin(), where.end(), what), end; it != end; ++it) out.insert((*it)[group]);
    return out;
  };
  std::map<std::string, AppRoom> out;
  for (std::sregex_iterator it(text.begin(), text.end(), room), end; it != end; ++it)
    out[(*it)[1]] = {words((*it)[2], folder, 1), words((*it)[2], link, 0)};
  for (std::size_t round = 0; round < out.size(); ++round)
    for (auto& [name, of] : out)
      for (const std::string& below : std::set<std::string>(of.links))
        if (const auto at = out.find(below); at != out.end())
          of.links.insert(at->second.links.begin(), at->second.links.end());
  return out;
}

// The compiler says so, too (dubsar_walled); this says it of a build without the app, and which way the arrows go.
TEST(Layering, RoomsOfTheAppIncludeOnlyWhatTheyLink) {
  const std::map<std::string, AppRoom> rooms = app_rooms();
  ASSERT_GE(rooms.size(), 14u);
  const std::map<std::string, std::set<std::string>> never{
      {"dubsar_document", {"dubsar_session", "dubsar_commands", "dubsar_stage"}},
      {"dubsar_commands", {"dubsar_session", "dubsar_stage", "dubsar_tools", "dubsar_drawers"}},
      {"dubsar_stage", {"dubsar_commands", "dubsar_session", "dubsar_steering", "dubsar_tools", "dubsar_drawers"}},
      {"dubsar_steering", {"dubsar_commands", "dubsar_session", "dubsar_stage", "dubsar_tools", "dubsar_drawers"}},
      {"dubsar_tools", {"dubsar_session", "dubsar_drawers", "dubsar_kiosk", "dubsar_gallery", "dubsar_viewer"}},
      {"dubsar_drawers",
       {"dubsar_session", "dubsar_steering", "dubsar_tools", "dubsar_kiosk", "dubsar_gallery", "dubsar_viewer"}},
      {"dubsar_gallery", {"dubsar_drawers", "dubsar_session", "dubsar_viewer"}},
      {"dubsar_viewer", {"dubsar_kiosk", "dubsar_gallery"}}};
  for (const auto& [room, others] : never)
    for (const std::string& other : others)
      EXPECT_FALSE(rooms.at(room).links.contains(other)) << room << " links " << other;
  // Who may be seen from a folder: itself, and what the targets with sources in it link.
  std::map<std::string, std::set<std::string>> seen;
  for (const auto& [name, room] : rooms)
    for (const std::string& folder : room.folders) {
      seen[folder].insert(folder);
      for (const std::string& link : room.links)
        if (const auto at = rooms.find(link); at != rooms.end())
          seen[folder].insert(at->second.folders.begin(), at->second.folders.end());
    }
  for (const char* of_the_program : {"cli", "monitor", "publish"}) seen.erase(of_the_program);
  const std::regex folder("^app/([a-z_]+)/.*");
  for (const auto& [file, target] : all_includes()) {
    std::smatch from, to;
    if (!std::regex_match(file, from, folder) || !std::regex_match(target, to, folder)) continue;
    const auto walls = seen.find(from[1]);
    EXPECT_TRUE(walls == seen.end() || walls->second.contains(to[1])) << file << " includes " << target;
  }
}

// A core build has neither graphics nor devices: what its verbs include, and what that includes, is core, words,
// documents and the command line.
TEST(Layering, VerbsOfACoreBuildReachNeitherWindowNorDevices) {
  std::ifstream file(fs::path(DUBSAR_SOURCE_DIR) / "app/CMakeLists.txt");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = text.find("set(core_verbs");
  ASSERT_NE(begin, std::string::npos);
  const std::string list = text.substr(begin, text.find(')', begin) - begin);
  std::multimap<std::string, std::string> includes;
  for (const auto& [from, to] : all_includes()) includes.emplace(from, to);
  std::vector<std::string> open{"app/core_main.cpp", "app/publish/surface_facts.cpp"};
  const std::regex source(R"([a-z_]+/[a-z0-9_]+\.cpp)");
  for (std::sregex_iterator it(list.begin(), list.end(), source), end; it != end; ++it)
    open.push_back("app/" + it->str());
  ASSERT_GE(open.size(), 10u);
  const std::regex allowed("^app/(cli|document|words|verbs|publish)/.*");
  std::set<std::string> seen(open.begin(), open.end());
  while (!open.empty()) {
    const std::string at = open.back();
    open.pop_back();
    for (auto [it, end] = includes.equal_range(at); it != end; ++it) {
      const std::string& target = it->second;
      for (const char* room : {"devices/", "input/", "display/"})
        EXPECT_FALSE(starts_with(target, room)) << at << " includes " << target;
      if (!starts_with(target, "app/")) continue;
      EXPECT_TRUE(std::regex_match(target, allowed)) << at << " includes " << target;
      if (seen.insert(target).second) open.push_back(target);
    }
  }
}

// docs/architecture.md, "a sink": its pair, one row of the table, its case in the test of directions, its row in the
// docs.
TEST(Layering, ASinkIsItsPairARowOfTheTableItsTestAndItsRowInTheDocs) {
  const fs::path root(DUBSAR_SOURCE_DIR);
  const std::string table = text_of(root / "display/sinks/catalog/sink_catalog.cpp");
  const std::string directions = text_of(root / "tests/display/sinks/directions_test.cpp");
  const std::string docs = text_of(root / "docs/displays.md");
  const std::regex row(R"re(\{"(\w+)",[^}]*?(make_\w+_sink)(?:, false)?\})re");
  std::map<std::string, std::set<std::string>> users;  // of each maker
  const std::regex maker(R"(\bmake_\w+_sink\b)");
  for (const char* room : {"core", "devices", "input", "display", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      if (!entry.is_regular_file()) continue;
      const std::string text = text_of(entry.path());
      for (std::sregex_iterator it(text.begin(), text.end(), maker), end; it != end; ++it)
        users[it->str()].insert(fs::relative(entry.path(), root).string());
    }
  int sinks = 0;
  for (std::sregex_iterator it(table.begin(), table.end(), row), end; it != end; ++it, ++sinks) {
    const std::string name = (*it)[1], make = (*it)[2];
    EXPECT_NE(directions.find("{\"" + name + "\","), std::string::npos)
        << "no case of " << name << " in directions_test.cpp";
    EXPECT_TRUE(std::regex_search(docs, std::regex("\n\\|[^|]*\\b" + name + "\\b[^|]*\\|"))) << "no row of " << name;
    std::set<std::string> pairs;
    for (const std::string& user : users[make]) {
      if (user == "display/sinks/catalog/sink_catalog.cpp") continue;
      EXPECT_TRUE(starts_with(user, "display/sinks/")) << make << " is known to " << user;
      pairs.insert(user.substr(0, user.rfind('.')));
    }
    EXPECT_LE(pairs.size(), 2u) << make << ": its own pair, and at most one display that is made of it";
  }
  EXPECT_GE(sinks, 12);
}

// OpenXR drags the words of X11 and EGL along: one header of one folder includes it, and only that folder includes it.
TEST(Layering, OpenXrIsBehindTheDoorOfItsRoom) {
  for (const auto& [file, target] : all_includes()) {
    const bool inside = starts_with(file, "display/headset/openxr_");
    EXPECT_TRUE(inside || !starts_with(target, "openxr/")) << file << " includes " << target;
    EXPECT_TRUE(inside || !starts_with(target, "display/headset/openxr_")) << file << " includes " << target;
  }
}

TEST(Layering, EachThirdPartyCApiIsIncludedByOneSourceFile) {
  const std::vector<std::string> apis{
      "hidapi",          "libusb", "GLFW/glfw3.h", "tiffio.h", "embree3/rtcore.h", "opencv2/videoio.hpp",
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

// The program has flags; the libraries, which others call too, speak of what the flags mean.
TEST(Layering, NoTextOfCoreNamesAFlagOfTheProgram) {
  const std::regex flag(R"(^[^/]*"[^"]*--[a-z])");
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(DUBSAR_SOURCE_DIR) / "core")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
    ++files;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      EXPECT_FALSE(std::regex_search(line, flag)) << entry.path() << ": " << line;
  }
  EXPECT_GT(files, 100);
}

}  // namespace
