// Files of a session: one is shown, others are open or can be.

#include <system_error>

#include "app/document/recent_files.h"
#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
constexpr TimestampNs kListEveryNs = 2'000'000'000;  // files that come and go while the dialogue is open

/// The shelf of a session that has one.
Result<Shelf*> shelf_of(Shelf* shelf) {
  if (shelf == nullptr) return fail(ErrorKind::kUsage, "this session shows one surface, and no other");
  return shelf;
}

}  // namespace

Result<void> Viewer::open_file(const std::string& path) {
  DUBSAR_ASSIGN(Shelf* const shelf, shelf_of(given_.shelf));
  DUBSAR_TRY(shelf->open({fs::path(path)}));
  return take_if_simulated();
}

Result<void> Viewer::open_recent(std::size_t number) {
  DUBSAR_ASSIGN(Shelf* const shelf, shelf_of(given_.shelf));
  const std::vector<std::string> recent = read_recent(shelf->recent_list());
  if (number < 1 || number > recent.size())
    return fail(ErrorKind::kUsage, "open_recent: {} found, expected 1 to {}", number, recent.size());
  return open_file(recent[number - 1]);
}

Result<void> Viewer::switch_file(int step) {
  DUBSAR_ASSIGN(Shelf* const shelf, shelf_of(given_.shelf));
  DUBSAR_TRY(shelf->step(step));
  return take_if_simulated();
}

bool Viewer::stop_opening() { return given_.shelf != nullptr && given_.shelf->stop(); }

/// Simulated time stands still while a file is read.
Result<void> Viewer::take_if_simulated() {
  if (given_.options.time.fps == 0) return {};
  given_.shelf->wait();
  return put_read().value_or(Result<void>());
}

/// Shows the file that was read meanwhile, or says why it cannot be; nothing where none was.
std::optional<Result<void>> Viewer::put_read() {
  auto read = given_.shelf->take();
  if (!read) return std::nullopt;
  if (!*read) return tl::unexpected<Error>(read->error());
  return put(*std::move(*read));
}

/// What fell on the window; who leads a session says what is shown.
void Viewer::drop(const std::vector<std::string>& files) {
  if (given_.shelf == nullptr || given_.options.guide != nullptr || files.empty()) return;
  const auto done = given_.shelf->open({files.begin(), files.end()});
  if (!done) return say(done.error().message);
  editor_->desk().choosing.open = false;
}

std::string Viewer::present_folder() const {
  const Shelf* const shelf = given_.shelf;
  std::error_code error;
  if (shelf != nullptr && shelf->shown()) return shelf->files()[*shelf->shown()].parent_path().string();
  if (shelf != nullptr)
    for (const std::string& recent : read_recent(shelf->recent_list()))
      if (const fs::path folder = fs::path(recent).parent_path(); fs::is_directory(folder, error))
        return folder.string();
  return fs::current_path(error).string();
}

/// Until the first file is there, what is known of it stands in its place.
void Viewer::take_coarse() {
  auto coarse = given_.shelf->take_coarse();
  if (!coarse) return;
  if (has_surface()) return given_.shelf->coarse_was_shown();  // it is not wanted
  auto mesh = std::make_unique<TriMesh>(*std::move(coarse));
  if (const auto done = stage_->set_mesh(*mesh); !done) {
    log_warning("{}", done.error().message);
    return given_.shelf->coarse_was_shown();
  }
  files_.coarse = std::move(mesh);
}

/// Takes in a file that was read meanwhile.
void Viewer::take_surface() {
  if (given_.shelf == nullptr || !at_.window_shown) return;  // the window comes first
  given_.shelf->start();
  take_coarse();
  const std::optional<Result<void>> done = put_read();
  if (!done || *done) return;
  const Error& why = done->error();
  if (!has_surface() && given_.shelf->files().empty() && files_.first) {
    at_.failed = why;  // what the session was begun for
    return;
  }
  log_warning("{}", why.message);
  say(why.message);
  if (!has_surface() && !given_.shelf->go_on()) editor_->desk().choosing.open = true;
}

/// The window is called by the file that is shown, and the one that is being read.
void Viewer::name_window() {
  GlfwWindow* const window = given_.presenter.window();
  if (window == nullptr || given_.shelf == nullptr) return;
  std::string name = title().empty() ? "dubsar" : "dubsar: " + title();
  if (name == files_.window_name) return;
  window->set_title(name);
  files_.window_name = std::move(name);
}

