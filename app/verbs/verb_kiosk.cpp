// dubsar kiosk: a gallery's profile looked at before its visitors do.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "app/calibration/display_choice.h"
#include "app/cli/config_folder.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/kiosk/kiosk_check.h"
#include "app/kiosk/kiosk_report.h"
#include "app/kiosk/kiosk_screens.h"
#include "app/kiosk/wanted_panel.h"
#include "app/panels/text_ruler.h"
#include "app/verbs/told_session.h"
#include "app/verbs/view_files.h"
#include "app/verbs/view_panels.h"
#include "core/base/system/second.h"
#include "core/base/text/parse_number.h"
#include "core/image_io/png_file.h"
#include "devices/looking_glass/bridge_client.h"
#include "input/source_spec.h"

namespace dubsar::app {
namespace {

constexpr double kUsualPanelMm[2] = {344.0, 194.0};  // 15.6 inches, where no monitor says its size
constexpr std::chrono::milliseconds kAskEvery{20};
/// What sends for those that are programs.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kStarts{
    {{"opentrack", "start opentrack with UDP over network to this machine, port 4242"},
     {"vrpn", "start the VRPN server"},
     {"spacenav", "start spacenavd (systemctl start spacenavd)"},
     {"leapc", "start Ultraleap's service (systemctl start ultraleap-hand-tracking-service)"}}};
constexpr double kScreensHeightPx = 720.0;

struct KioskRequest {
  std::string profile, pictures, size;
  std::string journal;
  int days = 7;
  std::optional<Arguments> check, report;
};

ErrorKind kind_of(const Error& error) { return is_mistake(error.kind) ? ErrorKind::kConfig : ErrorKind::kUnavailable; }

struct PanelShape {
  double width_mm = kUsualPanelMm[0], height_mm = kUsualPanelMm[1];
};

/// The monitor that it would be shown on; where none says its size, a usual one.
PanelShape look_at_panel(KioskCheck& check) {
  PanelShape out;
  const KioskProfile& profile = check.profile();
  auto display = choose_display(profile.display, profile.plugins, kBridgePort);
  if (!display) {
    check.add("/display", display.error().message, kind_of(display.error()));
    return out;
  }
  const auto sink = display->catalog->make(display->display);
  if (!sink) {
    check.add("/display", sink.error().message, kind_of(sink.error()));
    return out;
  }
  const auto monitors = list_monitors();
  if (!monitors) {
    if (!profile.monitor.empty()) check.add("/monitor", monitors.error().message, ErrorKind::kUnavailable);
    return out;
  }
  const PanelChoice choice = choose_panel(*monitors, profile.monitor, (*sink)->traits());
  if (!choice.trouble.empty())
    check.add(choice.flat ? "/display" : "/monitor", choice.trouble, ErrorKind::kUnavailable);
  for (const Monitor& one : *monitors)
    if (one.name == choice.monitor && one.width_mm > 0.0 && one.height_mm > 0.0) out = {one.width_mm, one.height_mm};
  return out;
}

/// Why a device does not answer within a second; empty: it does.
std::string silent(InputSource& source, std::string_view spec) {
  const SteadyClock clock;
  InputFrame frame;
  for (const TimestampNs end = clock.now() + kSecondNs; clock.now() < end; std::this_thread::sleep_for(kAskEvery))
    if (source.poll(clock.now(), frame) != Freshness::kLost) return {};
  const std::string note = source.note();
  for (const auto& [name, start] : kStarts)
    if (spec.find(name) != std::string_view::npos) return fmt::format("{}; {}", note, start);
  return note + "; plug it in (dubsar devices list says why one cannot be used)";
}

void look_at_inputs(KioskCheck& check) {
  const std::vector<std::string_view> names = input_source_names();
  InputConfig base;
  base.model_folder = model_folder();
  for (std::size_t i = 0; i < check.profile().inputs.size(); ++i) {
    const std::string place = fmt::format("/inputs/{}", i);
    const auto specs = parse_sources(check.profile().inputs[i], names);
    if (!specs) {
      check.add(place, specs.error().message);
      continue;
    }
    for (const SourceSpec& spec : *specs) {
      const auto made = make_input(spec.text(), base);
      if (made) {
        if (std::string why = silent(**made, spec.text()); !why.empty())
          check.add(place, std::move(why), ErrorKind::kUnavailable);
      } else {
        check.add(place, made.error().message, kind_of(made.error()));
      }
    }
  }
}

void look_at_side_panels(KioskCheck& check) {
  for (std::size_t i = 0; i < check.profile().panels.size(); ++i) {
    const KioskPanel& panel = check.profile().panels[i];
    const auto made = side_panel({panel.display, panel.monitor, panel.size}, check.profile().plugins, kBridgePort);
    const bool size = !made && made.error().message.find("size") != std::string::npos;
    if (!made) check.add(fmt::format("/panels/{}/{}", i, size ? "size" : "display"), made.error().message);
  }
}

void look_at_words(KioskCheck& check, const PanelShape& panel) {
  const TextRuler ruler(panel.width_mm, panel.height_mm, check.profile().eyes.reading_distance_m);
  for (const KioskCheck::Said& said : check.said())
    if (std::string wrong = ruler.wrong(said.text, said.title); !wrong.empty())
      check.add(said.place, std::move(wrong), ErrorKind::kConfig, said.file);
}

/// The surface, if it can be shown.
std::optional<TriMesh> open_object(KioskCheck& check, std::size_t at, Progress& progress) {
  const KioskObject& object = check.profile().objects[at];
  const std::string place = fmt::format("/objects/{}", at);
  std::error_code error;
  if (const auto style = shading_preset(object.style); !style) check.add(place + "/style", style.error().message);
  if (!std::filesystem::is_regular_file(object.file, error)) return std::nullopt;  // was said
  if (const auto parts = check_parts(object.file, object.parts); !parts) {
    check.add(place + "/parts", parts.error().message);
    return std::nullopt;
  }
  auto mesh = load_mesh({object.file, object.parts, true, {}, true}, progress);
  if (!mesh) {
    check.add(place + "/file", mesh.error().message, mesh.error().kind);
    return std::nullopt;
  }
  const std::vector<TourStep>& steps = check.tours()[at].steps;
  for (std::size_t s = 0; s < steps.size(); ++s)
    for (std::size_t l = 0; l < steps[s].labels.size(); ++l) {
      const std::string& part = steps[s].labels[l].part;
      const bool known = std::any_of(mesh->partitions.begin(), mesh->partitions.end(),
                                     [&](const Partition& one) { return one.name == part; });
      std::string names;
      for (const Partition& one : mesh->partitions) names += (names.empty() ? "" : ", ") + one.name;
      if (!part.empty() && !known)
        check.add(fmt::format("/steps/{}/labels/{}/part", s, l),
                  fmt::format("{} has no part \"{}\", expected {}", object.file.string(), part,
                              names.empty() ? "none: it is one body" : names),
                  ErrorKind::kBadData, check.tour_file(at));
    }
  return *std::move(mesh);
}

Result<int> write_screens(const KioskRequest& asked, const KioskCheck& check, std::size_t at, const TriMesh& mesh,
                          const PanelShape& panel, Progress& progress) {
  ViewOptions view;
  DUBSAR_ASSIGN(view.mapping, gallery_mapping());
  const KioskObject& object = check.profile().objects[at];
  DUBSAR_ASSIGN(view.stage.shading, shading_preset(object.style));
  view.work.document.style.name = view.stage.style = object.style;
  view.work.upright = true;
  Screen& screen = view.stage.screen;
  screen.height_px = screen.window_h = static_cast<int>(kScreensHeightPx);
  screen.width_px = screen.window_w = 2 * static_cast<int>(0.5 * kScreensHeightPx * panel.width_mm / panel.height_mm);
  screen.width_mm = panel.width_mm;
  screen.height_mm = panel.height_mm;
  KioskParts parts;
  parts.profile = check.profile();
  parts.profile.objects = {object};
  parts.words = check.words();
  parts.version = DUBSAR_VERSION;
  parts.tours = {check.tours()[at]};
  parts.zone = {1e-3 * view.mapping.hands.zone_min_mm, 1e-3 * view.mapping.hands.zone_max_mm};
  DUBSAR_ASSIGN(const auto screens, kiosk_screens(mesh, view, std::move(parts), progress));
  for (std::size_t i = 0; i < screens.size(); ++i)
    DUBSAR_TRY(write_png(
        (std::filesystem::path(asked.pictures) / fmt::format("object-{}-{}-{}.png", at + 1, i + 1, screens[i].name))
            .string(),
        screens[i].picture));
  return static_cast<int>(screens.size());
}

Result<VerbResult> run_check(const KioskRequest& asked, Progress& progress) {
  KioskCheck check(asked.profile);
  PanelShape panel = look_at_panel(check);
  if (!asked.size.empty()) {
    const auto size = parse_size(asked.size);
    if (!size || (*size)[0] < 10 || (*size)[1] < 10)
      return fail(ErrorKind::kUsage, "--panel \"{}\" not understood, expected its millimetres such as 344x194",
                  asked.size);
    panel = PanelShape{static_cast<double>((*size)[0]), static_cast<double>((*size)[1])};
  }
  look_at_side_panels(check);
  look_at_inputs(check);
  look_at_words(check, panel);
  int pictures = 0;
  if (!asked.pictures.empty()) {
    std::error_code error;
    std::filesystem::create_directories(asked.pictures, error);
    if (error) return fail(ErrorKind::kCannotCreate, "--pictures {}: {}", asked.pictures, error.message());
  }
  for (std::size_t i = 0; i < check.profile().objects.size(); ++i) {
    const auto mesh = open_object(check, i, progress);
    if (!mesh || asked.pictures.empty()) continue;
    DUBSAR_ASSIGN(const int written, write_screens(asked, check, i, *mesh, panel, progress));
    pictures += written;
  }
  VerbResult out;
  const std::vector<std::string> faults = check.sentences();
  out.json = {{"faults", faults}, {"pictures", pictures}};
  for (const std::string& fault : faults) out.text += fault + "\n";
  if (pictures > 0) out.text += fmt::format("{} pictures in {}\n", pictures, asked.pictures);
  if (faults.empty())
    out.text += fmt::format("{}: nothing is wrong\n", asked.profile);
  else
    out.failure = Error{check.kind(), faults.size() == 1 ? "one fault" : fmt::format("{} faults", faults.size())};
  return out;
}

Result<VerbResult> run_report(const KioskRequest& asked) {
  DUBSAR_ASSIGN(const KioskReport report, kiosk_report(asked.journal, asked.days));
  VerbResult out;
  out.text = report.text;
  out.json = {
      {"days", report.days}, {"visits", report.visits}, {"troubles", report.troubles}, {"killed", report.killed}};
  return out;
}

}  // namespace

Verb add_kiosk_verb(Arguments program) {
  Arguments command = program.command("kiosk", "a gallery before its visitors come, and after");
  command.needs_command();
  command.footer(
      "Examples:\n  dubsar kiosk check kiosk.json\n  dubsar kiosk check kiosk.json --pictures screens --panel 344x194\n"
      "  dubsar kiosk report journal --days 30");
  auto options = std::make_shared<KioskRequest>();
  options->check = command.subcommand("check", "all that is wrong with a profile, each in one sentence with its place");
  options->check->reads("profile", options->profile, "the profile (docs/kiosk.md)").required().called("PROFILE.json");
  options->check->value("--pictures", options->pictures, "folder for a picture of each screen").called("DIR");
  options->check->value("--panel", options->size, "millimetres of the panel (its monitor's, else 344x194)")
      .called("WxH");
  options->report = command.subcommand("report", "what a kiosk's journal says, a paragraph a day");
  options->report->value("journal", options->journal, "the journal's folder").required().called("DIR");
  options->report->value("--days", options->days, "how many, the last ones").range(1, 3660);
  return {command, [options](const CommonOptions&, Progress& progress) {
            return options->check->chosen() ? run_check(*options, progress) : run_report(*options);
          }};
}

}  // namespace dubsar::app
