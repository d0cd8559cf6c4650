#include "app/verbs/view_kiosk.h"

#include <cstdlib>
#include <optional>
#include <vector>

#include "app/cli/mesh_input.h"
#include "app/kiosk/kiosk_controller.h"
#include "app/kiosk/wanted_panel.h"
#include "app/verbs/view_files.h"
#include "app/viewer/first_document.h"
#include "core/base/files/atomic_file.h"
#include "core/base/system/log.h"
#include "core/base/text/parse_number.h"

namespace dubsar::app {
namespace {

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

Result<Words> words_of(const KioskProfile& profile) {
  if (profile.words.empty()) return Words();
  DUBSAR_ASSIGN(const std::string text, read_text_file(profile.words));
  return Words::parse(text, profile.words.string());
}

void log_left_out(const KioskObject& object, const Error& why) {
  log_warning("view: {} is left out: {}", object.file.string(), why.message);
}

/// Of each object; empty: it has none of its own.
Result<std::vector<Tour>> tours_of(const KioskProfile& profile) {
  std::vector<Tour> out;
  for (const KioskObject& object : profile.objects) {
    out.emplace_back();
    if (object.tour.empty()) continue;
    DUBSAR_ASSIGN(out.back(), read_tour(object.tour));
  }
  return out;
}

/// Leaves out what cannot be shown as far as that is known before it is read.
Result<void> keep_readable(KioskProfile& profile) {
  std::optional<Error> why;
  std::erase_if(profile.objects, [&](const KioskObject& object) {
    const auto checked = check_surface(object.file.string(), object.parts);
    if (checked) return false;
    log_left_out(object, checked.error());
    why = checked.error();
    return true;
  });
  if (profile.objects.empty()) return tl::unexpected<Error>(*std::move(why));
  return {};
}

/// One object after its file was read, or while it is: in real time the window comes first, then a coarse surface.
struct ObjectSession {
  const KioskObject& object;
  const ViewOptions& view;
  KeptPanels& kept;
  std::optional<Error> unreadable{};  ///< why its file could not be read; then run() gives that error

