// Makes the strips of the documentation: make_strips SURFACE.ply SCRIPTS FOLDER. `./do strips` runs it.

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "core/base/files/atomic_file.h"
#include "core/base/progress.h"
#include "core/image_io/png_file.h"
#include "core/mesh_io/mesh_io.h"
#include "input/simulated/script.h"
#include "tests/app/viewer/scripted_sessions.h"
#include "tests/app/viewer/strip_sheet.h"

namespace {
using namespace dubsar;
using namespace dubsar::testing;
namespace fs = std::filesystem;

Image cut(const Image& image, int left, int top, int width, int height) {
  Image out(width, height, 3);
  for (int y = 0; y < height; ++y) std::copy_n(image.at(left, top + y), 3 * width, out.at(0, y));
  return out;
}

Image middle_square(const Image& image) {
  return cut(image, (image.width - image.height) / 2, 0, image.height, image.height);
}

/// Pixels of the panel, each as a square.
Image magnified(const Image& image, int times) {
  Image out(times * image.width, times * image.height, 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) std::copy_n(image.at(x / times, y / times), 3, out.at(x, y));
  return out;
}

/// The first moment, and those at which something has changed since the one before; the last of them when
/// there are too many.
std::vector<SessionMoment> changed(const std::vector<SessionMoment>& moments, std::size_t most) {
  std::vector<SessionMoment> out;
  for (const SessionMoment& moment : moments) {
    const ViewState& now = moment.report.view;
    if (!out.empty() && turn_between_deg(out.back().report.view.rotation, now.rotation) < 4.0 &&
        std::abs(out.back().report.view.zoom - now.zoom) < 0.04)
      continue;
    if (out.size() < most) {
      out.push_back(moment);
    } else {
      out.back() = moment;
    }
  }
  return out;
}

Result<void> visitor(const TriMesh& mesh, const fs::path& scripts, const fs::path& folder) {
  const XvfbServer server(1712, 1712);
  if (!server.problem().empty()) return fail(ErrorKind::kUnavailable, "{}", server.problem());
  constexpr int kColumns = 8, kRows = 6;
  const Stage stage{
      .display = "quilt:looking-glass-portrait,width=1680,height=1680", .width = 1680, .height = 1680, .every = 45};
  DUBSAR_ASSIGN(const StagedSession session,
                play(server, mesh, stage, {"scripted:" + (scripts / "visitor.json").string()}));
  std::vector<std::vector<Image>> rows(2);
  for (const SessionMoment& moment : changed(session.moments, 6)) {
    fmt::print("visitor {:.1f} s: turned {:.1f} degrees, zoom {:.2f}\n", moment.time_s,
               turn_between_deg(moment.report.view.rotation, {1, 0, 0, 0}), moment.report.view.zoom);
    rows[0].push_back(scaled(moment.window, 180, 180));
    rows[1].push_back(scaled(quilt_tile(moment.window, kColumns, kRows, kColumns * kRows / 2), 180, 240));
  }
  return write_png((folder / "strip_visitor.png").string(), sheet(rows));
}

/// The upper left quarter of a 15.6" tracked panel, with its lenses: simulated eyes take their time.
constexpr const char* kPanel =
    R"([{"name": "quarter", "title": "quarter of a 15.6 inch panel", "kind": "tracked", "width_px": 1920,
  "height_px": 1080, "width_mm": 172.7, "optics": {"pitch_mm": 0.200884, "tan_slant": 0.333333, "reduced_gap_mm": 0.956589,
  "refractive_index": 1.5, "phase0": 0.0, "spot_sigma_periods": 0.1}, "design_distance_mm": 600, "ipd_mm": 63}])";

/// A folder of profiles with the panel above; goes with its owner.
struct PanelFolder {
  fs::path path = fs::temp_directory_path() / fmt::format("dubsar_strips_{}", ::getpid());
  PanelFolder() {
    fs::create_directories(path);
    static_cast<void>(write_file_atomically(path / "panel.json", kPanel));
  }
  ~PanelFolder() { fs::remove_all(path); }
  PanelFolder(const PanelFolder&) = delete;
  PanelFolder& operator=(const PanelFolder&) = delete;
};

