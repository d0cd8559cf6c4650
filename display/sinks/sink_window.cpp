#include "display/sinks/sink_window.h"

#include <fmt/format.h>

namespace dubsar {

Result<SinkWindow> open_sink_window(std::string_view display, WindowOptions options,
                                    const std::filesystem::path& profile_folder, std::string_view fallback,
                                    std::span<const std::shared_ptr<SinkPlugin>> plugins) {
  SinkWindow out;
  DUBSAR_ASSIGN(auto sink, make_sink(display, profile_folder, plugins));
  const SinkTraits wanted = sink->traits();
  if (wanted.exact_pixels) options.decorated = false;
  options.stereo = wanted.stereo_visual;
  auto window = GlfwWindow::create(options);
  if (!window && wanted.stereo_visual && window.error().kind == ErrorKind::kUnavailable) {
    const std::string reason = window.error().message;
    options.stereo = false;
    DUBSAR_ASSIGN(sink, make_sink(fallback, profile_folder));
    window = GlfwWindow::create(options);
    out.note = fmt::format("display {} cannot be had here ({}); {} is shown instead", display, reason, fallback);
  }
  if (!window) return tl::unexpected<Error>(window.error());
  out.window = *std::move(window);
  out.sink = std::move(sink);
  const Screen screen = out.window->screen();
  DUBSAR_TRY(out.sink->configure(screen));
  const SinkTraits traits = out.sink->traits();
  if (out.note.empty() && (traits.output.width != screen.window_w || traits.output.height != screen.window_h))
    out.note = fmt::format(
        "display {} makes a picture of {} x {} pixels and the window has {} x {}: it will not look right; "
        "use the panel's own monitor, full screen",
        display, traits.output.width, traits.output.height, screen.window_w, screen.window_h);
  return out;
}

}  // namespace dubsar
