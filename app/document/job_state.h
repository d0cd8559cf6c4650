#pragma once
// How far work beside the window is, as values.

#include <string>

namespace dubsar::app {

struct JobState {
  std::string name;
  double fraction = 0.0;  ///< 0..1
  friend bool operator==(const JobState&, const JobState&) = default;
};

}  // namespace dubsar::app
