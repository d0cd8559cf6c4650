#pragma once
// How far work beside the window is, as values: a file that is being read, an export, a search for wedges.

#include <optional>
#include <string>

namespace dubsar::app {

struct JobState {
  std::string name;                     ///< of the work; of a file without its folder
  double share = 0.0;                   ///< 0..1
  std::optional<double> remaining_s{};  ///< none: it is too early to say, or its stages were not planned
  friend bool operator==(const JobState&, const JobState&) = default;
};

}  // namespace dubsar::app
