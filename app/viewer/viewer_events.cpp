// The queue of a session's events: one after the other, and whoever takes one first has it.

#include <algorithm>
#include <utility>

#include "app/viewer/viewer.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kKeySteps = std::uint64_t{1} << 63;  // told apart from movements

}  // namespace

void Viewer::handle(InputEvent event) {
  if (options_.time.fps > 0) event.time = given_.clock.now();
  input_.queue.push_back({std::move(event), false});
}

void Viewer::use_events(TimestampNs now) {
  while (!input_.queue.empty()) {
    Queued next = std::move(input_.queue.front());
    input_.queue.pop_front();
    use(std::move(next), now);
  }
}

/// Whoever leads the session, panels, tools, and at last the keys.
void Viewer::use(Queued next, TimestampNs now) {
  InputEvent& event = next.event;
  if (options_.guide != nullptr && options_.guide->takes(event, now)) return;
  if (next.of_source) return use_key(event, true);
  if (event.at) scene_.window.pointer = *event.at;
  tools_->navigate.see(event);
  if (event.kind == EventKind::kKey && present_.words.behind)
    update_overlay(now);  // it may be typed into what was opened
  if (overlay_->take(event, scene_.window.layout)) {
    stage_->set_overlay(overlay_.get());  // what the pointer is on looks different
    if ((event.kind == EventKind::kButton && event.down) || event.key == "enter") ++scene_.window.presses;
    for (const std::string& command : overlay_->take_commands()) run(command, kKeySteps + scene_.window.presses);
    return;
  }
  if (event.at && event.kind != EventKind::kKey) editor_->ui().pointing.at = event.at;
  const auto tools = tools_->all();
  const auto took = std::find_if(tools.begin(), tools.end(), [&](Tool* const tool) { return tool->take(event); });
  if (took == tools.end()) return use_key(event, false);
  if (event.kind != EventKind::kButton) return;
  for (Tool* const tool : tools)
    if (tool != *took) tool->let_go();
}

/// Of a script, a recording or a SpaceMouse, or one that neither a panel nor a tool took.
void Viewer::use_key(const InputEvent& event, bool of_source) {
  if (event.kind != EventKind::kKey) return;
  const std::string text = said_.keys->command_for(key_chord(event), *editor_);
  const Command* const command = text.empty() ? nullptr : said_.commands->find(split_command(text).first);
  if (!of_source) {
    const auto rows = sources();
    const bool keyboard = std::any_of(rows.begin(), rows.end(), [](const SourceRow& row) {
      return row.spec == "keyboard" && row.health == SourceHealth::kPresent;
    });
    // Whoever steers, a window can be closed and asked for help.
    if (!keyboard && (command == nullptr || command->group != kWindowGroup)) return;
    if (input_.recorder) input_.recorder->add_event(event);
  }
  if (!event.down || command == nullptr || (event.repeat && !command->repeats)) return;
  if (!event.repeat) ++scene_.window.presses;
  run(text, kKeySteps + scene_.window.presses);
}

}  // namespace dubsar::app
