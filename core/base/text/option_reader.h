#pragma once
// Takes options by name: each is taken once, what is left over is refused by name.

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/numbers/pose.h"
#include "core/base/result.h"
#include "core/base/text/option_list.h"

namespace dubsar {

class OptionReader {
 public:
  /// `whose` begins every complaint: "input leap".
  OptionReader(std::vector<Option> options, std::string whose) : left_(std::move(options)), whose_(std::move(whose)) {}

  /// A bare word that stands first, such as a tracker's name; empty when there is none.
  std::string first_word();
  bool flag(std::string_view name);
  std::string text(std::string_view name, std::string_view fallback = {});
  double number(std::string_view name, double low, double high, double fallback);
  int integer(std::string_view name, int low, int high, int fallback);
  /// "X/Y/Z"
  glm::dvec3 triple(std::string_view name, double limit, const glm::dvec3& fallback);
  /// Where a device stands before the screen: at=X/Y/Z millimetres from the panel's centre, at most 10 m; turn=X/Y/Z
  /// degrees, about z first, then x, then y, all axes of the screen frame.
  Pose placement(const Pose& fallback);
  /// A sentence about what was taken, from those who know more of it.
  void complain(std::string sentence);

  /// What nobody has taken so far, for those who hand it on.
  std::vector<Option> take_rest();

  /// kUsage: the first thing wrong so far.
  Result<void> status() const;
  /// kUsage: the first thing wrong, or an option that nobody took, with those there are.
  Result<void> finish();

 private:
  const Option* find(std::string_view name);
  std::vector<Option> left_;
  std::string whose_, known_, complaint_;
  Option found_;
};

}  // namespace dubsar
