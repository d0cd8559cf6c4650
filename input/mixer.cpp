#include "input/mixer.h"

#include <algorithm>

#include "input/event_limit.h"

namespace dubsar {
namespace {

constexpr TimestampNs kKeeps = 300'000'000;

template <class T>
bool any_tracked(const std::vector<T>& things) {
  return std::any_of(things.begin(), things.end(), [](const T& t) { return t.tracked; });
}

}  // namespace

void InputMixer::add(std::unique_ptr<InputSource> source, int rank) {
  const std::scoped_lock lock(mutex_);
  const auto after =
      std::find_if(sources_.begin(), sources_.end(), [&](const Entry& entry) { return entry.rank > rank; });
  sources_.insert(after, {std::move(source), {}, Freshness::kLost, rank});
}

bool InputMixer::remove(const InputSource* source) {
  std::unique_ptr<InputSource> gone;  // ends outside the lock: its thread may be in a read that takes a second
  const std::scoped_lock lock(mutex_);
  if (touching_ == source) touching_ = nullptr;
  const auto at =
      std::find_if(sources_.begin(), sources_.end(), [&](const Entry& entry) { return entry.source.get() == source; });
  if (at == sources_.end()) return false;
  gone = std::move(at->source);
  sources_.erase(at);
  return true;
}

const InputFrame& InputMixer::poll(TimestampNs now) {
  const std::scoped_lock lock(mutex_);
  merged_ = {};
  for (Entry& entry : sources_) {
    entry.frame.events.clear();
    entry.frame.touches.clear();
    entry.freshness = entry.source->poll(now, entry.frame);
    const std::size_t room = kMostEvents - std::min(kMostEvents, merged_.events.size());
    const auto count = static_cast<std::ptrdiff_t>(std::min(room, entry.frame.events.size()));
    merged_.events.insert(merged_.events.end(), entry.frame.events.begin(), entry.frame.events.begin() + count);
    if (!entry.frame.touches.empty() && (touching_ == nullptr || touching_ == entry.source.get())) {
      merged_.touches = std::move(entry.frame.touches);
      touching_ = merged_.touches.back().contacts.empty() ? nullptr : entry.source.get();
    }
    if (entry.freshness == Freshness::kLost) continue;
    merged_.time = std::max(merged_.time, entry.frame.time);
    for (std::size_t side = 0; side < 2; ++side)
      if (!merged_.grips[side].active) merged_.grips[side] = entry.frame.grips[side];
    if (entry.frame.space_mouse && !merged_.space_mouse) merged_.space_mouse = entry.frame.space_mouse;
  }
  std::stable_sort(merged_.events.begin(), merged_.events.end(),
                   [](const InputEvent& a, const InputEvent& b) { return a.time < b.time; });
  const auto pick = [&](auto member, Owner& owner) {
    for (const Entry& entry : sources_) {
      if (entry.freshness == Freshness::kLost) continue;
      const bool tracked = any_tracked(entry.frame.*member);
      const bool owns = owner.source == entry.source.get() && now < owner.until;
      if (!tracked && !owns) continue;
      if (tracked) owner = {entry.source.get(), now + kKeeps};
      merged_.*member = entry.frame.*member;
      return;
    }
  };
  pick(&InputFrame::hands, hands_);
  pick(&InputFrame::heads, heads_);
  return merged_;
}

void InputMixer::recentre() {
  const std::scoped_lock lock(mutex_);
  for (const Entry& entry : sources_) entry.source->recentre();
}

SourceState InputMixer::describe(const Entry& entry) {
  return {std::string(entry.source->name()), entry.freshness, entry.frame.time, entry.source->note()};
}

std::vector<SourceState> InputMixer::states() const {
  const std::scoped_lock lock(mutex_);
  std::vector<SourceState> out;
  for (const Entry& entry : sources_) out.push_back(describe(entry));
  return out;
}

std::optional<SourceState> InputMixer::state_of(const InputSource* source) const {
  const std::scoped_lock lock(mutex_);
  for (const Entry& entry : sources_)
    if (entry.source.get() == source) return describe(entry);
  return std::nullopt;
}

bool InputMixer::empty() const {
  const std::scoped_lock lock(mutex_);
  return sources_.empty();
}

bool InputMixer::endless() const {
  const std::scoped_lock lock(mutex_);
  return std::any_of(sources_.begin(), sources_.end(), [](const Entry& e) { return !e.source->has_end(); });
}

bool InputMixer::finished() const {
  const std::scoped_lock lock(mutex_);
  const auto ends = [](const Entry& entry) { return entry.source->finished(); };
  return std::any_of(sources_.begin(), sources_.end(), [](const Entry& e) { return e.source->has_end(); }) &&
         std::all_of(sources_.begin(), sources_.end(), [&](const Entry& e) { return !e.source->has_end() || ends(e); });
}

}  // namespace dubsar
