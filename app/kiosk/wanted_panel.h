#pragma once
// The monitor that a kiosk's profile names, which may be away or another one than its display is made for.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "display/render/context/context_glfw.h"
#include "display/sinks/output_sink.h"

namespace dubsar::app {

struct PanelChoice {
  std::string monitor{};  ///< whose name contains this; empty: the primary one
  bool flat = false;      ///< the display would not look right there
  std::string trouble{};  ///< what is not as it was wanted, in one sentence; empty: all is
};

/// Where a display with these traits, not configured yet, covers a monitor: one whose name contains `wanted` and that
/// has the display's own pixels, else any whose name does, else any at all.
PanelChoice choose_panel(std::span<const Monitor> monitors, const std::string& wanted, const SinkTraits& display);

/// Sees when monitors come and go. Main thread.
class MonitorWatch {
 public:
  using List = std::function<Result<std::vector<Monitor>>()>;
  /// `wanted` as of choose_panel: where there are such monitors, others may come and go.
  explicit MonitorWatch(std::string wanted, List list = list_monitors)
      : wanted_(std::move(wanted)), list_(std::move(list)) {}

  /// Those there are now, from which it counts what changes. Errors of list_monitors().
  Result<std::vector<Monitor>> look();
  /// Whether what matters is not as it was at look(), or is there again after there was no monitor at all. Looks every
  /// 2 s; a server that does not answer, or has none, has changed nothing yet: there is nowhere to go.
  bool changed(TimestampNs now);

 private:
  std::vector<Monitor> of_matter(const std::vector<Monitor>& all) const;
  std::string wanted_;
  List list_;
  std::vector<Monitor> seen_;
  TimestampNs looked_ = -1;
  bool changed_ = false, none_ = false;
};

}  // namespace dubsar::app
