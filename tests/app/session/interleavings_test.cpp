// Whatever happens to surfaces, to the files of the work, to windows and to the disk, in any order: a note that was
// shown as kept is found again.

#include <sys/resource.h>

#include <csignal>
#include <map>
#include <random>

#include "tests/app/session/work_desk.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr int kSequences = 500;
constexpr std::size_t kPeople = 2;

/// No file grows beyond some bytes, as on a disk that is full.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{64, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

struct Surface {
  fs::path file;
  std::string scan;
};

/// A note that a person was shown as kept.
struct Owed {
  std::string content, scan;
  std::size_t person = 0;
};

struct Window {
  WorkWindow work;
  std::string scan;
  std::size_t person = 0;
};

class Afternoon {
 public:
  explicit Afternoon(unsigned seed) : random_(seed) {
    for (int i = 0; i < 2; ++i) make(folder_.tablet(fmt::format("{}.exa", i)), fmt::format("{}-a{}", 100 + i, i));
  }

  void go_on() {
    using Op = void (Afternoon::*)();
    struct Kind {
      const char* name;
      Op op;
      int share;
    };
    static constexpr std::array<Kind, 10> kKinds{{{"open", &Afternoon::open, 5},
                                                  {"edit", &Afternoon::edit, 9},
                                                  {"autosave", &Afternoon::autosave, 6},
                                                  {"end", &Afternoon::end, 3},
                                                  {"kill", &Afternoon::kill, 2},
                                                  {"full disk", &Afternoon::full_disk, 2},
                                                  {"process anew", &Afternoon::process_anew, 3},
                                                  {"rename", &Afternoon::rename, 2},
                                                  {"copy", &Afternoon::copy, 2},
                                                  {"newer version", &Afternoon::newer_version, 2}}};
    std::vector<int> shares;
    for (const Kind& kind : kKinds) shares.push_back(kind.share);
    const Kind& kind =
        kKinds[static_cast<std::size_t>(std::discrete_distribution<int>(shares.begin(), shares.end())(random_))];
    did += std::string(did.empty() ? "" : ", ") + kind.name;
    (this->*kind.op)();
  }

  /// In the evening, by the newest program.
  void find_everything() {
    windows_.clear();
    std::vector<fs::path> newer;
    for (const auto& each : fs::recursive_directory_iterator(folder_.path))
      if (each.is_regular_file() && each.path().filename().string().find(".json") != std::string::npos)
        newer.push_back(each.path());
    for (const fs::path& file : newer) set_version(file, "99", "6");
    std::map<std::pair<fs::path, std::size_t>, std::pair<std::set<std::string>, std::set<std::string>>> seen;
    for (const Surface& surface : surfaces_)
      for (std::size_t person = 0; person < kPeople; ++person) {
        WorkWindow window(surface.file, state(person), surface.scan);
        auto& [own, all] = seen[{surface.file, person}];
        own = window.texts();
        window.take_over();
        all = window.texts();
      }
    for (const auto& [text, owed] : owed_)
      for (const Surface& surface : surfaces_) {
        if (surface.scan != owed.scan) continue;
        const auto& [own, all] = seen[{surface.file, owed.person}];
        const bool same = file_checksum(surface.file).value() == owed.content;
        EXPECT_TRUE((same ? own : all).contains(text))
            << text << " is not found by person " << owed.person << " on " << surface.file
            << (same ? ", which it was made on" : ", of the same scan");
        ++looked;
      }
  }

  std::size_t owed() const { return owed_.size(); }
  std::string did;
  int looked = 0;

