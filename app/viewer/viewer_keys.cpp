// Events of a session's window: which of them are keys and clicks, and in which order they are used.

#include <algorithm>
#include <utility>

#include "app/viewer/viewer.h"
#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kKeySteps = std::uint64_t{1} << 63;  // told apart from movements

}  // namespace

void Viewer::handle(InputEvent event) {
  if (given_.options.time.fps > 0) event.time = given_.clock.now();
  if (event.at) tools_.pointer = *event.at;
  const bool goes_on = event.kind == EventKind::kWheel || (event.kind == EventKind::kPinch && event.down);
  if (!goes_on) tools_.wheeled.reset();
  if (given_.options.guide != nullptr && given_.options.guide->takes(event, given_.clock.now())) return;
  if (tools_.field_since >= 0 && event.kind == EventKind::kKey) {
    tools_.typed.push_back(std::move(event));
    return;
  }
  if (overlay_->take(event, layout())) {
    stage_->set_overlay(overlay_.get());  // what the pointer is on looks different
    if ((event.kind == EventKind::kButton && event.down) || event.key == "enter") ++at_.presses;
    for (const std::string& command : overlay_->take_commands()) run(command, kKeySteps + at_.presses);
    return;
  }
  if (event.at && event.kind != EventKind::kKey) editor_->desk().pointing.at = event.at;
  if (take_light(event) || take_handle(event) || take_click(event)) return;
  const bool pressed = event.down && (event.kind == EventKind::kButton || event.kind == EventKind::kPinch);
  if (event.kind == EventKind::kWheel || pressed) tell_depth(event);
  event = without_aside(std::move(event));
  const auto rows = sources_->rows();
  const bool keyboard = std::any_of(rows.begin(), rows.end(), [](const SourceRow& row) {
    return row.spec == "keyboard" && row.health == SourceHealth::kPresent;
  });
  if (event.kind == EventKind::kKey && !keyboard) {  // whoever steers, a window can be closed and asked for help
    const Command* const command =
        said_.commands->find(split_command(said_.keys->command_for(key_chord(event), *editor_)).first);
    if (command == nullptr || command->group != kWindowGroup) return;
    if (recorder_) recorder_->add_event(event);
    if (event.down) use_key(event);
    return;
  }
  expect(event);
  pass_on(event);
}

/// Keys come in their turn, which may be a picture later; what follows them has to know already what they will do.
void Viewer::expect(const InputEvent& event) {
  if (event.kind != EventKind::kKey || !event.down) return;
  const std::string text = said_.keys->command_for(key_chord(event), *editor_);
  const auto [command, argument] = split_command(text);
  const std::string tool = tools_.coming.value_or(desk().tool);
  if (command == "tool") tools_.coming = tool == argument ? "turn" : argument;
  if (given_.options.guide != nullptr) return;
  const bool field = event.key == kClickKey ? tool == "note" && desk().panels
                                            : (text == "palette" && !desk().palette) || text == "open";
  if (field) tools_.field_since = given_.clock.now();
}

void Viewer::type_what_waited(TimestampNs now) {
  constexpr TimestampNs kLongestNs = 2 * kSecondNs;  // whoever leads the session may have taken the key for himself
  if (tools_.field_since >= 0 && now - tools_.field_since < kLongestNs) return;
  tools_.field_since = -1;
  for (InputEvent& event : std::exchange(tools_.typed, {})) handle(std::move(event));
}

void Viewer::use_key(const InputEvent& event) {
  if (event.key == kClickKey) {
    tools_.field_since = -1;
    return event.at ? click(*event.at) : void();
  }
  const std::string text = said_.keys->command_for(key_chord(event), *editor_);
  if (text.empty()) return;
  const Command& command = *said_.commands->find(split_command(text).first);
  if (event.repeat && !command.repeats) return;
  if (!event.repeat) ++at_.presses;
  if (command.name == "tool") tools_.coming.reset();
  if (command.name == "palette" || command.name == "open") tools_.field_since = -1;
  run(text, kKeySteps + at_.presses);
}

}  // namespace dubsar::app
