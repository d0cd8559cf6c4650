#include "display/sinks/sink_window.h"

#include <fmt/format.h>

namespace dubsar {

Result<SinkWindow> open_sink_window(const SinkCatalog& catalog, const SinkSpec& display,
                                    std::unique_ptr<OutputSink> sink, WindowOptions options, const SinkSpec& fallback) {
  SinkWindow out;
  out.display = display;
  const SinkTraits wanted = sink->traits();
  if (wanted.exact_pixels) options.decorated = false;
  options.stereo = wanted.stereo_visual;
  auto window = GlfwWindow::create(options);
  if (!window && wanted.stereo_visual && window.error().kind == ErrorKind::kUnavailable) {
    const std::string reason = window.error().message;
    options.stereo = false;
    DUBSAR_ASSIGN(sink, catalog.make(fallback));
    out.display = fallback;
    window = GlfwWindow::create(options);
    out.note =
        fmt::format("display {} cannot be had here ({}); {} is shown instead", display.text(), reason, fallback.text());
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
        display.text(), traits.output.width, traits.output.height, screen.window_w, screen.window_h);
  return out;
}

Result<SinkWindow> open_sink_window(const SinkCatalog& catalog, const SinkSpec& display, const WindowOptions& options,
                                    const SinkSpec& fallback) {
  DUBSAR_ASSIGN(auto sink, catalog.make(display));
  return open_sink_window(catalog, display, std::move(sink), options, fallback);
}

}  // namespace dubsar
