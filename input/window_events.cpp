#include "input/window_events.h"

#include <algorithm>

namespace dubsar {
namespace {

constexpr std::size_t kMost = 4096;

/// What a full queue can do without: see WindowEvents.
std::vector<InputEvent>::iterator least_missed(std::vector<InputEvent>& queue) {
  const auto value = [](const InputEvent& e) {
    if (e.kind == EventKind::kMotion) return 0;
    if (e.kind == EventKind::kWheel || e.repeat || (e.kind == EventKind::kPinch && e.down)) return 1;
    return e.down ? 2 : 3;
  };
  return std::min_element(queue.begin(), queue.end(),
                          [&](const InputEvent& a, const InputEvent& b) { return value(a) < value(b); });
}

class WindowSource final : public InputSource {
 public:
  WindowSource(WindowEvents* window, bool keys) : window_(window), keys_(keys) {}
  std::string_view name() const noexcept override { return keys_ ? "keyboard" : "mouse"; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs, InputFrame& newest) noexcept override {
    newest.events = window_->take(keys_);
    if (newest.events.empty()) return Freshness::kUnchanged;
    newest.time = newest.events.back().time;
    return Freshness::kNew;
  }

 private:
  WindowEvents* window_;
  bool keys_;
};

Result<std::unique_ptr<InputSource>> make(const InputConfig& config, bool keys) {
  const std::string_view name = keys ? "keyboard" : "mouse";
  if (!config.options.empty())
    return fail(ErrorKind::kUsage, "input {}: option \"{}\" found, expected none", name, config.options.front().key);
  if (config.window == nullptr)
    return fail(ErrorKind::kUnavailable,
                "input {}: there is no window to get it from; use scripted or replay without a window", name);
  return std::make_unique<WindowSource>(config.window, keys);
}

}  // namespace

void WindowEvents::push(const InputEvent& event) {
  const std::scoped_lock lock(mutex_);
  auto& queue = event.kind == EventKind::kKey ? keys_ : mouse_;
  if (event.kind == EventKind::kMotion && !queue.empty() && queue.back().kind == EventKind::kMotion &&
      queue.back().modifiers == event.modifiers) {
    queue.back().motion += event.motion;
    queue.back().time = event.time;
    queue.back().at = event.at;
    return;
  }
  if (queue.size() >= kMost) queue.erase(least_missed(queue));
  queue.push_back(event);
}

std::vector<InputEvent> WindowEvents::take(bool keys) {
  const std::scoped_lock lock(mutex_);
  return std::exchange(keys ? keys_ : mouse_, {});
}

Result<std::unique_ptr<InputSource>> make_mouse_source(const InputConfig& config) { return make(config, false); }
Result<std::unique_ptr<InputSource>> make_keyboard_source(const InputConfig& config) { return make(config, true); }

}  // namespace dubsar
