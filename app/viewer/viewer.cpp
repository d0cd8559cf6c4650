#include "app/viewer/viewer.h"

#include <algorithm>

#include "app/commands/sides.h"
#include "app/panels/panel_font.h"
#include "app/stage/marks.h"
#include "app/steering/worn_input.h"
#include "app/viewer/first_document.h"
#include "app/viewer/presenter/window_input.h"
#include "app/viewer/presenter/window_place.h"
#include "core/base/system/log.h"
#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kSettleNs = kSecondNs;
constexpr std::uint64_t kGuideSteps = std::uint64_t{1} << 62;

bool same_view(const ViewState& a, const ViewState& b) { return Shown{a} == Shown{b}; }

HeadFollowOptions follow_options(const StageOptions& stage) {
  HeadFollowOptions out;
  out.rest_m = 1e-3 * stage.viewer.centre_mm();
  out.ipd_m = 1e-3 * glm::length(stage.viewer.right_mm - stage.viewer.left_mm);
  return out;
}

}  // namespace

Result<std::unique_ptr<Viewer>> Viewer::create(const TriMesh& mesh, const ViewOptions& options, Presenter& presenter,
                                               const Clock& clock, std::unique_ptr<OutputSink> sink,
                                               const std::string& note, Shelf* shelf) {
  std::unique_ptr<Viewer> out(new Viewer(mesh, options, presenter, clock, shelf));
  DUBSAR_TRY(out->open(std::move(sink), note));
  return out;
}

Viewer::~Viewer() {
  if (steering_) steering_->stop();
  if (stage_) stage_->set_overlay(nullptr);
  tools_.slices.reset();
  sources_.reset();
}

Result<void> Viewer::open(std::unique_ptr<OutputSink> sink, const std::string& note) {
  const StageOptions& stage = given_.options.stage;
  said_.commands = std::make_unique<CommandTable>();
  if (given_.options.commands.empty()) {
    std::vector<std::string> styles;
    for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
    *said_.commands = CommandTable::standard(styles);
  } else {
    for (Command& command : window_commands()) said_.commands->add(std::move(command));
    for (const Command& command : given_.options.commands) said_.commands->add(command);
  }
  DUBSAR_TRY(check_steps(given_.options.steps, *said_.commands, "steps"));
  DUBSAR_ASSIGN(KeyTable keys, KeyTable::create(*said_.commands, given_.options.mapping.keys));
  said_.keys = std::make_unique<KeyTable>(std::move(keys));
  const Mapping& mapping = given_.options.mapping;
  FirstDocument first = first_document(given_.options, *given_.mesh);
  given_.options.work.doubt = std::move(first.doubt);
  editor_ = make_editor(std::move(first.document));
  if (given_.shelf != nullptr) given_.options.stage.subject = Subject::kLater;
  DUBSAR_ASSIGN(stage_, Stage::create(*given_.mesh, stage, std::move(sink)));
  DUBSAR_ASSIGN(tools_.font, LabelFont::create(panel_font()));
  find_tools();
  DUBSAR_ASSIGN(overlay_, Overlay::create(*said_.keys));
  if (given_.options.displays.empty()) {
    const GlfwWindow* const window = given_.presenter.window();
    displays_.specs =
        displays_for_window(stage.display, *stage.catalog,
                            {stage.screen, window != nullptr ? window->refresh_hz() : 0.0, stage.stereo_window});
  } else {
    displays_.specs = given_.options.displays;
    displays_.specs.insert(displays_.specs.begin(), stage.display);
  }
  editor_->desk().panels = given_.options.around.panels && stage_->traits().views == 1;
  editor_->desk().ui_scale = given_.options.around.scale;
  steering_ = std::make_unique<Steering>(mapping, view_of(document()), follow_options(stage));
  steering_->set_home(home_of(document()));
  files_.first = given_.shelf != nullptr && given_.shelf->busy();
  editor_->desk().choosing.open = given_.shelf != nullptr && !has_surface() && !files_.first;
  DUBSAR_TRY(start_sources());
  if (GlfwWindow* const window = given_.presenter.window()) {
    window->on_event([this, window](const WindowEvent& event) { handle(to_input_event(event, window->size())); });
    window->on_drop([this](const std::vector<std::string>& files) { drop(files); });
  }
  DUBSAR_TRY(place_changed());
  if (!note.empty()) {
    log_warning("{}", note);
    say(note);
  } else if (has_surface()) {
    say(first_words(given_.options.work, stage_->traits().worn));
  }
  if (has_surface()) show_document();
  if (given_.options.time.fps == 0) steering_->run(given_.clock);
  return {};
}