Result<void> scholar(const TriMesh& mesh, const fs::path& scripts, const fs::path& folder) {
  const PanelFolder panels;
  const XvfbServer server(1920, 1080);
  if (!server.problem().empty()) return fail(ErrorKind::kUnavailable, "{}", server.problem());
  const Stage stage{.display = "lenticular:quarter",
                    .width = 1920,
                    .height = 1080,
                    .view = "orbit:25,20",
                    .every = 54,
                    .longest_s = 4.8,
                    .panel_folder = panels.path};
  const std::string file = (scripts / "scholar.json").string();
  DUBSAR_ASSIGN(const StagedSession session, play(server, mesh, stage, {"scripted:" + file}));
  DUBSAR_ASSIGN(const std::string text, read_text_file(file));
  DUBSAR_ASSIGN(const Script script, parse_script(text, file));
  std::vector<std::vector<Image>> rows(3);
  for (const SessionMoment& moment : session.moments) {
    const auto head = sample_head(script.heads[0], moment.time_s);
    if (moment.time_s < 0.5 || !head) continue;
    DUBSAR_ASSIGN(const SeenPair seen, seen_from(moment, 1e3 * *head));
    fmt::print(
        "scholar {:.1f} s: head at {:.0f}, {:.0f}, {:.0f} mm; wrong-eye light {:.1f} % left, {:.1f} % "
        "right\n",
        moment.time_s, 1e3 * head->x, 1e3 * head->y, 1e3 * head->z, 100 * seen.left_light.crosstalk,
        100 * seen.right_light.crosstalk);
    rows[0].push_back(magnified(cut(moment.window, 900, 640, 90, 48), 2));
    rows[1].push_back(scaled(middle_square(seen.left), 180, 180));
    rows[2].push_back(scaled(middle_square(seen.right), 180, 180));
  }
  return write_png((folder / "strip_scholar.png").string(), sheet(rows));
}

Result<void> developer(const TriMesh& mesh, const fs::path& scripts, const fs::path& folder) {
  const PanelFolder panels;
  const XvfbServer server(1920, 1080);
  if (!server.problem().empty()) return fail(ErrorKind::kUnavailable, "{}", server.problem());
  const Stage stage{.display = "lenticular:quarter",
                    .width = 1920,
                    .height = 1080,
                    .view = "orbit:25,20",
                    .every = 70,
                    .longest_s = 5.9,
                    .panel_folder = panels.path};
  const std::string file = (scripts / "developer.json").string();
  const fs::path recording = folder / "developer.jsonl";
  DUBSAR_ASSIGN(const StagedSession live,
                play(server, mesh, stage, {"leap:simulate=" + file, "head:opentrack,simulate=" + file}, recording));
  DUBSAR_ASSIGN(const StagedSession replayed, play(server, mesh, stage, {"replay:" + recording.string()}));
  fs::remove(recording);
  std::vector<std::vector<Image>> rows(2);
  for (const auto* session : {&live, &replayed})
    for (const SessionMoment& moment : session->moments) {
      if (moment.time_s < 0.5) continue;
      DUBSAR_ASSIGN(const SeenPair seen, seen_from(moment, moment.report.viewer.centre_mm()));
      const glm::dvec3 eyes = moment.report.viewer.centre_mm();
      fmt::print("developer ({}) {:.1f} s: eyes at {:.0f}, {:.0f}, {:.0f} mm, turned {:.1f} degrees\n",
                 session == &live ? "simulated devices" : "recording", moment.time_s, eyes.x, eyes.y, eyes.z,
                 turn_between_deg(moment.report.view.rotation, {1, 0, 0, 0}));
      rows[session == &live ? 0 : 1].push_back(scaled(middle_square(seen.left), 180, 180));
    }
  return write_png((folder / "strip_developer.png").string(), sheet(rows));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    fmt::print(stderr, "usage: make_strips SURFACE SCRIPTS FOLDER [visitor|scholar|developer]\n");
    return exit_code(ErrorKind::kUsage);
  }
  const std::string only = argc == 5 ? argv[4] : "";
  SilentProgress progress;
  const auto mesh = read_mesh(argv[1], progress);
  if (!mesh) {
    fmt::print(stderr, "{}\n", mesh.error().message);
    return exit_code(mesh.error().kind);
  }
  for (const auto& [name, make] :
       {std::pair{"visitor", &visitor}, std::pair{"scholar", &scholar}, std::pair{"developer", &developer}}) {
    if (!only.empty() && only != name) continue;
    if (const auto done = make(*mesh, argv[2], argv[3]); !done) {
      fmt::print(stderr, "{}: {}\n", name, done.error().message);
      return exit_code(done.error().kind);
    }
  }
  return 0;
}
