#include "core/volume/axis_order.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace dubsar {
namespace {

constexpr std::string_view kLetters = "xyz";

struct Label {
  int axis = -1;  ///< 0 x, 1 y, 2 z, -1 another one
  bool backwards = false;
};

/// "z", "-Z", "sample_z", "y (mm)": the one word of a single letter x, y or z.
Label read_label(const std::string& text) {
  Label label;
  std::string word;
  int found = 0;
  bool minus = false;
  const auto close = [&] {
    if (word.size() == 1 && kLetters.find(word[0]) != std::string_view::npos) {
      label = {static_cast<int>(kLetters.find(word[0])), minus};
      ++found;
    }
    if (!word.empty()) minus = false;
    word.clear();
  };
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else {
      close();
      minus = c == '-';
    }
  }
  close();
  return found == 1 ? label : Label{};
}

/// "zyx", "z-yx", "tczyx": one letter an axis; empty when it is something else.
std::vector<Label> read_letters(std::string_view text) {
  constexpr std::string_view kAxisLetters = "xyztcs";
  std::vector<Label> labels;
  bool minus = false;
  for (const char c : text) {
    const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (c == '-' && !minus) {
      minus = true;
    } else if (kAxisLetters.find(letter) != std::string_view::npos) {
      const auto at = kLetters.find(letter);
      labels.push_back({at == std::string_view::npos ? -1 : static_cast<int>(at), minus});
      minus = false;
    } else {
      return {};
    }
  }
  return minus ? std::vector<Label>{} : labels;
}

std::vector<Label> read_labels(std::span<const std::string> texts) {
  std::vector<Label> labels;
  if (texts.size() != 1) {
    for (const std::string& text : texts) labels.push_back(read_label(text));
    return labels;
  }
  labels = read_letters(texts.front());
  if (!labels.empty()) return labels;
  std::string part;
  const auto close = [&] {
    if (part.find_first_not_of(" \t\n") != std::string::npos) labels.push_back(read_label(part));
    part.clear();
  };
  const bool separated = texts.front().find_first_of(",:;|/") != std::string::npos;
  for (const char c : texts.front()) {
    if (separated ? std::string_view(",:;|/").find(c) != std::string_view::npos : c == ' ')
      close();
    else if (std::string_view("[](){}\"'").find(c) == std::string_view::npos)
      part += c;
  }
  close();
  return labels;
}

int permutation_sign(const std::array<int, 3>& p) { return (p[1] - p[0]) * (p[2] - p[0]) * (p[2] - p[1]) > 0 ? 1 : -1; }

}  // namespace

bool AxisOrder::usual() const noexcept {
  return stored == std::array{0, 1, 2} && backwards == std::array{false, false, false};
}

bool AxisOrder::mirrored_as_stored() const noexcept {
  const auto flips = std::count(backwards.begin(), backwards.end(), true);
  return (permutation_sign(stored) < 0) != (flips % 2 != 0);
}

std::string AxisOrder::letters() const {
  std::string text;
  for (int at = 2; at >= 0; --at)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (stored[axis] == at) text += std::string(backwards[axis] ? "-" : "") + kLetters[axis];
  return text;
}

std::string describe(const AxisOrder& order) {
  if (!order.known()) return "zyx taken, slowest first: the file does not say, a mirror image could not be told";
  return fmt::format("{}, slowest first ({}){}", order.letters(), order.provenance,
                     order.mirrored_as_stored() ? ": turned, or the surface would be a mirror image"
                     : order.usual()            ? ""
                                                : ": turned to zyx");
}

std::optional<AxisOrder> parse_axis_labels(std::span<const std::string> texts, std::span<const std::size_t> used) {
  const std::vector<Label> labels = read_labels(texts);
  AxisOrder order;
  std::array<bool, 3> seen{};
  if (used.size() != 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t at = labels.size() == 3 ? i : used[i];
    if (at >= labels.size() || labels[at].axis < 0) return std::nullopt;
    const auto axis = static_cast<std::size_t>(labels[at].axis);
    if (seen[axis]) return std::nullopt;
    seen[axis] = true;
    order.stored[axis] = static_cast<int>(2 - i);
    order.backwards[axis] = labels[at].backwards;
  }
  return order;
}

Result<AxisOrder> parse_axis_order(std::string_view text) {
  const std::string label(text);
  constexpr std::array<std::size_t, 3> kAll{0, 1, 2};
  auto order = read_labels({&label, 1}).size() == 3 ? parse_axis_labels({&label, 1}, kAll) : std::nullopt;
  if (!order)
    return fail(ErrorKind::kUsage,
                "axis order \"{}\" not understood, expected x, y and z once each, slowest stored axis first, such as "
                "zyx or xyz; a minus stands before an axis that is stored backwards: z,-y,x",
                text);
  return *std::move(order);
}

std::optional<AxisOrder> axis_order_of(const std::array<glm::dvec3, 3>& directions, bool left_handed_space) {
  std::array<glm::dvec3, 3> unit = directions;
  for (glm::dvec3& direction : unit) {
    const double length = glm::length(direction);
    if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
    direction /= length;
    if (left_handed_space) direction.x = -direction.x;
  }
  const double volume = glm::dot(unit[0], glm::cross(unit[1], unit[2]));
  if (!(std::abs(volume) > 1e-3)) return std::nullopt;
  std::optional<AxisOrder> best;
  double best_fit = 0.0;
  std::array<int, 3> p{0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      AxisOrder order;
      order.stored = p;
      double fit = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        order.backwards[axis] = (flips >> axis & 1) != 0;
        const double along = unit[static_cast<std::size_t>(p[axis])][static_cast<int>(axis)];
        fit += order.backwards[axis] ? -along : along;
      }
      if (order.mirrored_as_stored() != (volume < 0.0) || (best && !(fit > best_fit))) continue;
      best = order;
      best_fit = fit;
    }
  } while (std::next_permutation(p.begin(), p.end()));
  return best;
}

}  // namespace dubsar