/// For a picture that is asked for before the turn of the loop that shows the surface has come to it.
void Viewer::show_document() {
  const ViewState view = view_of(document());
  stage_->show(shown_of(document(), view, given_.options.stage, stage_->box_mm()), FollowedEyes(), given_.clock.now());
}

Result<void> Viewer::start_sources() {
  InputConfig config;
  config.seen_view = [seen = steering_->seen()] { return seen->look(); };
  config.clock = &given_.clock;
  config.simulated_time = given_.options.time.fps > 0;
  config.model_folder = given_.options.sources.model_folder;
  if (stage_->traits().worn) config.worn = displays_.worn = std::make_shared<WornFeed>();
  config.panel_m = 1e-3 * glm::dvec2(given_.options.stage.screen.width_mm, given_.options.stage.screen.height_mm);
  std::vector<std::string> inputs = given_.options.inputs;
  if (given_.presenter.window() != nullptr) {
    config.window = &events_;
    config.hotplug = HotplugBell::of_this_machine();
    if (inputs.empty()) {
      inputs = {"mouse", "keyboard"};
      for (std::string& spec : present_inputs(given_.presenter.window()->fullscreen()))
        inputs.push_back(std::move(spec));
      if (displays_.worn) inputs.emplace_back("openxr");
    }
  }
  if (!given_.options.files.record.empty()) {
    DUBSAR_ASSIGN(recorder_, InputRecorder::create(given_.options.files.record));
    steering_->on_input([this](TimestampNs at, const InputFrame& frame) { recorder_->add(at, frame); });
  }
  sources_ = std::make_unique<SourceSet>(steering_->input(), config, given_.options.sources.make);
  return sources_->start(inputs);
}

Result<void> Viewer::place_changed() {
  static_cast<void>(given_.presenter.take_place_changed());
  if (!given_.presenter.visible()) return {};
  DUBSAR_TRY(stage_->set_screen(given_.presenter.screen(given_.options.stage.screen)));
  steering_->set_rest(stage_->rest_m());
  tell_room();
  return given_.presenter.fit(stage_->traits());
}

/// How large things are for a wearer's hands.
void Viewer::tell_room() {
  if (!stage_->traits().worn) return;
  steering_->set_room({1e-3 * stage_->window_mm().y, 0.5e-3 * glm::length(stage_->box_mm().size())});
}

/// What the headset said of its wearer goes to the source of hands.
void Viewer::feed_worn() {
  if (!displays_.worn) return;
  if (const auto wearer = stage_->wearer())
    displays_.worn->put(worn_sample(*wearer));
  else
    displays_.worn->absent(stage_->display_note());
}

Result<void> Viewer::switch_display(int step) {
  const std::size_t count = displays_.specs.size();
  for (std::size_t tried = 1; tried <= count; ++tried) {
    const std::size_t next = (displays_.shown + (step > 0   ? tried
                                                 : step < 0 ? tried * (count - 1)
                                                            : tried - 1)) %
                             count;
    auto done = stage_->set_display(displays_.specs[next]);
    if (done) done = place_changed();
    if (done) {
      displays_.shown = next;
      if (step != 0) editor_->desk().panels = given_.options.around.panels && stage_->traits().views == 1;
      if (step != 0) say("display " + display());
      log_info("display {}", display());
      return {};
    }
    log_warning("{}", done.error().message);
  }
  return fail(ErrorKind::kUnavailable, "none of {} displays can be shown", count);
}

