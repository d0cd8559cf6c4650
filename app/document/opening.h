#pragma once
// How far a file is that is being read, as values.

#include <optional>
#include <string>

namespace dubsar::app {

struct Opening {
  std::string name;                   ///< of the file, without its folder
  double share = 0.0;                 ///< 0..1
  std::optional<double> remaining_s;  ///< none: it is too early to say
  friend bool operator==(const Opening&, const Opening&) = default;
};

}  // namespace dubsar::app
