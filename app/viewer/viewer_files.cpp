// Files of a session: one is shown, others are open or can be.

#include <system_error>

#include "app/document/join.h"
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

/// What was done to an object that stood at `home` done to one that stands at `next`; the light stays the next one's.
ViewState carried_over(const ViewState& home, const ViewState& seen, const ViewState& next) {
  ViewState out = next;
  if (seen.rotation != home.rotation)
    out.rotation = glm::normalize(seen.rotation * glm::conjugate(home.rotation) * next.rotation);
  out.zoom = next.zoom * seen.zoom / home.zoom;
  out.pan = next.pan + seen.pan - home.pan;
  return out;
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
Result<void> Viewer::leave_work() {
  if (!files_.session) return {};
  DUBSAR_ASSIGN(Document kept, files_.session->leave(document()));
  if (kept != document()) editor_->join(std::move(kept));
  return {};
}

/// That of the others, too, which could not be written when they were left.
Result<void> Viewer::leave_all_work() {
  Result<void> out;
  if (has_surface()) out = leave_work();
  for (auto& [key, left] : files_.left)
    if (left.session)
      if (const auto done = left.session->leave(left.history.now()); !done && out)
        out = tl::unexpected<Error>(done.error());
  return out;
}

/// Another one takes its place; its undo stays, and what could not be written.
void Viewer::leave_file() {
  constexpr std::size_t kMostLeft = 8;  // each has up to a thousand states of its document
  if (const auto done = leave_work(); !done) {
    log_warning("{}", done.error().message);
    files_.untold = done.error().message + "; it stays open in memory: go back and save_copy, or make room";
  }
  const std::string key = file_key();
  if (key.empty()) return;
  files_.left.insert_or_assign(key, LeftFile{std::move(files_.session), editor_->opened(), editor_->history()});
  for (auto at = files_.left.begin(); files_.left.size() > kMostLeft && at != files_.left.end();) {
    const LeftFile& left = at->second;
    const bool can_go = at->first != key && (!left.session || left.session->has_kept(left.history.now()));
    at = can_go ? files_.left.erase(at) : std::next(at);
  }
}

/// By which a file is known again in this window; empty: not at all.
std::string Viewer::file_key() const {
  const SourceFile& source = document().source;
  return source.content.empty() ? std::string() : source.path + "\n" + source.content;
}

void Viewer::keep_work(TimestampNs now) {
  if (!files_.session) return;
  auto kept = files_.session->keep(now, document());
  const std::string wrong = kept ? std::string() : kept.error().message;
  if (!wrong.empty() && wrong != files_.untold) {
    log_warning("{}", wrong);
    say(wrong + "; save_copy writes a copy elsewhere");
  }
  if (!kept || !files_.session->has_kept(document())) {
    if (!kept) files_.untold = wrong;
  } else {
    files_.untold.clear();
  }
  if (kept && *kept) take_joined(**std::move(kept));
  tell_of_files({});
}

/// What another window kept of the same surface is here, too.
void Viewer::take_joined(Document joined) {
  joined.now = document().now;
  editor_->join(std::move(joined));
  follow();
}

/// Says what is to be known of files, or else what there is to say.
void Viewer::tell_of_files(std::string otherwise) {
  std::string words;
  for (const std::string& sentence : files_.session ? files_.session->take_told() : std::vector<std::string>()) {
    log_warning("{}", sentence);
    if (words.empty()) words = sentence;
  }
  if (words.empty()) words = std::move(otherwise);
  if (!words.empty()) say(std::move(words));
}

/// Asks once more where the work could not be kept.
bool Viewer::may_end() {
  const auto done = leave_all_work();
  if (done || std::exchange(files_.asked, true)) return true;
  log_warning("{}", done.error().message);
  say(done.error().message + "; save_copy FILE.json keeps it elsewhere, Esc again ends without it");
  return false;
}

void Viewer::end() {
  if (may_end()) given_.presenter.end();
}

StepFigures Viewer::step_figures() const {
  const Mapping& mapping = given_.options.mapping;
  return {mapping.key_step_deg, mapping.key_zoom, mapping.zoom_min, mapping.zoom_max};
}

std::unique_ptr<Editor> Viewer::make_editor(Document document) {
  return std::make_unique<Editor>(std::move(document), *this, step_figures());
}

/// What tools need to know of the surface.
void Viewer::find_tools() {
  tools_.evidence = SurfaceEvidence(*given_.mesh);
  tools_.picker.emplace(*given_.mesh);
  tools_.slices = std::make_unique<SliceDesk>(
      *given_.mesh, stage_->box_mm(), scan_of(*given_.mesh, given_.options.work.surface, given_.options.work.scan));
}

/// Another surface takes the place of the present one, whose work is kept. Until it can be shown nothing changes.
Result<void> Viewer::put(OpenedSurface surface) {
  auto next = std::make_unique<OpenedSurface>(std::move(surface));
  DUBSAR_TRY(stage_->set_mesh(next->mesh));
  tell_room();
  ViewOptions& options = given_.options;
  const bool first = !has_surface();
  files_.untold.clear();
  if (!first) leave_file();
  const StyleChoice style = document().style;
  const LightPlace light = document().light;
  options.work = std::move(next->work);
  options.around.title = std::move(next->title);
  tools_.slices.reset();
  if (given_.surface_goes) given_.surface_goes();
  files_.opened = std::move(next);
  given_.mesh = &files_.opened->mesh;
  const ViewState was_home = home_of(this->document()), was = steering_->goal().first;
  Document document = first_document(options, *given_.mesh).document;
  if (files_.coarse && !options.work.restored) set_view(document, carried_over(was_home, was, view_of(document)));
  if (!first && !options.work.restored) {  // who compares tablets wants the same light on both
    document.style = style;
    document.light = light;
  }
  Desk desk = editor_->desk();
  desk.pending.clear();
  desk.beside.reset();
  desk.note = 0;
  desk.leaving = false;
  begin_file(std::move(document));
  editor_->desk() = std::move(desk);
  find_tools();
  tools_.press.reset();
  at_.film_since = at_.sweep_since = -1;
  editor_->desk().sweep.reset();
  steering_->set_home(home_of(this->document()));
  // What was coarse stood as it was scanned: it turns to where its writing is upright.
  steering_->go_to(view_of(this->document()), given_.clock.now(), files_.coarse != nullptr);
  if (!files_.coarse) show_document();
  files_.coarse.reset();
  say_what_was_found();
  return {};
}

/// The document of the file that is shown from now on: as it was left in this window, or as it was found.
void Viewer::begin_file(Document found) {
  editor_ = make_editor(std::move(found));
  files_.session = std::move(files_.opened->session);
  if (files_.session) files_.session->begin(document());
  if (const auto left = files_.left.find(file_key()); left != files_.left.end() && !file_key().empty()) {
    editor_ = std::make_unique<Editor>(std::move(left->second.history), std::move(left->second.opened), *this,
                                       step_figures());
    if (left->second.session) files_.session = std::move(left->second.session);
    files_.left.erase(left);
    if (files_.session)
      if (auto joined = files_.session->look(document())) editor_->join(*std::move(joined));
  }
  if (files_.session) editor_->set_others(files_.session->others());
}

void Viewer::say_what_was_found() {
  std::string words = first_words(given_.options.work, stage_->traits().worn);
  Document all;
  for (const OtherWork& other : editor_->others()) all = add_marks(all, other.work.document);
  if (const std::string more = marks_more(document(), add_marks(document(), all)); !more.empty())
    words = more + " of the surface that was here before are kept. Ctrl+K take_over: bring them here.";
  if (!files_.untold.empty()) words = files_.untold;
  tell_of_files(std::move(words));
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