void Viewer::recentre_heads() {
  steering_->input().recentre();
  stage_->recentre();
}

Result<void> Viewer::swap_eyes() {
  DUBSAR_TRY(stage_->swap_eyes());
  say("left and right eye exchanged");
  return {};
}

bool Viewer::toggle_source(std::size_t index) {
  if (!sources_->toggle(index)) return false;
  let_go_of_fingers();
  steering_->let_go_of_mouse();  // it may have been the mouse, with a button down
  at_.help_made = -1;
  return true;
}

void Viewer::say(std::string text) {
  if (!given_.options.around.notices) return;
  notice_ = {std::move(text), given_.clock.now()};
}

void Viewer::run(std::string_view text, std::uint64_t merge) {
  const Command* const command = said_.commands->find(split_command(text).first);
  if (command != nullptr && command->steers && !steering_->claim_for_keys(given_.clock.now())) return;
  if (const auto done = obey(text, merge); !done) say(done.error().message);
}

Result<void> Viewer::obey(std::string_view command, std::uint64_t merge) {
  keep_up();
  editor_->merge_with(merge);
  const Command* const known = said_.commands->find(split_command(command).first);
  files_.asked = files_.asked && known != nullptr && known->name == "close";
  if (known != nullptr && !has_surface() && given_.shelf != nullptr && known->group != kWindowGroup &&
      known->group != kFileGroup)
    return fail(ErrorKind::kUsage, "{}: there is no surface yet; Ctrl+O opens one", known->name);
  auto done = said_.commands->run(command, *editor_);
  editor_->merge_with(0);
  at_.help_made = -1;
  follow();
  return done;
}

/// Those of the options that are due.
void Viewer::say_steps(TimestampNs now) {
  const std::vector<TimedCommand>& steps = given_.options.steps;
  if (at_.began < 0) at_.began = now;
  const bool waits = opening() && (at_.steps >= steps.size() || steps[at_.steps].text != "stop_opening");
  if (waits && at_.stepped >= 0) at_.began += now - at_.stepped;
  at_.stepped = now;
  if (waits) return;  // what follows is about what is being read
  for (; at_.steps < steps.size() && !at_.failed; ++at_.steps) {
    const TimedCommand& step = steps[at_.steps];
    if (opening() && step.text != "stop_opening") return;
    if (1e-9 * static_cast<double>(now - at_.began) < step.time_s) return;
    if (const auto done = obey(step.text, 0); !done)
      at_.failed = Error{done.error().kind, fmt::format("at {} s: {}", step.time_s, done.error().message)};
  }
}

/// What people did to the view since the last time becomes part of the document, a movement as one step.
void Viewer::keep_up() {
  const auto [goal, movement] = steering_->goal();
  if (movement == 0 || same_view(goal, view_of(document()))) return;
  Document next = document();
  set_view(next, goal);
  editor_->merge_with(movement);
  editor_->change(std::move(next), "turn, move, zoom or light");
  editor_->merge_with(0);
}

/// What commands did to the view is gone to.
void Viewer::follow() {
  steering_->set_home(home_of(document()));
  if (!same_view(steering_->goal().first, view_of(document())))
    steering_->go_to(view_of(document()), given_.clock.now(), editor_->way() == Way::kGlide);
}

/// Whoever leads the session sees how things stand and says what is to be done.
void Viewer::lead(TimestampNs now, const Steered& steered) {
  SessionGuide* const guide = given_.options.guide;
  if (guide == nullptr) return;
  const std::vector<SourceRow> rows = sources_->rows();
  at_.guidance = guide->lead({now, steered, document(), rows, stage_->window_mm(), stage_->middle_mm(),
                              displays_.objects, displays_.trouble, has_surface(), given_.presenter.on_screen()});
  steering_->set_scene(at_.guidance.gestures);
  for (const std::string& command : at_.guidance.commands) run(command, kGuideSteps);
  if (!at_.guidance.scene || !at_.guidance.scene->keep) return;
  keep_up();
  Document next = guided_document(*at_.guidance.scene);
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
  if (words == displays_.trouble) return;
  displays_.trouble = words;
  say(words.empty() ? "all panels are there" : words);
}

