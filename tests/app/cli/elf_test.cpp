// What the loader is told by the files that people get: which folders it looks in, and what may be written or executed.

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace dubsar::test {
namespace {

class Elf {
 public:
  explicit Elf(const char* path) {
    std::ifstream file(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    head_ = at<Elf64_Ehdr>(0);
    for (int i = 0; i < head_.e_phnum; ++i)
      segments_.push_back(at<Elf64_Phdr>(head_.e_phoff + static_cast<std::size_t>(i) * sizeof(Elf64_Phdr)));
    if (const Elf64_Phdr* const table = segment(PT_DYNAMIC))
      for (std::size_t i = 0; i < table->p_filesz / sizeof(Elf64_Dyn); ++i)
        dynamic_.push_back(at<Elf64_Dyn>(table->p_offset + i * sizeof(Elf64_Dyn)));
  }
  bool good() const {
    return bytes_.size() > sizeof head_ && std::memcmp(head_.e_ident, ELFMAG, SELFMAG) == 0 && !dynamic_.empty();
  }
  const Elf64_Phdr* segment(std::uint32_t type) const {
    for (const Elf64_Phdr& one : segments_)
      if (one.p_type == type) return &one;
    return nullptr;
  }
  std::vector<std::uint64_t> values(std::int64_t tag) const {
    std::vector<std::uint64_t> out;
    for (const Elf64_Dyn& one : dynamic_)
      if (one.d_tag == tag) out.push_back(one.d_un.d_val);
    return out;
  }
  std::vector<std::string> texts(std::int64_t tag) const {
    std::vector<std::string> out;
    for (const std::uint64_t value : values(tag))
      out.emplace_back(bytes_.c_str() + offset_of(values(DT_STRTAB)[0]) + value);
    return out;
  }
  std::uint16_t type() const { return head_.e_type; }
  bool names(const std::string& symbol) const {
    return bytes_.find(std::string(1, '\0') + symbol + '\0') != std::string::npos;
  }

 private:
  template <class T>
  T at(std::size_t offset) const {
    T value{};
    if (offset + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  std::size_t offset_of(std::uint64_t address) const {
    for (const Elf64_Phdr& one : segments_)
      if (one.p_type == PT_LOAD && address >= one.p_vaddr && address < one.p_vaddr + one.p_filesz)
        return one.p_offset + (address - one.p_vaddr);
    return 0;
  }

  std::string bytes_;
  Elf64_Ehdr head_{};
  std::vector<Elf64_Phdr> segments_;
  std::vector<Elf64_Dyn> dynamic_;
};

TEST(BuiltFiles, LibrariesComeFromTheSystemsFoldersAndTablesAreBoundAtTheStart) {
  for (const char* path : {DUBSAR_PROGRAM, DUBSAR_CAPTURE, DUBSAR_EXA_LIBRARY}) {
    const Elf elf(path);
    ASSERT_TRUE(elf.good()) << path;
    EXPECT_EQ(elf.type(), ET_DYN) << path;
    // An empty or a relative element of these is the folder that the user is in.
    EXPECT_TRUE(elf.texts(DT_RUNPATH).empty()) << path << ": " << elf.texts(DT_RUNPATH)[0];
    EXPECT_TRUE(elf.texts(DT_RPATH).empty()) << path << ": " << elf.texts(DT_RPATH)[0];
    for (const std::string& library : elf.texts(DT_NEEDED))
      EXPECT_EQ(library.find('/'), std::string::npos) << path << " " << library;
    EXPECT_GE(elf.texts(DT_NEEDED).size(), 2u) << path;
    ASSERT_NE(elf.segment(PT_GNU_RELRO), nullptr) << path;
    const auto flags = elf.values(DT_FLAGS), more = elf.values(DT_FLAGS_1);
    EXPECT_TRUE((!flags.empty() && (flags[0] & DF_BIND_NOW) != 0) || (!more.empty() && (more[0] & DF_1_NOW) != 0))
        << path << ": symbols are bound when they are first called";
    ASSERT_NE(elf.segment(PT_GNU_STACK), nullptr) << path;
    EXPECT_EQ(elf.segment(PT_GNU_STACK)->p_flags & PF_X, 0u) << path;
  }
}

#ifdef NDEBUG  // builds for debugging have the sanitizers instead
TEST(BuiltFiles, CopiesIntoBuffersOfKnownSizeAreChecked) {
  const Elf elf(DUBSAR_PROGRAM);
  ASSERT_TRUE(elf.good());
  EXPECT_TRUE(elf.names("__memcpy_chk"));
}
#endif

}  // namespace
}  // namespace dubsar::test
