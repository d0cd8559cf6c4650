#include "app/verbs/view_outcome.h"

#include <fmt/format.h>

#include <array>

#include "core/base/numbers/angle.h"
#include "core/base/numbers/measurements.h"

namespace dubsar::app {
namespace {

nlohmann::json latency_json(const Measurements& ms) {
  return {{"frames", ms.size()},
          {"median_ms", ms.quantile(0.5)},
          {"p95_ms", ms.quantile(0.95)},
          {"worst_ms", ms.quantile(1.0)}};
}

nlohmann::json view_json(const ViewState& view) {
  return {{"rotation_wxyz", {view.rotation.w, view.rotation.x, view.rotation.y, view.rotation.z}},
          {"turned_deg", turn_between_deg(view.rotation, {1, 0, 0, 0})},
          {"zoom", view.zoom},
          {"pan", {view.pan.x, view.pan.y}},
          {"light_azimuth_deg", view.light_azimuth_deg},
          {"light_elevation_deg", view.light_elevation_deg}};
}

std::string_view health_name(SourceHealth health) {
  constexpr std::array<std::string_view, 4> kNames{"present", "lost", "missing", "off"};
  return kNames[static_cast<std::size_t>(health)];
}

}  // namespace

VerbResult describe_session(const std::string& display, const ViewResult& done, std::size_t triangles, bool simulated) {
  VerbResult out;
  const glm::dvec3 turn = vector_of(done.view.rotation) / kRadPerDeg;
  out.json = {{"display", display},
              {"frames", done.frames},
              {"pictures", done.written},
              {simulated ? "simulated_s" : "seconds", done.seconds},
              {"triangles", triangles},
              {"view", view_json(done.view)},
              {"largest_turn_in_a_frame_deg", done.largest_turn_deg},
              {simulated ? "input_age_at_cameras_simulated" : "input_age_at_cameras", latency_json(done.input_age_ms)},
              {"frame_cpu", latency_json(done.frame_cpu_ms)}};
  out.text = fmt::format(
      "{} frames of {:.1f} s, {} pictures\n"
      "turned by ({:.1f}, {:.1f}, {:.1f}) degrees about right, up, viewer; zoom {:.3f}; at most {:.2f} degrees a "
      "frame\n"
      "device time to cameras{}: median {:.1f} ms, 95 % {:.1f} ms, worst {:.1f} ms over {} frames with new input\n"
      "CPU time of a frame: median {:.1f} ms, worst {:.1f} ms\n",
      done.frames, done.seconds, done.written, turn.x, turn.y, turn.z, done.view.zoom, done.largest_turn_deg,
      simulated ? " (simulated clock)" : "", done.input_age_ms.quantile(0.5), done.input_age_ms.quantile(0.95),
      done.input_age_ms.quantile(1.0), done.input_age_ms.size(), done.frame_cpu_ms.quantile(0.5),
      done.frame_cpu_ms.quantile(1.0));
  return out;
}

void add_sources(const std::vector<SourceRow>& rows, VerbResult& out) {
  out.json["sources"] = nlohmann::json::array();
  for (const SourceRow& row : rows) {
    out.json["sources"].push_back({{"source", row.spec}, {"state", health_name(row.health)}, {"reason", row.reason}});
    out.text += fmt::format("source {}: {}{}{}\n", row.spec, health_name(row.health), row.reason.empty() ? "" : ", ",
                            row.reason);
  }
}

void add_panel_states(const ViewResult& done, VerbResult& out) {
  if (done.also.empty()) return;
  out.json["also"] = nlohmann::json::array();
  for (const PanelOutcome& panel : done.also) {
    out.json["also"].push_back({{"display", panel.display}, {"frames", panel.frames}, {"trouble", panel.trouble}});
    out.text += panel.trouble.empty() ? fmt::format("panel {}: {} frames\n", panel.display, panel.frames)
                                      : fmt::format("panel {}: {}\n", panel.display, panel.trouble);
  }
}

void add_intervals(const ViewResult& done, VerbResult& out) {
  if (done.first.window_s) {
    out.json["window_s"] = *done.first.window_s;
    out.text += fmt::format("the window was there after {:.2f} s", *done.first.window_s);
    if (done.first.surface_s) {
      out.json["surface_s"] = *done.first.surface_s;
      out.text += fmt::format(", the first picture of a surface after {:.2f} s", *done.first.surface_s);
    }
    out.text += "\n";
  }
  out.json["frames_per_s_while_moving"] = done.fps;
  out.text += fmt::format("frames a second while things moved: {:.1f}\n", done.fps);
  out.json["intervals"] = latency_json(done.interval_ms);
  if (!done.interval_ms.empty())
    out.text += fmt::format(
        "from picture to picture while things moved, all {}: median {:.1f} ms, 95 % {:.1f} ms, longest {:.1f} ms\n",
        done.interval_ms.size(), done.interval_ms.quantile(0.5), done.interval_ms.quantile(0.95),
        done.interval_ms.quantile(1.0));
}

}  // namespace dubsar::app