  Result<ViewResult> run(Progress& progress) {
    const ReadSurface read = [&, plain = surface_reader(view, {object.parts, 0.0, {}, view.work.upright, false})](
                                 const std::filesystem::path& file, Progress& reading, const TellCoarse& tell) {
      auto surface = plain(file, reading, tell);
      if (!surface && surface.error().kind != ErrorKind::kCancelled) unreadable = surface.error();
      return surface;
    };
    if (view.window && view.time.fps == 0) {
      FileLoader loader(read, {});
      DUBSAR_TRY(loader.open({object.file}));
      return run_view({}, view, progress, {}, &loader, &kept);
    }
    DUBSAR_ASSIGN(const OpenedSurface surface, read(object.file, progress, {}));
    ViewOptions with = view;
    with.work = surface.work;
    return run_view(surface.mesh, with, progress, {}, nullptr, &kept);
  }
};

/// What is shown on, of what the profile names.
struct PanelNow {
  std::string display, monitor, trouble;
  bool flat = false;  ///< in place of the profile's display
};

KioskProfile with_monitor(KioskProfile profile, const PanelNow& panel) {
  profile.monitor = panel.monitor;
  return profile;
}

/// A display or monitor that cannot be had is replaced, in words.
Result<PanelNow> choose_now(const KioskSession& session, const KioskProfile& profile, MonitorWatch& monitors) {
  constexpr std::string_view kFlat = "mono", kGoesOn = "; the kiosk goes on with a flat picture";
  PanelNow out{profile.display, {}, {}, false};
  KioskProfile any = profile;
  any.monitor.clear();
  auto options = session.options(any, profile.objects.front(), out.display);
  if (!options && out.display != kFlat) {
    out.trouble = options.error().message + std::string(kGoesOn);
    out.display = kFlat;
    out.flat = true;
    options = session.options(any, profile.objects.front(), out.display);
  }
  if (!options) return tl::unexpected<Error>(options.error());
  if (!options->window) return out;
  if (!options->window->monitor.empty()) return out;  // of the command line, which is as it is
  const StageOptions& stage = options->stage;
  DUBSAR_ASSIGN(const auto sink, stage.catalog->make(stage.display));
  DUBSAR_ASSIGN(const auto there, monitors.look());
  const PanelChoice choice =
      choose_panel(there, profile.monitor, options->fullscreen.value_or(true) ? sink->traits() : SinkTraits());
  out.monitor = choice.monitor;
  if (choice.trouble.empty()) return out;
  out.flat = out.flat || choice.flat;
  if (choice.flat) out.display = kFlat;
  out.trouble += (out.trouble.empty() ? "" : "; ") + choice.trouble;
  return out;
}

}  // namespace

Result<KioskOutcome> run_kiosk(const KioskSession& session, Progress& progress) {
  DUBSAR_ASSIGN(KioskProfile profile, read_kiosk_profile(session.profile));
  DUBSAR_ASSIGN(const Words words, words_of(profile));
  for (const std::string& language : profile.languages)
    if (!words.has(language))
      return fail(ErrorKind::kConfig, "{}: language \"{}\" found, expected en, de, fr or one of the file of words",
                  session.profile.string(), language);
  DUBSAR_TRY(keep_readable(profile));
  KioskOutcome out;
  MonitorWatch monitors(profile.monitor);
  DUBSAR_ASSIGN(PanelNow panel, choose_now(session, profile, monitors));
  DUBSAR_ASSIGN(const ViewOptions options,
                session.options(with_monitor(profile, panel), profile.objects.front(), panel.display));
  KioskParts parts;
  DUBSAR_ASSIGN(parts.tours, tours_of(profile));
  parts.profile = profile;
  parts.words = words;
  const HandMapping& hands = options.mapping.hands;
  parts.zone = {1e-3 * hands.zone_min_mm, 1e-3 * hands.zone_max_mm};
  parts.version = DUBSAR_VERSION;
  parts.trouble = panel.trouble;
  parts.flat = panel.flat;
  parts.notify_socket = environment("NOTIFY_SOCKET");
  parts.watchdog_us = static_cast<std::int64_t>(parse_number(environment("WATCHDOG_USEC")).value_or(0.0));
  KioskController guide(std::move(parts));
  std::optional<KeptPanels> kept(std::in_place);  // no desktop is seen between two objects
  for (std::size_t at = 0; at < guide.objects().size(); at = guide.object()) {
    const KioskObject object = guide.objects()[at];
    DUBSAR_ASSIGN(ViewOptions view, session.options(with_monitor(profile, panel), object, panel.display));
    view.guide = &guide;
    view.around.notices = view.around.panels = false;
    view.stage.room.gallery = true;
    view.stage.room.most_parallax_deg = profile.eyes.parallax_deg;
    bool elsewhere = false;
    if (view.window) view.time.outdated = [&] { return elsewhere = monitors.changed(SteadyClock().now()); };
    guide.begin_object();
    ObjectSession one{object, view, *kept};
    auto seen = one.run(progress);
    if (!seen && one.unreadable && guide.objects().size() > 1) {
      log_left_out(object, *one.unreadable);
      guide.leave_out(at, one.unreadable->message);
      continue;
    }
    out.stopped = !seen && seen.error().kind == ErrorKind::kCancelled;
    if (out.stopped) break;
    if (!seen) return tl::unexpected<Error>(seen.error());
    out.last = *std::move(seen);
    out.triangles = out.last.triangles;
    ++out.sessions;
    if (elsewhere) {  // its windows are made anew, on what there is now
      kept.emplace();
      DUBSAR_ASSIGN(panel, choose_now(session, profile, monitors));
      guide.set_trouble(panel.trouble, panel.flat);
      continue;
    }
    if (!guide.ended()) break;  // its time or its scripts are over
  }
  out.display = panel.display;
  out.counts = guide.visit().counts();
  return out;
}

VerbResult describe_stopped(const KioskOutcome& done) {
  VerbResult out;
  out.json = {{"stopped", true}, {"visits", done.counts.visits}, {"resets", done.counts.resets}};
  out.text = fmt::format("the kiosk was ended from outside; {} visits\n", done.counts.visits);
  return out;
}

Result<VerbResult> write_tour(const std::filesystem::path& path, const TriMesh& mesh, const ViewOptions& view) {
  const Tour tour = default_tour(first_document(view, mesh).document, Words());
  DUBSAR_TRY(write_file_atomically(path, format_tour(tour)));
  VerbResult out;
  out.json = {{"output", path.string()}, {"steps", tour.steps.size()}};
  out.text = fmt::format("{}: a tour of {} steps\n", path.string(), tour.steps.size());
  return out;
}

}  // namespace dubsar::app
