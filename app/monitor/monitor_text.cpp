#include "app/monitor/monitor_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr int kHalf = 20;  // columns on each side of zero

/// "x     [          |####      ]  +0.20": `value` of -full..full.
std::string bar(std::string_view name, double value, double full, std::string_view unit) {
  const int length = static_cast<int>(std::lround(kHalf * std::clamp(std::abs(value) / full, 0.0, 1.0)));
  std::string left(kHalf, ' '), right(kHalf, ' ');
  if (value < 0)
    std::fill_n(left.rbegin(), length, '#');
  else
    std::fill_n(right.begin(), length, '#');
  return fmt::format("{:<8}[{}|{}] {:+8.3f} {}\n", name, left, right, value, unit);
}

std::string bars(const json& values, std::array<std::string_view, 3> names, double full, std::string_view unit) {
  std::string out;
  for (std::size_t i = 0; i < 3; ++i) out += bar(names[i], values.at(i).get<double>(), full, unit);
  return out;
}

/// Yaw to the left, pitch up and roll counter-clockwise of R_y R_x R_z, degrees.
std::array<double, 3> turns_deg(const json& q) {
  const double w = q.at(0), x = q.at(1), y = q.at(2), z = q.at(3);
  constexpr double kDeg = 180.0 / std::numbers::pi;
  return {kDeg * std::atan2(2.0 * (x * z + w * y), 1.0 - 2.0 * (x * x + y * y)),
          kDeg * std::asin(std::clamp(2.0 * (w * x - y * z), -1.0, 1.0)),
          kDeg * std::atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z))};
}

std::string hand_line(const json& hand) {
  const json& palm = hand.at("palm_m");
  const double grab = std::clamp(hand.at("grab").get<double>(), 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(std::lround(10.0 * grab));
  return fmt::format("{:<7} #{:<5} x {:+5.0f}  y {:+5.0f}  z {:+5.0f} mm   grab [{}{}]\n",
                     hand.at("side").get<std::string>(), hand.at("id").get<std::uint32_t>(),
                     1e3 * palm.at(0).get<double>(), 1e3 * palm.at(1).get<double>(), 1e3 * palm.at(2).get<double>(),
                     std::string(filled, '#'), std::string(10 - filled, ' '));
}

}  // namespace

std::string monitor_text(const json& sample) {
  std::string out;
  if (sample.contains("translation")) {
    out += bars(sample["translation"], {"right", "up", "to you"}, 1.0, "");
    out += bars(sample["rotation"], {"about x", "about y", "about z"}, 1.0, "");
    out += fmt::format("buttons {:b}\n", sample["buttons"].get<std::uint64_t>());
  }
  if (sample.contains("position_m")) out += bars(sample["position_m"], {"x", "y", "z"}, 1.0, "m");
  if (sample.contains("rotation_wxyz")) {
    const auto turn = turns_deg(sample["rotation_wxyz"]);
    out += bar("yaw", turn[0], 90.0, "deg") + bar("pitch", turn[1], 90.0, "deg") + bar("roll", turn[2], 90.0, "deg");
  }
  if (sample.contains("hands")) {
    for (const json& hand : sample["hands"]) out += hand_line(hand);
    if (sample["hands"].empty()) out += "no hand\n";
  }
  if (sample.contains("touches")) {
    for (const json& touch : sample["touches"])
      out += fmt::format("finger #{:<5} {:5.1f} % to the right, {:5.1f} % down\n", touch.at("id").get<std::uint32_t>(),
                         100.0 * touch.at("at").at(0).get<double>(), 100.0 * touch.at("at").at(1).get<double>());
    if (sample["touches"].empty()) out += "no finger\n";
  }
  if (sample.contains("age_ms")) out += fmt::format("age     {:.2f} ms\n", sample["age_ms"].get<double>());
  return out;
}

}  // namespace dubsar::app
