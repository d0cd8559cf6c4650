#include "devices/touch/touch_protocol.h"

#include <algorithm>
#include <utility>

namespace dubsar {
namespace {

/// Where a place of the panel is in the picture, both as shares from the upper left corner.
glm::dvec2 turned(const glm::dvec2& at, int turn_deg) {
  switch (turn_deg) {
    case 90:
      return {1.0 - at.y, at.x};
    case 180:
      return {1.0 - at.x, 1.0 - at.y};
    case 270:
      return {at.y, 1.0 - at.x};
    default:
      return at;
  }
}

double share(std::int32_t value, std::int32_t low, std::int32_t high) {
  return std::clamp((static_cast<double>(value) - low) / (static_cast<double>(high) - low), 0.0, 1.0);
}

Result<EvdevAxis> ask(Transport& transport, std::uint16_t code) {
  std::array<std::byte, kMostAxisBytes> report{};
  const auto number = static_cast<std::uint8_t>(code);
  DUBSAR_ASSIGN(const std::size_t length, transport.get_feature(number, report));
  auto axis = parse_evdev_axis(number, std::span<const std::byte>(report).first(length));
  if (!axis) return fail(ErrorKind::kBadData, "touch: the device does not tell its axis {:#x}", code);
  return *std::move(axis);
}

Result<TouchSlots::State> ask_all(Transport& transport) {
  TouchSlots::State out;
  DUBSAR_ASSIGN(out.slot, ask(transport, kMtSlot));
  DUBSAR_ASSIGN(out.id, ask(transport, kMtTrackingId));
  DUBSAR_ASSIGN(out.x, ask(transport, kMtX));
  DUBSAR_ASSIGN(out.y, ask(transport, kMtY));
  auto tool = ask(transport, kMtToolType);
  if (!tool && tool.error().kind == ErrorKind::kUnavailable) return tl::unexpected<Error>(std::move(tool).error());
  if (tool) out.tool = *std::move(tool);
  return out;
}

}  // namespace

Result<void> TouchSlots::check(const State& state) {
  const std::size_t count = state.id.slots.size();
  if (count == 0 || state.x.slots.size() != count || state.y.slots.size() != count ||
      (state.tool && state.tool->slots.size() != count))
    return fail(ErrorKind::kBadData, "touch: {}, {} and {} slots found, expected as many of each axis", count,
                state.x.slots.size(), state.y.slots.size());
  if (state.x.minimum >= state.x.maximum || state.y.minimum >= state.y.maximum)
    return fail(ErrorKind::kBadData, "touch: axes of {} to {} and {} to {} found, expected a range", state.x.minimum,
                state.x.maximum, state.y.minimum, state.y.maximum);
  return {};
}

Result<TouchSlots> TouchSlots::create(const State& state, int turn_deg) {
  DUBSAR_TRY(check(state));
  TouchSlots out;
  out.turn_deg_ = turn_deg;
  out.slots_.resize(state.id.slots.size());
  DUBSAR_TRY(out.renew(state));
  for (Slot& slot : out.slots_) slot.ignored = slot.tracking_id >= 0;
  return out;
}

Result<void> TouchSlots::renew(const State& state) {
  DUBSAR_TRY(check(state));
  if (state.id.slots.size() != slots_.size())
    return fail(ErrorKind::kBadData, "touch: {} slots found, expected {} as before", state.id.slots.size(),
                slots_.size());
  range_ = {state.x.minimum, state.x.maximum, state.y.minimum, state.y.maximum};
  current_ = state.slot.value;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    track(slot, state.id.slots[i]);
    slot.x = state.x.slots[i];
    slot.y = state.y.slots[i];
    slot.tool = state.tool ? state.tool->slots[i] : 0;
  }
  return {};
}

/// Another number in the same slot is another finger, with or without a release between them.
void TouchSlots::track(Slot& slot, std::int32_t id) noexcept {
  if (id == slot.tracking_id || (id < 0 && slot.tracking_id < 0)) return;
  slot.tracking_id = id;
  slot.ignored = false;
  slot.contact = id < 0 ? 0 : ++contacts_;
}

