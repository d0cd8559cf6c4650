// Nothing of the house grows beyond what one can hold in mind (CONTRIBUTING.md, Code): files of at most 400 lines,
// classes of at most 15 data members, folders of at most 40 sources and headers.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "tests/core/base/class_scan.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

constexpr int kMostMembers = 15;
constexpr int kMostLines = 400;
constexpr int kMostFiles = 40;

std::map<std::string, std::string> sources(std::initializer_list<const char*> rooms) {
  std::map<std::string, std::string> texts;
  const fs::path root(DUBSAR_SOURCE_DIR);
  for (const char* room : rooms)
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".c") continue;
      std::ifstream stream(entry.path());
      texts[fs::relative(entry.path(), root).string()] = {std::istreambuf_iterator<char>(stream), {}};
    }
  return texts;
}

int members_of(const char* source, const std::string& name = "A") {
  for (const ScannedClass& found : scan_classes(source))
    if (found.name == name) return found.members;
  return -1;
}

TEST(ClassScan, CountsWhatAClassHolds) {
  EXPECT_EQ(members_of("struct A { int a; float b = 1, c{2}; std::map<int, float> d; };"), 4);
  EXPECT_EQ(members_of("class A : public B<int, 2> { public: A() : a_{1}, b_(2) {} int f(int, int) const; private:\n "
                       "int a_, b_; };"),
            2);
  EXPECT_EQ(
      members_of(
          "struct A { static constexpr int k = 1; using T = int; friend class B; enum E { x, y }; struct C; E e; };"),
      1);
  EXPECT_EQ(members_of("struct A { std::function<void(int, int)> f; void (*g)(int); int h[3][2] = {{1, 2}}; };"), 3);
  EXPECT_EQ(
      members_of("struct A { int a : 3, b : 4; char c = ';'; const char* d = \"{;\"; // int e;\n /* int f; */ };"), 4);
  EXPECT_EQ(members_of("struct A { int f() { struct L { int x; } l; return 1 < 2; } bool big = 1 << 20, b; };"), 2);
  EXPECT_EQ(members_of("template <class T, class U>\nstruct alignas(16) A final { T t; [[maybe_unused]] U u; };"), 2);
  EXPECT_EQ(members_of("namespace n { namespace { class A { A& operator=(const A&) = delete; ~A(); int a; }; } }"), 1);
  EXPECT_EQ(members_of("struct A { int n = 1'000'000, m = 2; std::string raw = R\"(};)\"; };"), 3);
}

TEST(ClassScan, NestedClassesCountForThemselvesUnlessTheyHaveNoName) {
  const char* source =
      "class A { struct Inner { int a, b; }; Inner inner_; struct { int c, d, e; } hidden_; union { int f; float g; }; "
      "};";
  EXPECT_EQ(members_of(source, "A::Inner"), 2);
  EXPECT_EQ(members_of(source), 1 + 3 + 2);
}

TEST(ClassScan, SaysInWhichNamespaceATypeIs) {
  const auto found = scan_classes(
      "namespace a::b {\nenum class E : unsigned char { x, y };\nnamespace { struct S { enum F { z }; int i; }; }\n} "
      "// namespace a::b\nextern \"C\" { struct C { int j; }; }");
  std::map<std::string, std::string> scopes;
  for (const ScannedClass& type : found) scopes[type.name] = type.scope + (type.enumeration ? " enum" : "");
  const std::map<std::string, std::string> expected{
      {"E", "a::b enum"}, {"S::F", "a::b::(unnamed) enum"}, {"S", "a::b::(unnamed)"}, {"C", "(unnamed)"}};
  EXPECT_EQ(scopes, expected);
}

// Of two types of one name in namespaces of which one lies in the other, one hides the other; in the same namespace
// they are one type to the linker. Types of a source of its own and those within classes are seen by nobody else.
TEST(Names, NoTypeOfAHeaderHidesAnotherOne) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> places;  // by name: scopes and their files
  for (const auto& [file, text] : sources({"core", "devices", "input", "display", "app"}))
    for (const ScannedClass& found : scan_classes(text))
      if (file.ends_with(".h") && found.name.find("::") == std::string::npos && found.name != "(unnamed)")
        places[found.name][found.scope].insert(file);
  EXPECT_GT(places.size(), 400U) << "the scan does not see the house";
  for (const auto& [name, scopes] : places)
    for (const auto& [scope, files] : scopes) {
      EXPECT_EQ(files.size(), 1U) << name << " is defined in " << ::testing::PrintToString(files);
      for (const auto& [inner, others] : scopes)
        EXPECT_FALSE(inner.starts_with(scope + "::"))
            << name << " of " << *others.begin() << " hides that of " << *files.begin();
    }
}

TEST(Names, NoTwoFilesHaveOneName) {
  std::map<std::string, std::string> stems;  // a header and its source are one
  for (const auto& [file, text] : sources({"core", "devices", "input", "display", "app", "tests"})) {
    const std::string whole = fs::path(file).replace_extension().string(), stem = fs::path(whole).filename().string();
    const auto [before, fresh] = stems.emplace(stem, whole);
    EXPECT_TRUE(fresh || before->second == whole) << file << " has the name of " << before->second;
  }
  EXPECT_GT(stems.size(), 500U);
}

TEST(Sizes, NoClassHasMoreThanFifteenDataMembers) {
  int classes = 0, members = 0;
  for (const auto& [file, text] : sources({"core", "devices", "input", "display", "app", "examples", "tests"}))
    for (const ScannedClass& found : scan_classes(text)) {
      if (found.enumeration) continue;
      ++classes;
      members += found.members;
      EXPECT_LE(found.members, kMostMembers)
          << file << ": " << found.name << " does too much: make parts of it, each with a name of its own";
    }
  EXPECT_GT(classes, 800) << "the scan does not see the house";
  EXPECT_GT(members, 3 * classes / 2) << "the scan does not see what the classes hold";
}

TEST(Sizes, NoFileHasMoreThanFourHundredLinesButGeneratedTables) {
  int files = 0;
  for (const auto& [file, text] : sources({"core", "devices", "input", "display", "app", "examples", "tests"})) {
    ++files;
    if (text.find("enerated by") != std::string::npos && text.find("class ") == std::string::npos) continue;
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), kMostLines) << file;
  }
  EXPECT_GT(files, 600);
}

// What counts is what stands in the folder itself: chambers within it count for themselves.
TEST(Sizes, NoFolderHoldsMoreThanFortySourcesAndHeaders) {
  std::map<std::string, int> folders;
  for (const auto& [file, text] : sources({"core", "devices", "input", "display", "app"}))
    ++folders[fs::path(file).parent_path().string()];
  for (const auto& [folder, files] : folders)
    EXPECT_LE(files, kMostFiles) << folder
                                 << " is more than one idea: make chambers of it, each with a name of its own";
  EXPECT_GT(folders.size(), 50U) << "the scan does not see the house";
}

}  // namespace
}  // namespace dubsar
