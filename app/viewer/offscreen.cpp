#include "app/viewer/offscreen.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "core/image_io/png_file.h"
#include "display/render/compose_pass.h"
#include "display/render/context_egl.h"
#include "input/input_recorder.h"

namespace dubsar::app {
namespace {

constexpr double kSettleS = 1.0;  // glides end after the last hand is down

Result<void> check(const OffscreenOptions& options) {
  if (!(options.fps >= 1 && options.fps <= 240) || !(options.longest_s > 0 && options.longest_s <= 3600) ||
      options.every < 1 || !(options.display_delay_s >= 0 && options.display_delay_s <= 0.1))
    return fail(ErrorKind::kUsage,
                "view: {} frames a second for {} s with a display delay of {} s found, expected 1 to 240, up to 3600 s "
                "and 0 to 0.1 s",
                options.fps, options.longest_s, options.display_delay_s);
  if (options.inputs.empty())
    return fail(ErrorKind::kUsage,
                "view: no input, expected --script FILE or --input with scripted:FILE or replay:FILE");
  if (options.frames.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(options.frames, error);
  if (error || !std::filesystem::is_directory(options.frames))
    return fail(ErrorKind::kCannotCreate, "view: cannot create the folder {}: {}", options.frames.string(),
                error.message());
  return {};
}

}  // namespace

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(
      std::clamp(std::ceil(p * static_cast<double>(values.size())) - 1.0, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

Result<OffscreenResult> run_offscreen(const TriMesh& mesh, const OffscreenOptions& options, Progress& progress,
                                      const std::function<void(const Image&, const FrameReport&)>& look) {
  DUBSAR_TRY(check(options));
  DUBSAR_ASSIGN(const auto context, EglContext::create());  // goes last
  const auto step = static_cast<TimestampNs>(1e9 / options.fps);
  ManualClock clock(step);  // outlives the sources
  DUBSAR_ASSIGN(const auto session, Session::create(mesh, options.session));
  InputConfig config;
  config.seen_view = &session->view();
  config.clock = &clock;
  config.simulated_time = true;
  config.model_folder = options.session.model_folder;
  config.panel_m = 1e-3 * glm::dvec2(options.session.screen.width_mm, options.session.screen.height_mm);
  std::unique_ptr<InputRecorder> recorder;
  if (!options.record.empty()) {
    DUBSAR_ASSIGN(recorder, InputRecorder::create(options.record));
    session->on_input([&](TimestampNs now, const InputFrame& frame) { recorder->add(now, frame); });
  }
  for (const std::string& spec : options.inputs) {
    DUBSAR_ASSIGN(auto source, make_input(spec, config));
    session->input().add(std::move(source));
  }
  const SinkTraits traits = session->traits();
  DUBSAR_ASSIGN(const OffscreenSurface surface, OffscreenSurface::create(traits.output));
  const auto delay = static_cast<TimestampNs>(1e9 * options.display_delay_s);
  const auto most = static_cast<int>(std::ceil(options.longest_s * options.fps));
  int left_after_end = static_cast<int>(std::ceil(kSettleS * options.fps));
  OffscreenResult out;
  progress.begin("view", most, "frame");
  glm::dquat last_turn = session->view().rotation;
  for (; out.frames < most && left_after_end > 0; ++out.frames) {
    if (progress.cancelled()) return cancelled_error();
    const double cpu = process_cpu_seconds();
    const Field field = traits.fields > 1 && out.frames % 2 == 1 ? Field::kSecond : Field::kFirst;
    DUBSAR_ASSIGN(const FrameReport report, session->draw(clock.now(), clock.now() + delay, surface.surface(), field));
    const bool write = !options.frames.empty() && out.frames % options.every == 0;
    if (write || look) {
      DUBSAR_ASSIGN(const Image picture, surface.read());
      if (look) look(picture, report);
      if (write) {
        const std::string name = fmt::format("frame-{:05}{}.png", out.frames, traits.file_suffix);
        DUBSAR_TRY(write_png((options.frames / name).string(), picture));
        ++out.written;
      }
    }
    out.frame_cpu_ms.push_back(1e3 * (process_cpu_seconds() - cpu));
    if (report.input_age) out.input_age_ms.push_back(1e-6 * static_cast<double>(*report.input_age));
    out.largest_turn_deg = std::max(out.largest_turn_deg, turn_between_deg(last_turn, report.view.rotation));
    last_turn = report.view.rotation;
    if (recorder) DUBSAR_TRY(recorder->flush());
    if (session->input().finished()) --left_after_end;
    clock.advance(step);
    progress.advance(1);
  }
  progress.end();
  out.seconds = static_cast<double>(out.frames) / options.fps;
  out.view = session->view();
  out.sources = session->input().states();
  if (recorder) DUBSAR_TRY(recorder->finish());
  return out;
}

}  // namespace dubsar::app