void TouchSlots::take(const EvdevEvent& event) noexcept {
  if (event.code == kMtSlot) {
    current_ = event.value;
    return;
  }
  if (current_ < 0 || current_ >= static_cast<std::int64_t>(slots_.size())) return;
  Slot& slot = slots_[static_cast<std::size_t>(current_)];
  if (event.code == kMtTrackingId) track(slot, event.value);
  if (event.code == kMtX) slot.x = event.value;
  if (event.code == kMtY) slot.y = event.value;
  if (event.code == kMtToolType) slot.tool = event.value;
}

TouchFrame TouchSlots::frame(TimestampNs time) {
  TouchFrame out;
  out.time = time;
  const auto told = [&](std::uint32_t contact) {
    return std::find(told_.begin(), told_.end(), contact) != told_.end();
  };
  std::size_t down = 0;
  for (Slot& slot : slots_) {
    if (slot.tracking_id < 0) continue;
    ++down;
    if (slot.tool == kToolPalm && !slot.ignored) {
      slot.ignored = true;
      out.cancelled = out.cancelled || told(slot.contact);
    }
    if (slot.ignored) continue;
    const glm::dvec2 at(share(slot.x, range_[0], range_[1]), share(slot.y, range_[2], range_[3]));
    out.contacts.push_back({slot.contact, turned(at, turn_deg_)});
  }
  blob_ = down > 0 && (blob_ || out.contacts.size() > kMostTouches);
  if (blob_) {
    out.contacts.clear();
    out.cancelled = out.cancelled || !told_.empty();
  }
  std::sort(out.contacts.begin(), out.contacts.end(),
            [](const TouchContact& a, const TouchContact& b) { return a.id < b.id; });
  told_.clear();
  for (const TouchContact& contact : out.contacts) told_.push_back(contact.id);
  return out;
}

Result<void> TouchProtocol::start(Transport& transport, TimestampNs) {
  frames_.clear();
  last_.clear();
  timeline_ = {};
  loss_ = Loss::kNone;
  DUBSAR_ASSIGN(const TouchSlots::State state, ask_all(transport));
  DUBSAR_ASSIGN(slots_, TouchSlots::create(state, turn_deg_));
  return {};
}

Result<void> TouchProtocol::keep_up(Transport& transport, TimestampNs now) {
  if (loss_ != Loss::kAsks) return {};
  const auto state = ask_all(transport);
  if (!state) return tl::unexpected<Error>({ErrorKind::kUnavailable, state.error().message});
  if (const auto done = slots_.renew(*state); !done)
    return tl::unexpected<Error>({ErrorKind::kUnavailable, done.error().message});
  loss_ = Loss::kNone;
  TouchFrame frame = slots_.frame(now);
  for (const TouchContact& before : last_)  // lifted, or something else: nobody has seen it
    frame.cancelled = frame.cancelled || std::none_of(frame.contacts.begin(), frame.contacts.end(),
                                                      [&](const TouchContact& c) { return c.id == before.id; });
  add(std::move(frame));
  return {};
}

bool TouchProtocol::accept(std::span<const std::byte> bytes, TimestampNs now) {
  const auto events = parse_evdev(bytes);
  if (!events) return false;
  for (const EvdevEvent& event : *events) {
    const bool report = event.type == kEvSyn && event.code == kSynReport;
    if (event.type == kEvSyn && event.code == kSynDropped) {
      loss_ = Loss::kUntilReport;
    } else if (loss_ != Loss::kNone) {
      if (report) loss_ = Loss::kAsks;
    } else if (report) {
      add(slots_.frame(timeline_.host_time(event.time, now)));
    } else if (event.type == kEvAbs) {
      slots_.take(event);
    }
  }
  return true;
}

/// Of reports that change nothing (pressure, a palm) nothing is told.
void TouchProtocol::add(TouchFrame frame) {
  if (frame.contacts == last_ && !frame.cancelled) return;
  last_ = frame.contacts;
  add_touch_frame(frames_, std::move(frame), kMostFrames);
}

std::optional<TouchSample> TouchProtocol::newest() {
  if (frames_.empty()) return std::nullopt;
  TouchSample out{frames_.back().time, std::move(frames_)};
  frames_.clear();
  return out;
}

}  // namespace dubsar
