#include "devices/spacemouse/spacenav_protocol.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace dubsar {
namespace {

using Words = std::array<std::int32_t, 8>;
static_assert(sizeof(Words) == kSpacenavEventBytes);

constexpr std::int32_t kFirstOther = 4, kLastOther = 6;  // UEV_CFG, UEV_RAWAXIS, UEV_RAWBUTTON

bool within(const Words& words, std::size_t first, std::size_t last) noexcept {
  return std::all_of(words.begin() + static_cast<std::ptrdiff_t>(first),
                     words.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                     [](std::int32_t v) { return v >= -4096 && v <= 4096; });
}

double share(int value) { return std::clamp(static_cast<double>(value) / kSpacenavFullScale, -1.0, 1.0); }

}  // namespace

std::optional<SpacenavEvent> parse_spacenav(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kSpacenavEventBytes) return std::nullopt;
  Words words;
  std::memcpy(words.data(), bytes.data(), sizeof words);
  SpacenavEvent event;
  if (words[0] == 0) {
    if (!within(words, 1, 6) || words[7] < 0) return std::nullopt;
    event.translation = {words[1], words[2], words[3]};
    event.rotation = {words[4], words[5], words[6]};
    event.period_ms = words[7];
    return event;
  }
  if ((words[0] == 1 || words[0] == 2) && words[1] >= 0 && words[1] <= 255) {
    event.kind = static_cast<SpacenavEvent::Kind>(words[0]);
    event.button = words[1];
    return event;
  }
  if (words[0] == static_cast<std::int32_t>(SpacenavEvent::Kind::kDevice) && (words[1] == 0 || words[1] == 1)) {
    event.kind = SpacenavEvent::Kind::kDevice;
    event.removed = words[1] == 1;
    return event;
  }
  if ((words[0] >= kFirstOther && words[0] <= kLastOther) || (words[0] & ~0xFFFF) == kSpacenavTag) {
    event.kind = SpacenavEvent::Kind::kOther;
    return event;
  }
  return std::nullopt;
}

std::vector<std::byte> format_spacenav(const SpacenavEvent& event) {
  Words words{};
  words[0] = static_cast<std::int32_t>(event.kind);
  if (event.kind == SpacenavEvent::Kind::kMotion)
    words = {0,
             event.translation.x,
             event.translation.y,
             event.translation.z,
             event.rotation.x,
             event.rotation.y,
             event.rotation.z,
             event.period_ms};
  else
    words[1] = event.kind == SpacenavEvent::Kind::kDevice ? (event.removed ? 1 : 0) : event.button;
  std::vector<std::byte> bytes(kSpacenavEventBytes);
  std::memcpy(bytes.data(), words.data(), sizeof words);
  return bytes;
}

std::vector<std::byte> spacenav_hello(std::uint8_t version) {
  const std::int32_t word = kSpacenavHello | version;
  std::vector<std::byte> bytes(sizeof word);
  std::memcpy(bytes.data(), &word, sizeof word);
  return bytes;
}

Result<void> SpacenavProtocol::start(Transport& transport, TimestampNs now) {
  *this = {};
  sample_.time = now;
  return transport.write(spacenav_hello(1));
}

Result<void> SpacenavProtocol::keep_up(Transport&, TimestampNs now) {
  const bool deflected = sample_.translation != glm::dvec3(0.0) || sample_.rotation != glm::dvec3(0.0);
  if (deflected && now - moved_ > kSpacenavHoldsNs) let_go(now);
  return {};
}

void SpacenavProtocol::let_go(TimestampNs now) {
  sample_.translation = sample_.rotation = glm::dvec3(0.0);
  sample_.time = now;
  changed_ = true;
}

bool SpacenavProtocol::accept(std::span<const std::byte> bytes, TimestampNs now) {
  bool all_valid = true;
  while (!bytes.empty()) {
    const std::size_t wanted = (greeted_ ? kSpacenavEventBytes : sizeof(std::int32_t)) - pending_bytes_;
    const std::size_t taken = std::min(wanted, bytes.size());
    std::copy_n(bytes.begin(), taken, pending_.begin() + static_cast<std::ptrdiff_t>(pending_bytes_));
    pending_bytes_ += taken;
    bytes = bytes.subspan(taken);
    if (taken < wanted) break;
    if (!greeted_) {
      greeted_ = true;
      std::int32_t word = 0;
      std::memcpy(&word, pending_.data(), sizeof word);
      if ((word & ~0xFF) == kSpacenavHello) pending_bytes_ = 0;  // an old daemon sends events at once
      continue;
    }
    pending_bytes_ = 0;
    if (const auto event = parse_spacenav(pending_))
      apply(*event, now);
    else
      all_valid = false;
  }
  return all_valid;
}

void SpacenavProtocol::apply(const SpacenavEvent& event, TimestampNs now) {
  if (event.kind == SpacenavEvent::Kind::kOther) return;
  if (event.kind == SpacenavEvent::Kind::kDevice) {
    if (!event.removed) return;
    sample_.buttons = 0;  // a SpaceMouse that is gone pushes nothing
    let_go(now);
    return;
  }
  if (event.kind == SpacenavEvent::Kind::kMotion) {
    moved_ = now;
    // z and the turn about it are mirrored, as libspnav's own spnav_posrot_moveobj does for a right-handed scene
    sample_.translation = {share(event.translation.x), share(event.translation.y), share(-event.translation.z)};
    sample_.rotation = {share(event.rotation.x), share(event.rotation.y), share(-event.rotation.z)};
  } else if (event.button < 64) {
    const std::uint64_t bit = std::uint64_t{1} << event.button;
    sample_.buttons = event.kind == SpacenavEvent::Kind::kPress ? sample_.buttons | bit : sample_.buttons & ~bit;
  }
  sample_.time = now;
  changed_ = true;
}

std::optional<SpaceMouseSample> SpacenavProtocol::newest() {
  if (!std::exchange(changed_, false)) return std::nullopt;
  return sample_;
}

}  // namespace dubsar
