// How a session begins.

#include "app/panels/panel_font.h"
#include "app/tools/window_input.h"
#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

HeadFollowOptions follow_options(const StageOptions& stage) {
  HeadFollowOptions out;
  out.rest_m = 1e-3 * stage.viewer.centre_mm();
  out.ipd_m = 1e-3 * glm::length(stage.viewer.right_mm - stage.viewer.left_mm);
  return out;
}

}  // namespace

Result<void> Viewer::make_vocabulary() {
  said_.commands = std::make_unique<CommandTable>();
  if (options_.commands.empty()) {
    std::vector<std::string> styles;
    for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
    *said_.commands = CommandTable::standard(styles);
  } else {
    for (Command& command : window_commands()) said_.commands->add(std::move(command));
    for (const Command& command : options_.commands) said_.commands->add(command);
  }
  DUBSAR_TRY(check_steps(options_.steps, *said_.commands, "steps"));
  DUBSAR_ASSIGN(KeyTable keys, KeyTable::create(*said_.commands, options_.mapping.keys));
  said_.keys = std::make_unique<KeyTable>(std::move(keys));
  return {};
}

std::unique_ptr<Editor> Viewer::make_editor(History history, Document opened) {
  const Mapping& mapping = options_.mapping;
  return std::make_unique<Editor>(
      std::move(history), std::move(opened), *place_,
      StepFigures{mapping.key_step_deg, mapping.key_zoom, mapping.zoom_min, mapping.zoom_max});
}

/// What tools ask for.
void Viewer::ask_the_session() {
  scene_.ask = {.run = [this](std::string_view command, std::uint64_t merge) { run(command, merge); },
                .say = [this](std::string words) { say(std::move(words)); },
                .key = [this](const InputEvent& event) { use_key(event, false); },
                .steers = [this](InputEvent event) { tools_->navigate.take(event); }};
}

/// What they are made with; none is started.
Result<void> Viewer::make_sources() {
  InputConfig config;
  config.seen_view = [seen = input_.steering->seen()] { return seen->look(); };
  config.clock = &given_.clock;
  config.simulated_time = options_.time.fps > 0;
  config.model_folder = options_.sources.model_folder;
  config.worn = displays_->worn();
  config.panel_m = 1e-3 * glm::dvec2(options_.stage.screen.width_mm, options_.stage.screen.height_mm);
  if (given_.presenter.window() != nullptr) {
    config.window = &input_.mouse;
    config.hotplug = HotplugBell::of_this_machine();
  }
  if (!options_.files.record.empty()) {
    DUBSAR_ASSIGN(input_.recorder, InputRecorder::create(options_.files.record));
    input_.steering->on_input([this](TimestampNs at, const InputFrame& frame) { input_.recorder->add(at, frame); });
  }
  input_.sources = std::make_unique<SourceSet>(input_.steering->input(), config, options_.sources.make);
  return {};
}

Result<void> Viewer::start_sources() {
  std::vector<std::string> inputs = options_.inputs;
  if (given_.presenter.window() != nullptr && inputs.empty()) {
    inputs = {"mouse", "keyboard"};
    for (std::string& spec : present_inputs(given_.presenter.window()->fullscreen())) inputs.push_back(std::move(spec));
    if (displays_->worn()) inputs.emplace_back("openxr");
  }
  return input_.sources->start(inputs);
}

/// What tools need to know of the surface.
void Viewer::begin_surface() {
  known_.evidence = SurfaceEvidence(mesh());
  scene_.picker.emplace(mesh());
  known_.wedges.stop();
  tools_->slices.begin(scan_of(mesh(), options_.work.surface, options_.work.scan));
}

Result<void> Viewer::open(std::unique_ptr<OutputSink> sink, const std::string& note) {
  DUBSAR_TRY(make_vocabulary());
  FirstDocument first = first_document(options_, mesh());
  options_.work.doubt = std::move(first.doubt);
  if (given_.loader != nullptr) options_.stage.subject = Subject::kLater;
  DUBSAR_ASSIGN(stage_, Stage::create(mesh(), options_.stage, std::move(sink)));
  scene_.stage = stage_.get();
  DUBSAR_ASSIGN(auto font, LabelFont::create(panel_font()));
  displays_ = std::make_unique<DisplaySwitch>(options_, given_.presenter, *stage_);
  input_.steering =
      std::make_unique<InputController>(options_.mapping, view_of(first.document), follow_options(options_.stage));
  displays_->seen_by(*input_.steering);
  DUBSAR_TRY(make_sources());
  LabelFont& letters = *font;
  tools_.reset(new Tools{LightTool(scene_), BoxTool(scene_), ClickTool(scene_),
                         NavigateTool(scene_, *input_.steering, input_.mouse), SlicesTool(scene_),
                         MarksTool(scene_, std::move(font)), WedgesTool(scene_),
                         CompanionTool(scene_, options_.sources.beside, letters)});
  tools_->companion.set_own_name(options_.around.title);
  place_ = std::make_unique<ViewerPlace>(
      ViewerPlace::Parts{options_,
                         given_.presenter,
                         given_.clock,
                         scene_,
                         *displays_,
                         *input_.steering,
                         *input_.sources,
                         files_.list,
                         tools_->slices,
                         known_.film,
                         known_.wedges,
                         known_.exporter,
                         tools_->companion,
                         {[this]() -> Result<void> {  // simulated time stands still while a file is read
                            if (options_.time.fps == 0) return {};
                            given_.loader->wait();
                            return put_read().value_or(Result<void>());
                          },
                          [this] {  // it may have been a touch panel, or the mouse with a button down
                            for (InputEvent& event : known_.touch.let_go(given_.clock.now())) handle(std::move(event));
                            input_.steering->let_go_of_mouse();
                            present_.words.help_made = -1;
                          },
                          [this] { return may_end(); }}});
  ask_the_session();
  editor_ = make_editor(History(first.document), first.document);
  scene_.editor = editor_.get();
  begin_surface();
  DUBSAR_ASSIGN(overlay_, Overlay::create(*said_.keys));
  files_.first = opening();
  UiState& ui = editor_->ui();
  ui.panels = displays_->panels_wanted();
  ui.ui_scale = options_.around.scale;
  ui.choosing.open = given_.loader != nullptr && !has_surface() && !files_.first;
  input_.steering->set_home(home_of(document()));
  DUBSAR_TRY(start_sources());
  if (GlfwWindow* const window = given_.presenter.window()) {
    window->on_event([this, window](const WindowEvent& event) { handle(to_input_event(event, window->size())); });
    window->on_drop([this](const std::vector<std::string>& files) { drop(files); });
  }
  DUBSAR_TRY(displays_->place_changed());
  if (!note.empty()) {
    log_warning("{}", note);
    say(note);
  } else if (has_surface()) {
    say(first_words(options_.work, stage_->traits().worn));
  }
  // For a picture that is asked for before the turn of the loop that shows the surface has come to it.
  if (has_surface()) stage_->show(scene_.shown(document(), view_of(document())), FollowedEyes(), given_.clock.now());
  if (options_.time.fps == 0) input_.steering->run(given_.clock);
  return {};
}

}  // namespace dubsar::app
