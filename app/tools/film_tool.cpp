#include "app/tools/film_tool.h"

namespace dubsar::app {

void FilmTool::play(std::optional<double> from_s, TimestampNs now) {
  since_ = playing() && !from_s ? -1 : now;
  from_s_ = from_s.value_or(0.0);
}

Document FilmTool::seen(const Document& document, TimestampNs now) {
  Document out = document;
  const double since = from_s_ + 1e-9 * static_cast<double>(now - since_);
  if (out.keyframes.empty() || since > film_length_s(out.keyframes)) {
    stop();
    return out;
  }
  show_keyframe(out, moment_at(document.keyframes, out.keyframes.front().time_s + since));
  return out;
}

}  // namespace dubsar::app