 private:
  std::size_t pick(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  bool by_chance(double share) { return std::bernoulli_distribution(share)(random_); }
  fs::path state(std::size_t person) const { return folder_.path / fmt::format("state{}", person) / "sessions"; }

  void make(const fs::path& file, const std::string& scan) {
    std::ofstream(file) << "surface " << ++made_;
    for (const Surface& surface : surfaces_)
      if (surface.file == file) return;
    surfaces_.push_back({file, scan});
  }
  static fs::path beside(const fs::path& file) { return file.string() + ".dubsar.json"; }
  static void set_version(const fs::path& file, const std::string& from, const std::string& to) {
    std::string text = read_text_file(file).value();
    const std::string words = "\"version\": " + from;
    const std::size_t at = text.find(words);
    if (at != std::string::npos) std::ofstream(file) << text.replace(at, words.size(), "\"version\": " + to);
  }
  Window* any_window() { return windows_.empty() ? nullptr : &windows_[pick(windows_.size())]; }
  void forget(std::size_t at) { windows_.erase(windows_.begin() + static_cast<std::ptrdiff_t>(at)); }

  void shown_as_kept(const Window& window) {
    for (const std::string& text : window.work.texts())
      if (!gone_.contains(text)) owed_[text] = {window.work.session->source().content, window.scan, window.person};
  }
  void take_away(const std::string& text) {
    gone_.insert(text);
    owed_.erase(text);
  }

  void open() {
    if (windows_.size() == 4) return;
    const Surface& surface = surfaces_[pick(surfaces_.size())];
    const std::size_t person = by_chance(0.8) ? 0 : 1;
    windows_.push_back({WorkWindow(surface.file, state(person), surface.scan), surface.scan, person});
    if (by_chance(0.3)) windows_.back().work.take_over();
  }
  void new_note(WorkWindow& window) {
    ++made_;
    window.note(fmt::format("note {}", made_), 0.5 * made_);
  }
  void edit() {
    Window* const window = any_window();
    if (window == nullptr) return open();
    std::vector<Note>& notes = window->work.document.notes;
    if (notes.empty() || by_chance(0.6)) return new_note(window->work);
    Note& note = notes[pick(notes.size())];
    take_away(note.text);
    if (by_chance(0.5))
      note.text = fmt::format("note {}", ++made_);
    else
      window->work.erase(std::string(note.text));
  }
  void autosave() {
    Window* const window = any_window();
    if (window != nullptr && window->work.keep()) shown_as_kept(*window);
  }
  void end() {
    if (windows_.empty()) return;
    const std::size_t at = pick(windows_.size());
    if (windows_[at].work.leave()) shown_as_kept(windows_[at]);
    forget(at);
  }
  void kill() {
    if (windows_.empty()) return;
    const std::size_t at = pick(windows_.size());
    if (by_chance(0.5))
      static_cast<void>(
          windows_[at].work.session->keep(windows_[at].work.now += 6'000'000'000, windows_[at].work.document));
    forget(at);
  }
  void full_disk() {
    Window* const window = any_window();
    if (window == nullptr) return;
    const FullDisk full;
    const bool said = by_chance(0.5) ? window->work.keep() : window->work.leave();
    if (said) shown_as_kept(*window);
  }
  void process_anew() {
    const Surface surface = surfaces_[pick(surfaces_.size())];
    make(by_chance(0.7) ? surface.file : folder_.tablet(fmt::format("anew{}.exa", ++made_)), surface.scan);
  }
  void rename() {
    Surface& surface = surfaces_[pick(surfaces_.size())];
    const fs::path next = surface.file.parent_path() / fmt::format("renamed{}.exa", ++made_);
    fs::rename(surface.file, next);
    if (by_chance(0.4) && fs::exists(beside(surface.file))) fs::rename(beside(surface.file), beside(next));
    surface.file = next;
  }
  void copy() {
    const Surface surface = surfaces_[pick(surfaces_.size())];
    const fs::path folder = folder_.path / fmt::format("copy{}", ++made_);
    fs::create_directories(folder);
    const fs::path next = folder / surface.file.filename();
    fs::copy_file(surface.file, next);
    if (by_chance(0.4) && fs::exists(beside(surface.file))) fs::copy_file(beside(surface.file), beside(next));
    surfaces_.push_back({next, surface.scan});
  }
  void newer_version() {
    std::vector<fs::path> files;
    for (const auto& each : fs::recursive_directory_iterator(folder_.path))
      if (each.is_regular_file() && each.path().extension() == ".json") files.push_back(each.path());
    std::sort(files.begin(), files.end());
    if (!files.empty()) set_version(files[pick(files.size())], "6", "99");
  }

  std::mt19937 random_;
  WorkFolder folder_;
  std::vector<Surface> surfaces_;
  std::vector<Window> windows_;
  std::map<std::string, Owed> owed_;
  std::set<std::string> gone_;  ///< that a person changed or took away
  int made_ = 0;
};

TEST(Interleavings, EveryNoteThatWasShownAsKeptIsFoundAgainAfterFiveHundredAfternoons) {
  const unsigned first = std::random_device()();
  std::size_t owed = 0;
  for (unsigned i = 0; i < kSequences && !::testing::Test::HasFailure(); ++i) {
    Afternoon afternoon(first + i);
    const int length = 8 + static_cast<int>((first + i) % 25);
    for (int step = 0; step < length; ++step) afternoon.go_on();
    SCOPED_TRACE(fmt::format("seed {}: {}", first + i, afternoon.did));
    afternoon.find_everything();
    owed += afternoon.owed();
  }
  EXPECT_GE(owed, 500u) << "notes that were owed";
  RecordProperty("notes", static_cast<int>(owed));
}

}  // namespace
}  // namespace dubsar::app
