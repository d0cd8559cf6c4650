// Commands for slices of the scan: where they are laid, how near, how grey.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr Text kSlicesGroup = "group.slices";
constexpr std::array<std::string_view, 5> kLarge{"all", "x", "y", "z", "free"};
constexpr double kLeastZoom = 0.2, kMostZoom = 200.0, kNearer = 1.25, kTurnDeg = 5.0;

void change(Editor& editor, const ScanView& scan, std::string_view words) {
  Document next = editor.document();
  next.scan = scan;
  editor.change(std::move(next), words);
}

void open_drawer(Editor& editor) {
  editor.ui().drawer = "slices";
  editor.ui().panels = true;
}

/// What a command does to how slices lie.
Command on_scan(std::string name, Text argument, std::vector<DefaultKey> keys,
                std::function<Result<void>(Editor&, ScanView&, const std::string&)> act) {
  Command out{std::move(name), kSlicesGroup, std::move(keys), argument};
  out.run = [act = std::move(act), why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    ScanView next = editor.document().scan;
    DUBSAR_TRY(act(editor, next, text));
    change(editor, next, why);
    return {};
  };
  return out;
}

Result<glm::dvec3> place(std::string_view command, const std::string& text) {
  std::string rest;
  DUBSAR_ASSIGN(const auto points, points_argument(command, text, 1, rest));
  return points[0];
}

/// The normal of slice x, y, z or free, towards whoever looks at its picture.
Result<glm::dvec3> normal_of(std::string_view command, const std::string& name, const ScanView& scan) {
  if (name == "x") return glm::dvec3(1, 0, 0);
  if (name == "y") return glm::dvec3(0, -1, 0);
  if (name == "z") return glm::dvec3(0, 0, 1);
  if (name == "free") return glm::cross(scan.free_right, scan.free_up);
  return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected x, y, z or free", command, name);
}

void zoom_by(ScanView& scan, double factor) {
  const double zoom = std::clamp(scan.zoom * factor, kLeastZoom, kMostZoom);
  scan.centre_mm = scan.cursor_mm + (scan.centre_mm - scan.cursor_mm) * (scan.zoom / zoom);
  scan.zoom = zoom;
}

/// Lays the slices through a place of the surface, the free one upright on it, and opens them.
void slice_through(Editor& editor, const SurfacePin& pin) {
  ScanView next = editor.document().scan;
  next.cursor_mm = next.centre_mm = pin.at_mm;
  next.free_up = glm::normalize(pin.normal);
  const glm::dmat3 seen = editor.place().seen_axes();
  for (const glm::dvec3& axis : {seen[0], seen[1]}) {  // along the picture's rows, where these do not stand on end
    const glm::dvec3 along = axis - glm::dot(axis, next.free_up) * next.free_up;
    if (glm::length(along) < 0.3) continue;
    next.free_right = glm::normalize(along);
    break;
  }
  change(editor, next, "slice through a place");
  open_drawer(editor);
}

Command slice_here() {
  Command out{"slice_here", kSlicesGroup, {{"b"}}};
  out.argument = "arg.place";
  out.optional = true;
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    glm::dvec3 at(0.0);
    if (!text.empty()) {
      DUBSAR_ASSIGN(at, place("slice_here", text));
    }
    DUBSAR_ASSIGN(const SurfacePin pin, text.empty() ? editor.place().pin_seen() : editor.place().pin(at));
    slice_through(editor, pin);
    return {};
  };
  return out;
}

Command slice_step() {
  Command out = on_scan("slice_step", "arg.slice_step", {{".", "free 0.1"}, {",", "free -0.1"}},
                        [](Editor&, ScanView& scan, const std::string& text) -> Result<void> {
                          const auto [name, rest] = first_word(text);
                          DUBSAR_ASSIGN(const glm::dvec3 normal, normal_of("slice_step", name, scan));
                          DUBSAR_ASSIGN(const double step, number_argument("slice_step", rest, -1e4, 1e4));
                          scan.cursor_mm += step * normal;
                          return {};
                        });
  out.values = {"free 0.1", "free -0.1", "z 1"};
  out.repeats = true;
  return out;
}

