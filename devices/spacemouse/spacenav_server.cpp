#include "devices/spacemouse/spacenav_server.h"

#include <algorithm>
#include <cstring>

namespace dubsar {
namespace {

// FreeSpacenav/spacenavd src/proto.h
enum Request : std::int32_t {
  kSetName = 0x1000,
  kSetSensitivity,
  kGetSensitivity,
  kSetMask,
  kGetMask,
  kDeviceName = 0x2000,
  kDevicePath,
  kDeviceAxes,
  kDeviceButtons,
  kDeviceUsbId,
  kDeviceType,
  kFirstSetting = 0x3000,  // even: set, odd: get
  kAxisSensitivity = 0x3002,
  kDeadZone = 0x3004,
  kAxisMap = 0x3008,
  kButtonMap = 0x300a,
  kButtonAction = 0x300c,
  kKeyMap = 0x300e,
  kSerialDevice = 0x3016,
  kRepeat = 0x3018,
  kLastSetting = 0x3019,
  kSave = 0x3ffe,
  kRestore,
  kReset,
};

constexpr std::int32_t kFloatOne = 0x3f800000;
constexpr std::int32_t kCompact = 0x20f;  // the type "SpaceMouse Compact"
constexpr std::size_t kChunkBytes = 24;
constexpr std::int32_t kMoreChunks = 0x10000;
constexpr std::string_view kName = "simulated SpaceMouse", kPath = "/dev/input/simulated";
constexpr std::int32_t kMostIndex = 64;

template <class Words>
void append(std::vector<std::byte>& out, const Words& words) {
  const auto bytes = std::as_bytes(std::span(words));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// A text in pieces of 24 bytes; the last word says how much is left, and which piece is the first.
void append_text(std::vector<std::byte>& out, std::int32_t type, std::string_view text) {
  bool first = true;
  do {
    std::array<std::int32_t, 8> words{};
    words[0] = type;
    std::memcpy(&words[1], text.data(), std::min(text.size(), kChunkBytes));
    words[7] = static_cast<std::int32_t>(text.size()) | (first ? 0 : kMoreChunks);
    append(out, words);
    text.remove_prefix(std::min(text.size(), kChunkBytes));
    first = false;
  } while (!text.empty());
}

bool is_indexed(std::int32_t set_number) {
  return set_number == kDeadZone || (set_number >= kAxisMap && set_number <= kKeyMap);
}

}  // namespace

std::vector<std::byte> SpacenavServerSide::accept(std::span<const std::byte> bytes) {
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  std::vector<std::byte> out;
  for (std::size_t wanted = 0;;) {
    wanted = version_ == 0 ? sizeof(std::int32_t) : sizeof(Words);
    if (pending_.size() < wanted) return out;
    Words words{};
    std::memcpy(words.data(), pending_.data(), wanted);
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(wanted));
    if (version_ != 0) {
      answer(words, out);
    } else if ((words[0] & ~0xFF) == kSpacenavHello) {
      version_ = std::min(words[0] & 0xFF, 1);
      append(out, std::array{kSpacenavHello | version_});
    } else {
      sensitivity_bits_ = words[0];
    }
  }
}

std::vector<std::byte> SpacenavServerSide::tell(const SpacenavEvent& event) const {
  const std::int32_t bit = event.kind == SpacenavEvent::Kind::kMotion   ? 1
                           : event.kind == SpacenavEvent::Kind::kDevice ? 4
                           : event.kind == SpacenavEvent::Kind::kOther  ? 8
                                                                        : 2;
  if ((mask_ & bit) == 0 || (version_ == 0 && bit > 2)) return {};
  return format_spacenav(event);
}

void SpacenavServerSide::answer(const Words& request, std::vector<std::byte>& out) {
  Words words = request;
  const std::int32_t number = request[0] & 0xFFFF;
  if (number == kSetName) return;  // in pieces, and never answered
  if (number == kSerialDevice || number == kDeviceName || number == kDevicePath || number == kSerialDevice + 1) {
    if (number == kSerialDevice) return;
    append_text(out, request[0], number == kDeviceName ? kName : number == kDevicePath ? kPath : std::string_view());
    return;
  }
  bool known = true;
  switch (number) {
    case kSetSensitivity:
      sensitivity_bits_ = words[1];
      break;
    case kGetSensitivity:
      words[1] = sensitivity_bits_;
      break;
    case kSetMask:
      mask_ = words[1];
      break;
    case kGetMask:
      words[1] = mask_;
      break;
    case kDeviceAxes:
      words[1] = 6;
      break;
    case kDeviceButtons:
      words[1] = 2;
      break;
    case kDeviceUsbId:
      words[1] = 0x256f;
      words[2] = 0xc635;
      break;
    case kDeviceType:
      words[1] = kCompact;
      break;
    case kReset:
      set_.clear();
      break;
    case kSave:
    case kRestore:
      break;
    default:
      known = settings(number, words);
  }
  words[7] = known ? 0 : -1;
  append(out, words);
}

/// Sets or gets one setting in `words`; false: there is none of this number or index.
bool SpacenavServerSide::settings(std::int32_t number, Words& words) {
  if (number < kFirstSetting || number > kLastSetting) return false;
  const std::int32_t set_number = number & ~1;
  std::int32_t key = set_number << 8;
  if (is_indexed(set_number)) {
    if (words[1] < 0 || words[1] >= kMostIndex) return false;
    key |= words[1];
  }
  if (number == set_number) {
    set_[key] = words;
    return true;
  }
  if (const auto found = set_.find(key); found != set_.end()) {
    std::copy_n(found->second.begin() + 1, 6, words.begin() + 1);
    return true;
  }
  if (set_number == kFirstSetting) words[1] = kFloatOne;
  if (set_number == kAxisSensitivity) std::fill_n(words.begin() + 1, 6, kFloatOne);
  if (set_number == kRepeat) words[1] = -1;
  if (set_number == kAxisMap || set_number == kButtonMap) words[2] = words[1];
  if (set_number == kDeadZone) words[2] = 2;
  return true;
}

}  // namespace dubsar
