#pragma once
// Options of a source, "key=value" or a bare word: each is taken once, what is left over is refused by name.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/pose.h"
#include "core/base/result.h"
#include "input/input_source.h"

namespace dubsar {

class OptionReader {
 public:
  OptionReader(const InputConfig& config, std::string source) : left_(config.options), source_(std::move(source)) {}

  /// A bare word that stands first, such as a tracker's name; empty when there is none.
  std::string first_word();
  bool flag(std::string_view name);
  std::string text(std::string_view name, std::string_view fallback = {});
  double number(std::string_view name, double low, double high, double fallback);
  int integer(std::string_view name, int low, int high, int fallback);
  /// "X/Y/Z"
  glm::dvec3 triple(std::string_view name, double limit, const glm::dvec3& fallback);
  /// at=X/Y/Z and turn=X/Y/Z (input/placement.h).
  Pose placement(const Pose& fallback);

  /// kUsage: the first thing wrong, or an option that nobody took, with those there are.
  Result<void> finish();

 private:
  const std::string* find(std::string_view name);
  void complain(std::string sentence);
  std::vector<std::pair<std::string, std::string>> left_;
  std::string source_, known_, complaint_;
  std::string found_;
};

}  // namespace dubsar
