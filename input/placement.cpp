#include "input/placement.h"

#include <array>
#include <charconv>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace dubsar {
namespace {

constexpr double kFarthest = 10'000.0;  // mm, and more than any angle

Result<glm::dvec3> three_numbers(std::string_view key, std::string_view value) {
  std::array<double, 3> numbers{};
  const char* at = value.data();
  const char* const end = value.data() + value.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [stop, error] = std::from_chars(at, end, numbers[i]);
    const bool separated = i < 2 ? stop != end && *stop == '/' : stop == end;
    if (error != std::errc{} || !separated || !(std::abs(numbers[i]) <= kFarthest))
      return fail(ErrorKind::kUsage, "input: {}={} found, expected {}=X/Y/Z, three numbers within {:.0f}", key, value,
                  key, kFarthest);
    at = stop + (i < 2 ? 1 : 0);
  }
  return glm::dvec3(numbers[0], numbers[1], numbers[2]);
}

}  // namespace

Result<bool> read_placement(std::string_view key, std::string_view value, Pose& screen_from_device) {
  if (key != "at" && key != "turn") return false;
  DUBSAR_ASSIGN(const glm::dvec3 numbers, three_numbers(key, value));
  if (key == "at") {
    screen_from_device.position_m = 0.001 * numbers;
  } else {
    const glm::dvec3 turn = glm::radians(numbers);
    screen_from_device.rotation = glm::angleAxis(turn.y, glm::dvec3(0, 1, 0)) *
                                  glm::angleAxis(turn.x, glm::dvec3(1, 0, 0)) *
                                  glm::angleAxis(turn.z, glm::dvec3(0, 0, 1));
  }
  return true;
}

Pose table_placement() { return {{0.0, -0.2, 0.15}, {1.0, 0.0, 0.0, 0.0}}; }

}  // namespace dubsar