/// What the next session on this file finds.
Result<void> Viewer::leave_work(bool orderly) {
  const Document& d = document();
  const bool made = editor_->has_work() || given_.options.work.restored || d.home != editor_->opened().home;
  if (orderly && made) DUBSAR_TRY(files_.autosave.leave(d));
  if (orderly && !made) files_.autosave.discard();
  return {};
}

std::unique_ptr<Editor> Viewer::make_editor(Document document) {
  const Mapping& mapping = given_.options.mapping;
  return std::make_unique<Editor>(
      std::move(document), *this,
      StepFigures{mapping.key_step_deg, mapping.key_zoom, mapping.zoom_min, mapping.zoom_max});
}

/// What tools need to know of the surface.
void Viewer::find_tools() {
  tools_.evidence = evidence_shares(*given_.mesh);
  tools_.picker.emplace(*given_.mesh);
  tools_.slices = std::make_unique<SliceDesk>(
      *given_.mesh, stage_->box_mm(), scan_of(*given_.mesh, given_.options.work.surface, given_.options.work.scan));
}

/// Another surface takes the place of the present one, whose work is kept.
Result<void> Viewer::put(OpenedSurface surface) {
  auto next = std::make_unique<OpenedSurface>(std::move(surface));
  if (has_surface()) DUBSAR_TRY(leave_work(true));
  DUBSAR_TRY(stage_->set_mesh(next->mesh));
  ViewOptions& options = given_.options;
  const bool first = !has_surface();
  const StyleChoice style = document().style;
  const LightPlace light = document().light;
  options.work = std::move(next->work);
  options.files.autosave = std::move(next->autosave);
  options.around.title = std::move(next->title);
  tools_.slices.reset();
  if (given_.surface_goes) given_.surface_goes();
  files_.opened = std::move(next);
  given_.mesh = &files_.opened->mesh;
  Document document = first_document(options, *given_.mesh);
  if (!first && !options.work.restored) {  // who compares tablets wants the same light on both
    document.style = style;
    document.light = light;
  }
  Desk desk = editor_->desk();
  desk.pending.clear();
  desk.beside.reset();
  desk.note = 0;
  desk.leaving = false;
  editor_ = make_editor(std::move(document));
  editor_->desk() = std::move(desk);
  find_tools();
  tools_.press.reset();
  at_.film_since = at_.sweep_since = -1;
  editor_->desk().sweep.reset();
  steering_->set_home(home_of(this->document()));
  // What was coarse stood as it was scanned: it turns to where its writing is upright.
  steering_->go_to(view_of(this->document()), given_.clock.now(), files_.coarse != nullptr);
  files_.coarse.reset();
  files_.autosave = Autosave(options.files.autosave);
  say(options.work.restored ? "What you measured and noted here last time is here again."
                            : "Drag to turn. 1 to 6: sides. U: lift the envelope. Ctrl+K: everything. F1: help.");
  return {};
}

/// What the panels show of files; folders are looked into while somebody chooses.
FilesState Viewer::files_state(TimestampNs now) {
  FilesState out;
  out.has_surface = has_surface();
  const Shelf* const shelf = given_.shelf;
  if (shelf == nullptr) return out;
  for (const fs::path& file : shelf->files()) out.names.push_back(file.filename().string());
  out.shown = shelf->shown().value_or(0);
  out.opening = shelf->opening();
  const Choosing& choosing = desk().choosing;
  if (!choosing.open) {
    files_.listed = -1;
    return out;
  }
  const std::string folder = choosing.folder.empty() ? present_folder() : choosing.folder;
  if (files_.listed < 0 || now - files_.listed >= kListEveryNs || files_.listing.folder != folder) {
    files_.listing = list_folder(folder);
    files_.recent.clear();
    for (std::string& path : read_recent(shelf->recent_list())) {
      std::error_code error;
      const bool there = fs::exists(path, error);
      files_.recent.push_back({std::move(path), there});
    }
    files_.listed = now;
  }
  out.recent = files_.recent;
  out.listing = files_.listing;
  return out;
}

}  // namespace dubsar::app
