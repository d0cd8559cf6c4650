#include "devices/uvc/uvc_descriptors.h"

#include <algorithm>

#include "devices/uvc/uvc_protocol.h"

namespace dubsar::uvc {
namespace {

constexpr std::uint8_t kConfiguration = 2, kInterface = 4, kEndpoint = 5, kClassInterface = 36;
constexpr std::uint8_t kVideo = 14, kControlSubclass = 1, kStreamSubclass = 2;
constexpr std::size_t kConfigurationBytes = 9, kLongest = 4096;
constexpr milliseconds kDescriptorTimeout{1000};

/// One descriptor, bytes beyond its end read as 0.
class Descriptor {
 public:
  explicit Descriptor(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint8_t u8(std::size_t at) const {
    return at < bytes_.size() ? static_cast<std::uint8_t>(bytes_[at]) : std::uint8_t{0};
  }
  std::uint16_t u16(std::size_t at) const { return static_cast<std::uint16_t>(u8(at) | u8(at + 1) << 8); }
  std::uint32_t u32(std::size_t at) const { return u16(at) | static_cast<std::uint32_t>(u16(at + 2)) << 16; }
  std::size_t size() const { return bytes_.size(); }
  std::uint8_t type() const { return u8(1); }
  std::uint8_t subtype() const { return u8(2); }

 private:
  std::span<const std::byte> bytes_;
};

void read_control(const Descriptor& d, VideoFunction& camera) {
  constexpr std::uint8_t kInputTerminal = 2, kProcessingUnit = 5, kExtensionUnit = 6;
  constexpr std::uint16_t kCameraTerminalType = 0x0201;
  if (d.subtype() == kInputTerminal && d.u16(4) == kCameraTerminalType && d.size() >= 8)
    camera.camera_terminal = d.u8(3);
  if (d.subtype() == kProcessingUnit && d.size() >= 5) camera.processing_unit = d.u8(3);
  if (d.subtype() == kExtensionUnit && d.size() >= 20) {
    ExtensionUnit unit;
    unit.unit = d.u8(3);
    for (std::size_t i = 0; i < unit.guid.size(); ++i) unit.guid[i] = d.u8(4 + i);
    camera.extension_units.push_back(unit);
  }
}

struct Format {
  std::uint8_t index = 0;
  int bits_per_pixel = 0;
};

void read_stream(const Descriptor& d, Format& format, VideoFunction& camera) {
  constexpr std::uint8_t kUncompressedFormat = 4, kUncompressedFrame = 5;
  if (d.subtype() == kUncompressedFormat && d.size() >= 22) format = {d.u8(3), d.u8(21)};
  if (d.subtype() != kUncompressedFrame || d.size() < 26 || format.index == 0) return;
  FrameSize frame;
  frame.format_index = format.index;
  frame.frame_index = d.u8(3);
  frame.width = d.u16(5);
  frame.height = d.u16(7);
  frame.bits_per_pixel = format.bits_per_pixel;
  frame.interval_100ns = d.u32(21);
  if (frame.width > 0 && frame.height > 0 && frame.bits_per_pixel > 0) camera.frames.push_back(frame);
}

}  // namespace

const FrameSize* VideoFunction::find(int width, int height) const noexcept {
  const auto found = std::find_if(frames.begin(), frames.end(),
                                  [&](const FrameSize& f) { return f.width == width && f.height == height; });
  return found == frames.end() ? nullptr : &*found;
}

Result<VideoFunction> parse_configuration(std::span<const std::byte> bytes) {
  const Descriptor head(bytes.first(std::min(bytes.size(), kConfigurationBytes)));
  if (bytes.size() < kConfigurationBytes || head.type() != kConfiguration || head.u16(2) != bytes.size())
    return fail(ErrorKind::kBadData, "uvc: configuration descriptor of {} bytes that says {}", bytes.size(),
                head.u16(2));
  VideoFunction camera;
  Format format;
  int controls = 0, streams = 0;
  std::uint8_t subclass = 0;  // of the video interface that the descriptors belong to; 0: another one
  while (!bytes.empty()) {
    const auto length = static_cast<std::size_t>(bytes[0]);
    if (length < 2 || length > bytes.size())
      return fail(ErrorKind::kBadData, "uvc: a descriptor of {} bytes where {} are left", length, bytes.size());
    const Descriptor d(bytes.first(length));
    bytes = bytes.subspan(length);
    if (d.type() == kInterface) {
      subclass = d.u8(5) == kVideo ? d.u8(6) : std::uint8_t{0};
      const bool first_setting = d.u8(3) == 0;
      if (subclass == kControlSubclass && first_setting && ++controls == 1) camera.control_interface = d.u8(2);
      if (subclass == kStreamSubclass && first_setting && ++streams == 1) camera.stream_interface = d.u8(2);
    } else if (subclass == kControlSubclass && controls == 1 && d.type() == kClassInterface) {
      read_control(d, camera);
    } else if (subclass == kStreamSubclass && streams == 1 && d.type() == kClassInterface) {
      read_stream(d, format, camera);
    } else if (subclass == kStreamSubclass && streams == 1 && d.type() == kEndpoint) {
      const bool to_host = (d.u8(2) & 0x80U) != 0, bulk = (d.u8(3) & 3U) == 2;
      if (to_host && bulk) camera.bulk_endpoint = d.u8(2);
    }
  }
  if (controls == 0 || streams == 0 || camera.frames.empty())
    return fail(ErrorKind::kBadData,
                "uvc: the device has {} video controls, {} streams and {} uncompressed picture sizes, "
                "expected one of each at least",
                controls, streams, camera.frames.size());
  return camera;
}

Result<VideoFunction> read_camera(Transport& transport) {
  std::array<std::byte, kConfigurationBytes> head{};
  DUBSAR_ASSIGN(const std::size_t head_bytes, transport.control(kGetConfiguration, head, kDescriptorTimeout));
  const std::size_t total = Descriptor(head).u16(2);
  if (head_bytes < head.size() || total < head.size() || total > kLongest)
    return fail(ErrorKind::kBadData, "uvc: configuration descriptor of {} bytes that says {}, expected {} to {}",
                head_bytes, total, head.size(), kLongest);
  std::vector<std::byte> bytes(total);
  DUBSAR_ASSIGN(const std::size_t length, transport.control(kGetConfiguration, bytes, kDescriptorTimeout));
  return parse_configuration(std::span(bytes).first(std::min(length, total)));
}

}  // namespace dubsar::uvc
