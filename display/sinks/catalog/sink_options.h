#pragma once
// Reading a display's options: each is taken out, the first thing wrong becomes one sentence.

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "display/optics/view.h"
#include "display/panels/panel_set.h"
#include "display/sinks/catalog/sink_spec.h"

namespace dubsar {

class SinkOptions {
 public:
  /// Borrows `panels`.
  SinkOptions(SinkSpec spec, const PanelSet& panels) : spec_(std::move(spec)), panels_(&panels) {}

  /// Takes a bare word out if it is one of `choices` and returns its index; 0 when none of them is there.
  int choice(std::span<const std::string_view> choices);
  int choice(std::initializer_list<std::string_view> choices) { return choice({choices.begin(), choices.size()}); }
  /// Takes left_first or right_first out; true for the latter.
  bool eyes_swapped() { return choice({"left_first", "right_first"}) == 1; }
  /// Takes "key=NUMBER" out; `fallback` when it is not there.
  double number(std::string_view key, double least, double most, double fallback);
  int whole(std::string_view key, int least, int most, int fallback);
  /// Takes focus= (-0.5 to 0.5) and zoom= (0.1 to 10) out.
  ViewFocus focus() { return {number("focus", -0.5, 0.5, 0.0), number("zoom", 0.1, 10.0, 1.0)}; }
  /// Takes "key=TEXT" out.
  std::optional<std::string> text(std::string_view key);
  /// Takes "panel=NAME" (or the first bare word) and "calibration=FILE" out; nothing when neither is there. Ask for
  /// choices before.
  Result<std::optional<PanelProfile>> panel();

  /// kUsage with the first number that cannot be, or with an option that is left and what the display knows.
  Result<void> finish(std::string_view known);

 private:
  SinkSpec spec_;
  const PanelSet* panels_;
  std::string complaint_;
};

}  // namespace dubsar
