#include "app/verbs/view_kiosk.h"

#include <cstdlib>

#include "app/cli/mesh_input.h"
#include "app/kiosk/kiosk_guide.h"
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

Result<std::vector<TriMesh>> load_objects(KioskProfile& profile, Progress& progress) {
  std::vector<TriMesh> out;
  std::vector<KioskObject> kept;
  std::string why;
  for (const KioskObject& object : profile.objects) {
    auto mesh = load_mesh({object.file, object.parts, true}, progress);
    if (!mesh && mesh.error().kind == ErrorKind::kCancelled) return tl::unexpected<Error>(mesh.error());
    if (!mesh) {
      why = mesh.error().message;
      log_warning("view: {} is left out: {}", object.file.string(), why);
      continue;
    }
    out.push_back(*std::move(mesh));
    kept.push_back(object);
  }
  if (out.empty()) return fail(ErrorKind::kBadData, "view: none of the kiosk's objects can be shown: {}", why);
  profile.objects = std::move(kept);
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
  DUBSAR_TRY(tours_of(profile));  // before large files are read
  KioskOutcome out;
  out.display = profile.display;
  std::string trouble;
  auto options = session.options(profile, profile.objects.front(), out.display);
  if (!options && out.display != "mono") {
    trouble = options.error().message + "; the kiosk goes on with a flat picture";
    out.display = "mono";
    options = session.options(profile, profile.objects.front(), out.display);
  }
  if (!options) return tl::unexpected<Error>(options.error());
  DUBSAR_ASSIGN(const std::vector<TriMesh> meshes, load_objects(profile, progress));
  KioskParts parts;
  DUBSAR_ASSIGN(parts.tours, tours_of(profile));
  parts.profile = profile;
  parts.words = words;
  const HandMapping& hands = options->mapping.hands;
  parts.zone = {1e-3 * hands.zone_min_mm, 1e-3 * hands.zone_max_mm};
  parts.trouble = trouble;
  parts.notify_socket = environment("NOTIFY_SOCKET");
  parts.watchdog_us = static_cast<std::int64_t>(parse_number(environment("WATCHDOG_USEC")).value_or(0.0));
  KioskGuide guide(std::move(parts));
  KeptPanels kept;  // no desktop is seen between two objects
  for (std::size_t at = 0; at < meshes.size(); at = guide.object()) {
    DUBSAR_ASSIGN(ViewOptions view, session.options(profile, profile.objects[at], out.display));
    view.guide = &guide;
    view.around.notices = view.around.panels = false;
    view.files.autosave.clear();
    view.stage.room.most_parallax_deg = profile.eyes.parallax_deg;
    guide.begin_object();
    DUBSAR_ASSIGN(out.last, run_view(meshes[at], view, progress, {}, nullptr, &kept));
    out.triangles = meshes[at].triangles.size();
    ++out.sessions;
    if (!guide.ended()) break;  // its time or its scripts are over
  }
  out.counts = guide.visit().counts();
  return out;
}

Result<VerbResult> write_tour(const std::filesystem::path& path, const TriMesh& mesh, const ViewOptions& view) {
  const Tour tour = default_tour(first_document(view, mesh), Words());
  DUBSAR_TRY(write_file_atomically(path, format_tour(tour)));
  VerbResult out;
  out.json = {{"output", path.string()}, {"steps", tour.steps.size()}};
  out.text = fmt::format("{}: a tour of {} steps\n", path.string(), tour.steps.size());
  return out;
}

}  // namespace dubsar::app
