#pragma once
// What a kiosk writes down: states, counts and errors, one JSON object a line, a file a day. Nothing about persons.

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar::app {

/// One thread. Lines are appended and reach the disk as whole lines; a journal that cannot be written is said once in
/// the log, and is tried again with each line.
class Journal {
 public:
  /// `folder` is made when it is missing; empty: nothing is written.
  explicit Journal(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `what` is one of the states of docs/kiosk.md. `figures` is the inside of a JSON object, such as "\"visits\": 3".
  /// `unix_s` is the time of the wall, seconds since 1970.
  Result<void> add(std::int64_t unix_s, std::string_view what, std::string_view figures = {});

  /// One of the figures, with a text of any letters: "\"NAME\": \"WORDS\"".
  static std::string words(std::string_view name, std::string_view words);

  /// Visits of a day that were written down already; 0 where its file cannot be read.
  std::int64_t visits(std::int64_t unix_s) const;

  /// The file of a day, by the local calendar.
  std::filesystem::path file(std::int64_t unix_s) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace dubsar::app
