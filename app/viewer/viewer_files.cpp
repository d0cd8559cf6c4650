// Files of a session: one is shown, others are open or can be.

#include <filesystem>

#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/system/log.h"

namespace dubsar::app {
/// Shows the file that was read meanwhile, or says why it cannot be; nothing where none was.
std::optional<Result<void>> Viewer::put_read() {
  auto read = given_.loader->take();
  if (!read) return std::nullopt;
  if (!*read) return tl::unexpected<Error>(read->error());
  return put(*std::move(*read));
}

/// What fell on the window; who leads a session says what is shown.
void Viewer::drop(const std::vector<std::string>& files) {
  if (given_.loader == nullptr || options_.guide != nullptr || files.empty()) return;
  if (const auto done = files_.list.open({files.begin(), files.end()}); !done) return say(done.error().message);
  editor_->ui().choosing.open = false;
}

/// Until the first file is there, what is known of it stands in its place.
void Viewer::take_coarse() {
  auto coarse = given_.loader->take_coarse();
  if (!coarse) return;
  if (has_surface()) return given_.loader->coarse_was_shown();  // it is not wanted
  auto mesh = std::make_unique<TriMesh>(*std::move(coarse));
  if (const auto done = stage_->set_mesh(*mesh); !done) {
    log_warning("{}", done.error().message);
    return given_.loader->coarse_was_shown();
  }
  files_.coarse = std::move(mesh);
}

/// Takes in a file that was read meanwhile.
void Viewer::take_surface() {
  if (given_.loader == nullptr || !files_.window_shown) return;
  given_.loader->start();
  take_coarse();
  const std::optional<Result<void>> done = put_read();
  if (!done || *done) return;
  const Error& why = done->error();
  if (!has_surface() && given_.loader->files().empty() && files_.first)
    return steps_.fail_with(why);  // what the session was begun for
  log_warning("{}", why.message);
  say(why.message);
  if (!has_surface() && !given_.loader->go_on()) editor_->ui().choosing.open = true;
}

std::string Viewer::title() const { return files_.list.title(has_surface() ? options_.around.title : std::string()); }

/// The window is called by the file that is shown, and the one that is being read.
void Viewer::name_window() {
  GlfwWindow* const window = given_.presenter.window();
  if (window == nullptr || given_.loader == nullptr) return;
  std::string name = title().empty() ? "dubsar" : "dubsar: " + title();
  if (name == files_.window_name) return;
  window->set_title(name);
  files_.window_name = std::move(name);
}

/// Another surface takes the place of the present one, whose work is kept. Until it can be shown nothing changes.
Result<void> Viewer::put(OpenedSurface surface) {
  auto next = std::make_unique<OpenedSurface>(std::move(surface));
  DUBSAR_TRY(stage_->set_mesh(next->mesh));
  const bool first = !has_surface();
  files_.kept.forget_trouble();
  if (!first) files_.kept.leave(*editor_);
  const StyleChoice style = document().style;
  const LightPlace light = document().light;
  options_.work = std::move(next->work);
  options_.around.title = std::move(next->title);
  tools_->slices.end();
  if (given_.surface_goes) given_.surface_goes();
  files_.opened = std::move(next);
  scene_.mesh = &files_.opened->mesh;
  const ViewState was_home = home_of(document()), was = input_.steering->goal().first;
  Document found = first_document(options_, mesh()).document;
  if (files_.coarse && !options_.work.restored) set_view(found, carried_over(was_home, was, view_of(found)));
  if (!first && !options_.work.restored) {  // who compares tablets wants the same light on both
    found.style = style;
    found.light = light;
  }
  UiState ui = editor_->ui();
  ui.pending.clear();
  ui.compared.reset();
  ui.note = 0;
  ui.pointing.wedge = 0;
  ui.leaving = false;
  ui.choosing.deleting = 0;
  ui.sweep.reset();
  editor_ = files_.kept.begin(
      std::move(found), std::move(files_.opened->session),
      [this](History history, Document opened) { return make_editor(std::move(history), std::move(opened)); });
  scene_.editor = editor_.get();
  editor_->ui() = std::move(ui);
  begin_surface();
  tools_->companion.set_own_name(options_.around.title);
  for (Tool* const tool : tools_->all()) tool->let_go();
  known_.film.stop();
  tools_->light.begin();
  present_.words.behind = true;
  input_.steering->set_home(home_of(document()));
  // What was coarse stood as it was scanned: it turns to where its writing is upright.
  input_.steering->go_to(view_of(document()), given_.clock.now(), files_.coarse != nullptr);
  if (!files_.coarse) stage_->show(scene_.shown(document(), view_of(document())), FollowedEyes(), given_.clock.now());
  files_.coarse.reset();
  files_.kept.say_what_was_found(*editor_, first_words(options_.work, stage_->traits().worn));
  return {};
}

}  // namespace dubsar::app
