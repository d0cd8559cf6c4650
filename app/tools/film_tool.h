#pragma once
// The document's film while it is shown.

#include <optional>

#include "app/document/document.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

class FilmTool {
 public:
  /// From its beginning, or no longer; `from_s`: from then on, whether or not it is shown now.
  void play(std::optional<double> from_s, TimestampNs now);
  void stop() noexcept { since_ = -1; }
  bool playing() const noexcept { return since_ >= 0; }
  /// The document as the film shows it now; its end is the film's end.
  Document seen(const Document& document, TimestampNs now);

 private:
  TimestampNs since_ = -1;
  double from_s_ = 0.0;  ///< how far it was then
};

}  // namespace dubsar::app