Command slice_turn(std::string name, double sign, std::string key) {
  Command out = on_scan(std::move(name), "arg.degrees", {{std::move(key)}},
                        [sign](Editor&, ScanView& scan, const std::string& text) -> Result<void> {
                          double degrees = kTurnDeg;
                          if (!text.empty()) {
                            DUBSAR_ASSIGN(degrees, number_argument("slice_turn", text, -360.0, 360.0));
                          }
                          const double half = 0.5 * sign * degrees * std::numbers::pi / 180.0;
                          const glm::dquat turn(std::cos(half), std::sin(half) * scan.free_up);
                          scan.free_right = turn * scan.free_right;
                          scan.free_right =
                              glm::normalize(scan.free_right - glm::dot(scan.free_right, scan.free_up) * scan.free_up);
                          return {};
                        });
  out.optional = out.repeats = true;
  return out;
}

Command slice_grey() {
  Command out =
      on_scan("slice_grey", "arg.slice_grey", {}, [](Editor&, ScanView& scan, const std::string& text) -> Result<void> {
        if (text == "auto") {
          scan.black = scan.white = 0.0;
          return {};
        }
        const auto [black, white] = first_word(text);
        DUBSAR_ASSIGN(scan.black, number_argument("slice_grey", black, -1e6, 1e6));
        DUBSAR_ASSIGN(scan.white, number_argument("slice_grey", white, -1e6, 1e6));
        if (scan.black == scan.white)
          return fail(ErrorKind::kUsage, "slice_grey: {} twice found, expected two values or auto", black);
        return {};
      });
  out.values = {"auto"};
  return out;
}

Command slice_large() {
  Command out =
      on_scan("slice_large", "arg.which", {}, [](Editor&, ScanView& scan, const std::string& name) -> Result<void> {
        const auto at = std::find(kLarge.begin(), kLarge.end(), name) - kLarge.begin();
        scan.large = scan.large == at ? 0 : static_cast<int>(at);
        return {};
      });
  out.values.assign(kLarge.begin(), kLarge.end());
  out.closed = true;
  return out;
}

Command write_slice() {
  Command out{"write_slice", kSlicesGroup, {}};
  out.argument = "arg.slice_file";
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t space = text.rfind(' ');
    const auto which =
        std::find(kLarge.begin() + 1, kLarge.end(), space == std::string::npos ? "" : text.substr(space + 1));
    if (which == kLarge.end()) return editor.place().write_slice(text, 3);
    return editor.place().write_slice(text.substr(0, space), static_cast<std::size_t>(which - kLarge.begin()) - 1);
  };
  return out;
}

}  // namespace

Result<void> use_slice(Editor& editor, const std::vector<SurfacePin>& pins) {
  slice_through(editor, pins.front());
  return {};
}

std::vector<Command> slice_commands() {
  std::vector<Command> out;
  out.push_back(slice_here());
  out.push_back(
      on_scan("slice_at", "arg.place", {}, [](Editor&, ScanView& scan, const std::string& text) -> Result<void> {
        DUBSAR_ASSIGN(scan.cursor_mm, place("slice_at", text));
        return {};
      }));
  out.push_back(slice_step());
  out.push_back(slice_turn("slice_turn", 1.0, "alt+left"));
  out.push_back(slice_turn("slice_turn_back", -1.0, "alt+right"));
  out.push_back(
      on_scan("slice_nearer", {}, {{"alt+up"}}, [](Editor&, ScanView& scan, const std::string&) -> Result<void> {
        zoom_by(scan, kNearer);
        return {};
      }));
  out.back().repeats = true;
  out.push_back(
      on_scan("slice_farther", {}, {{"alt+down"}}, [](Editor&, ScanView& scan, const std::string&) -> Result<void> {
        zoom_by(scan, 1.0 / kNearer);
        return {};
      }));
  out.back().repeats = true;
  out.push_back(on_scan(
      "slice_zoom", "arg.zoom_percent", {}, [](Editor&, ScanView& scan, const std::string& text) -> Result<void> {
        DUBSAR_ASSIGN(const double percent, number_argument("slice_zoom", text, 100 * kLeastZoom, 100 * kMostZoom));
        zoom_by(scan, 0.01 * percent / scan.zoom);
        return {};
      }));
  out.back().values = {"100", "400"};
  out.push_back(
      on_scan("slice_centre", "arg.place", {}, [](Editor&, ScanView& scan, const std::string& text) -> Result<void> {
        DUBSAR_ASSIGN(scan.centre_mm, place("slice_centre", text));
        return {};
      }));
  out.push_back(slice_grey());
  out.push_back(slice_large());
  out.push_back(on_scan("next_slice", {}, {{"alt+s"}}, [](Editor&, ScanView& scan, const std::string&) -> Result<void> {
    scan.large = (scan.large + 1) % static_cast<int>(kLarge.size());
    return {};
  }));
  out.push_back(write_slice());
  return out;
}

}  // namespace dubsar::app
