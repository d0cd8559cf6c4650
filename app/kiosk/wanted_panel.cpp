#include "app/kiosk/wanted_panel.h"

#include <algorithm>

#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kLookEveryNs = 2 * kSecondNs;

bool is_called(const Monitor& monitor, const std::string& wanted) {
  return monitor.name.find(wanted) != std::string::npos;
}

bool has_pixels(const Monitor& monitor, const PixelSize& pixels) {
  return monitor.width_px == pixels.width && monitor.height_px == pixels.height;
}

}  // namespace

PanelChoice choose_panel(std::span<const Monitor> monitors, const std::string& wanted, const SinkTraits& display) {
  PanelChoice out;
  const Monitor* place = nullptr;
  std::string names;
  const auto rank = [&](const Monitor& one) {
    return 2 * static_cast<int>(display.own_pixels && has_pixels(one, display.output)) + static_cast<int>(one.primary);
  };
  for (const Monitor& one : monitors) {
    names += (names.empty() ? "" : ", ") + one.name;
    if (is_called(one, wanted) && (place == nullptr || rank(one) > rank(*place))) place = &one;
  }
  if (place != nullptr) {
    out.monitor = place->name;
  } else {
    out.trouble = fmt::format("no monitor's name contains \"{}\", there {}; it is looked for every 2 s", wanted,
                              names.empty() ? "is none" : "are: " + names);
    for (const Monitor& one : monitors)
      if (place == nullptr || one.primary) place = &one;
  }
  if (place == nullptr || !display.own_pixels || has_pixels(*place, display.output)) return out;
  out.flat = true;
  out.trouble +=
      fmt::format("{}display {} makes pictures of {} x {} pixels and monitor \"{}\" has {} x {}: this one is flat",
                  out.trouble.empty() ? "" : "; ", display.name, display.output.width, display.output.height,
                  place->name, place->width_px, place->height_px);
  return out;
}

std::vector<Monitor> MonitorWatch::of_matter(const std::vector<Monitor>& all) const {
  std::vector<Monitor> out;
  for (const Monitor& one : all)
    if (is_called(one, wanted_)) out.push_back(one);
  return out.empty() ? all : out;
}

Result<std::vector<Monitor>> MonitorWatch::look() {
  DUBSAR_ASSIGN(auto all, list_());
  seen_ = of_matter(all);
  changed_ = none_ = false;
  return all;
}

bool MonitorWatch::changed(TimestampNs now) {
  if (changed_ || (looked_ >= 0 && now - looked_ < kLookEveryNs)) return changed_;
  looked_ = now;
  const auto all = list_();
  if (!all || all->empty()) {
    none_ = none_ || all;
    return false;
  }
  const std::vector<Monitor> matter = of_matter(*all);
  changed_ = none_ || !std::equal(matter.begin(), matter.end(), seen_.begin(), seen_.end(),
                                  [](const Monitor& a, const Monitor& b) {
                                    return a.name == b.name && a.width_px == b.width_px && a.height_px == b.height_px;
                                  });
  return changed_;
}

}  // namespace dubsar::app