void Viewer::presented(TimestampNs now) {
  at_.window_shown = true;
  if (files_.coarse) given_.shelf->coarse_was_shown();
  if (given_.options.guide != nullptr) given_.options.guide->presented(now);
}

void Viewer::tick(TimestampNs now, TimestampNs display_time, const RecentFigures& figures) {
  sources_->tick(now);
  take_surface();
  name_window();
  steering_->steer(now);
  if (use_fingers(now)) steering_->steer(now);
  for (const InputEvent& event : steering_->take_keys())
    if (given_.options.guide == nullptr || !given_.options.guide->takes(event, now)) use_key(event);
  say_steps(now);
  keep_up();
  Steered steered = steering_->look(now, display_time);
  lead(now, steered);
  steered.view.rotation = at_.guidance.turn * steered.view.rotation;
  const bool film = at_.film_since >= 0;
  const std::optional<GuidedScene>& scene = at_.guidance.scene;
  const Document seen = film ? shown_document(now) : scene ? guided_document(*scene) : document();
  ViewState view = film || (scene && scene->camera) ? view_of(seen) : steered.view;
  move_light(now, view);
  Shown shown = shown_of(seen, view, given_.options.stage, stage_->box_mm());
  shown.before = at_.guidance.lines;
  shown.lens_zoom = given_.options.guide == nullptr;  // who leads shows hands, which are as far away as they are
  shown.glow = at_.guidance.glow;
  shown.marks = marks_of(seen, desk(), shown.parts, *tools_.font, letters_scale());
  if (desk().beside) shown.beside = beside(view);
  if (shows_slices()) lay_slices(shown);
  stage_->show(shown, steered.eyes, now);
  if (given_.options.guide != nullptr) displays_.objects = object_places(*stage_, seen, shown.parts);
  point();
  report_.view = view;
  report_.viewer = stage_->viewer();
  report_.head = steered.eyes.presence;
  report_.control = steered.control;
  report_.moving = stage_->moved();
  report_.input_age = steered.input_age;
  report_.selected_m = steered.selected_m;
  if (recorder_ && !at_.recording_failed)
    if (const auto kept = recorder_->status(); !kept) {
      at_.recording_failed = true;
      log_warning("the recording has ended: {}", kept.error().message);
      say("the recording has ended: " + kept.error().message);
    }
  update_overlay(now, figures);
  type_what_waited(now);
  if (!has_surface()) return;
  keep_work(now);
}

Result<void> Viewer::paint(const Surface& target, Field field) {
  auto painted = stage_->paint(target, field);
  feed_worn();
  if (painted) report_.light = stage_->light();
  return painted;
}

bool Viewer::over(TimestampNs now) {
  const auto rows = sources_->rows();
  InputMixer& input = steering_->input();
  const bool waits_for_people = input.endless() || std::any_of(rows.begin(), rows.end(), [](const SourceRow& row) {
                                  return row.health == SourceHealth::kMissing;
                                });
  const bool busy = given_.shelf != nullptr && given_.shelf->busy();
  const bool steps_over = at_.steps == given_.options.steps.size() && !busy;
  if (waits_for_people || !(input.finished() || given_.options.inputs.empty()) || !steps_over) {
    at_.over_since = -1;
    return false;
  }
  if (at_.over_since < 0) at_.over_since = now;
  return now - at_.over_since >= kSettleNs;
}

Result<void> Viewer::finish() {
  steering_->stop();
  const auto kept = leave_all_work();
  for (const std::string& sentence : files_.session ? files_.session->take_told() : std::vector<std::string>())
    log_warning("{}", sentence);
  const auto recorded = recorder_ ? recorder_->finish() : Result<void>();
  return kept ? recorded : kept;
}

}  // namespace dubsar::app
