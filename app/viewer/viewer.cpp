#include "app/viewer/viewer.h"

#include <algorithm>

#include "app/stage/object_places.h"
#include "app/words/text.h"
#include "core/base/system/log.h"
#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kSettleNs = kSecondNs;
constexpr std::uint64_t kGuideSteps = std::uint64_t{1} << 62;

bool same_view(const ViewState& a, const ViewState& b) { return Shown{a} == Shown{b}; }

}  // namespace

Result<std::unique_ptr<Viewer>> Viewer::create(const TriMesh& mesh, const ViewOptions& options, Given given,
                                               std::unique_ptr<OutputSink> sink, const std::string& note) {
  std::unique_ptr<Viewer> out(new Viewer(mesh, options, std::move(given)));
  DUBSAR_TRY(out->open(std::move(sink), note));
  return out;
}

Viewer::Viewer(const TriMesh& mesh, const ViewOptions& options, Given given)
    : options_(options),
      given_(std::move(given)),
      files_{FileList(given_.loader), KeptWork([this](std::string words) { say(std::move(words)); })},
      steps_(options_.steps) {
  scene_.mesh = &mesh;
  scene_.options = &options_.stage;
  scene_.window.waits = options_.time.fps > 0;
}

Viewer::~Viewer() {
  if (input_.steering) input_.steering->stop();
  if (stage_) stage_->set_overlay(nullptr);
  if (tools_) tools_->slices.end();
  input_.sources.reset();
}

void Viewer::run(std::string_view text, std::uint64_t merge) {
  const Command* const command = said_.commands->find(split_command(text).first);
  if (command != nullptr && command->steers && !input_.steering->claim_for_keys(given_.clock.now())) return;
  if (command != nullptr && command->enabled && !command->enabled(*editor_))
    return say(tr("say.nothing_to_do", tr(command->words)));
  if (command != nullptr && needs_surface(*command)) return say(tr("say.no_surface", tr(command->words)));
  if (const auto done = obey(text, merge); !done) say(done.error().message);
}

/// And there is none.
bool Viewer::needs_surface(const Command& command) const {
  return !has_surface() && given_.loader != nullptr && command.group != kWindowGroup && command.group != kFileGroup;
}

Result<void> Viewer::obey(std::string_view command, std::uint64_t merge) {
  keep_up();
  editor_->merge_with(merge);
  const Command* const known = said_.commands->find(split_command(command).first);
  if (known == nullptr || known->name != "close") files_.kept.goes_on();
  if (known != nullptr && needs_surface(*known))
    return fail(ErrorKind::kUsage, "{}: there is no surface yet; Ctrl+O opens one", known->name);
  auto done = said_.commands->run(command, *editor_);
  editor_->merge_with(0);
  present_.words.help_made = -1;
  present_.words.behind = true;
  follow();
  return done;
}

/// What people did to the view since the last time becomes part of the document, a movement as one step.
void Viewer::keep_up() {
  const auto [goal, movement] = input_.steering->goal();
  if (movement == 0 || same_view(goal, view_of(document()))) return;
  Document next = document();
  set_view(next, goal);
  editor_->merge_with(movement);
  editor_->change(std::move(next), "turn, move, zoom or light");
  editor_->merge_with(0);
}

/// What commands did to the view is gone to.
void Viewer::follow() {
  input_.steering->set_home(home_of(document()));
  if (!same_view(input_.steering->goal().first, view_of(document())))
    input_.steering->go_to(view_of(document()), given_.clock.now(), editor_->transition() == Transition::kGlide);
}

/// Whoever leads the session sees how things stand and says what is to be done.
void Viewer::lead(TimestampNs now, const Steered& steered) {
  SessionController* const guide = options_.guide;
  if (guide == nullptr) return;
  const std::vector<SourceRow> rows = sources();
  present_.led.guidance =
      guide->lead({now, steered, document(), rows, stage_->window_mm(), stage_->middle_mm(), present_.led.objects,
                   present_.led.trouble, has_surface(), given_.presenter.on_screen()});
  input_.steering->set_scene(present_.led.guidance.gestures);
  for (const std::string& command : present_.led.guidance.commands) run(command, kGuideSteps);
  if (!present_.led.guidance.scene || !present_.led.guidance.scene->keep) return;
  keep_up();
  Document next = guided_document(*present_.led.guidance.scene);
  next.notes = document().notes;
  editor_->merge_with(kGuideSteps);
  editor_->change(std::move(next), "shown");
  editor_->merge_with(0);
  follow();
}

/// The document as whoever leads the session wants it shown.
Document Viewer::guided_document(const GuidedScene& scene) const {
  Document out = document();
  show_keyframe(out, scene.frame);
  out.notes = scene.notes;
  if (scene.camera) return out;
  out.now = document().now;
  out.light = document().light;
  return out;
}

void Viewer::set_trouble(const std::string& words) {
  if (words == present_.led.trouble) return;
  present_.led.trouble = words;
  say(words.empty() ? tr("say.all_panels") : words);
}

