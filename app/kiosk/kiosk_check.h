#pragma once
// All that is wrong with a kiosk's profile, its words and its tours, at once, each in one sentence with its place.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/kiosk/kiosk_profile.h"
#include "app/kiosk/tour.h"
#include "app/kiosk/words.h"

namespace dubsar::app {

/// One that was read, mended where it can be guessed what was meant.
struct CheckedFile;

class KioskCheck {
 public:
  /// Reads the profile and what it names; nothing is opened but text.
  explicit KioskCheck(const std::filesystem::path& profile);
  ~KioskCheck();

  const KioskProfile& profile() const noexcept { return profile_; }
  const Words& words() const noexcept { return words_; }
  /// Of each object; without steps: none of its own, or none that can be read.
  const std::vector<Tour>& tours() const noexcept { return tours_; }

  /// What is said on the screen, and where that stands.
  struct Said {
    std::size_t file = 0;
    std::string place, text;
    bool title = false;
  };
  std::vector<Said> said() const;

  /// Adds a fault at a place as of JsonPlaces, of file 0, the profile, or of another one of said().
  void add(const std::string& place, std::string what, ErrorKind kind = ErrorKind::kConfig, std::size_t file = 0);
  /// The file of an object's tour.
  std::size_t tour_file(std::size_t object) const { return tour_files_[object]; }

  /// "kiosk.json, line 6, column 3: ...", in the order of the files.
  std::vector<std::string> sentences() const;
  /// Of the worst: kConfig, kNoInput, kBadData, kUnavailable; meaningless without faults.
  ErrorKind kind() const;

 private:
  struct Fault {
    std::size_t file = 0, at = 0;  // byte of the file
    std::string what;
    ErrorKind kind{};
  };
  /// Its index; what is wrong with its JSON is added.
  std::size_t open(const std::filesystem::path& path, ErrorKind kind);
  void look_at_objects();
  void look_at_languages();
  void look_at_texts(const Texts& texts, const std::string& place, std::size_t file);
  void read_words(const std::filesystem::path& path);
  Tour read_tour_of(std::size_t object);
  bool there(const std::filesystem::path& path, const std::string& place, std::string_view what);

  std::vector<std::unique_ptr<CheckedFile>> files_;
  std::vector<Fault> faults_;
  KioskProfile profile_;
  Words words_;
  std::vector<Tour> tours_;
  std::vector<std::size_t> tour_files_;
};

}  // namespace dubsar::app