void Viewer::presented(TimestampNs now) {
  files_.window_shown = true;
  if (files_.coarse) given_.loader->coarse_was_shown();
  if (options_.guide != nullptr) options_.guide->presented(now);
}

void Viewer::tick(TimestampNs now, TimestampNs display_time, const RecentFigures& figures) {
  if (given_.presenter.take_place_changed())
    if (auto done = displays_->place_changed(); !done) log_warning("{}", done.error().message);
  present_.words.figures = figures;
  measure_window();
  use_events(now);
  InputController& steering = *input_.steering;
  input_.sources->tick(now);
  take_surface();
  name_window();
  steering.steer(now);
  const auto fingers =
      known_.touch.events(steering.take_touches(), given_.presenter.screen(options_.stage.screen), now);
  for (const InputEvent& event : fingers) handle(event);
  use_events(now);
  if (!fingers.empty()) steering.steer(now);
  for (InputEvent& event : steering.take_keys()) input_.queue.push_back({std::move(event), true});
  use_events(now);
  steps_.update(
      now, [this] { return opening(); }, [this](const std::string& command) { return obey(command, 0); });
  keep_up();
  if (auto ended = known_.wedges.ended(*editor_)) say(*std::move(ended));
  if (auto ended = known_.exporter.ended()) say(*std::move(ended));
  Steered steered = steering.look(now, display_time);
  lead(now, steered);
  show(now, steered);
  if (input_.recorder && !input_.recording_failed)
    if (const auto kept = input_.recorder->status(); !kept) {
      input_.recording_failed = true;
      log_warning("the recording has ended: {}", kept.error().message);
      say(tr("say.recording_ended", kept.error().message));
    }
  update_overlay(now);
  if (has_surface() && files_.kept.keep(*editor_, now)) follow();
}

/// What the next picture shows.
void Viewer::show(TimestampNs now, const Steered& steered) {
  const bool film = known_.film.playing();
  const std::optional<GuidedScene>& scene = present_.led.guidance.scene;
  const Document seen = film ? known_.film.seen(document(), now) : scene ? guided_document(*scene) : document();
  ViewState view = steered.view;
  view.rotation = present_.led.guidance.turn * view.rotation;
  if (film || (scene && scene->camera)) view = view_of(seen);
  Shown shown = scene_.shown(seen, view);
  shown.before = present_.led.guidance.lines;
  shown.lens_zoom = options_.guide == nullptr;  // who leads shows hands, which are as far away as they are
  shown.glow = present_.led.guidance.glow;
  scene_.seen = &seen;
  tools_->box.hide(film);
  measure_window();
  for (Tool* const tool : tools_->all()) tool->update(now);
  if (const auto& wrong = tools_->companion.failed(); wrong && options_.time.fps > 0) steps_.fail_with(*wrong);
  for (Tool* const tool : tools_->all()) tool->contribute(shown);
  scene_.seen = nullptr;
  stage_->show(shown, steered.eyes, now);
  if (options_.guide != nullptr) present_.led.objects = object_places(*stage_, seen, shown.parts);
  tools_->marks.point();
  present_.report.view = shown.view;
  present_.report.view.pan = view.pan;  // what stands beside the surface moves the picture, not the view
  scene_.window.view = present_.report.view;
  present_.report.viewer = stage_->viewer();
  present_.report.head = steered.eyes.presence;
  present_.report.control = steered.control;
  present_.report.moving = stage_->moved();
  present_.report.input_age = steered.input_age;
}

Result<void> Viewer::paint(const Surface& target, Field field) {
  auto painted = stage_->paint(target, field);
  displays_->feed_worn();
  if (painted) present_.report.light = stage_->light();
  return painted;
}

bool Viewer::over(TimestampNs now) {
  const auto rows = sources();
  InputMixer& input = input_.steering->input();
  const bool waits_for_people = input.endless() || std::any_of(rows.begin(), rows.end(), [](const SourceRow& row) {
                                  return row.health == SourceHealth::kMissing;
                                });
  const bool steps_over = steps_.over() && !opening();
  if (waits_for_people || !(input.finished() || options_.inputs.empty()) || !steps_over) {
    input_.over_since = -1;
    return false;
  }
  if (input_.over_since < 0) input_.over_since = now;
  return now - input_.over_since >= kSettleNs;
}

Result<void> Viewer::finish() {
  input_.steering->stop();
  const auto kept = files_.kept.leave_all(worked_on());
  files_.kept.log_told();
  const auto recorded = input_.recorder ? input_.recorder->finish() : Result<void>();
  return kept ? recorded : kept;
}

void Viewer::tell(ViewResult& out) const {
  out.view = present_.report.view;
  out.display = display();
  out.rows = sources();
  out.sources = input_.steering->input().states();
  out.document = document();
  out.triangles = mesh().triangles.size();
}

}  // namespace dubsar::app
