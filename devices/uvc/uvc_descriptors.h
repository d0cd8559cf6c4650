#pragma once
// What a camera says about itself in its USB configuration descriptor: units, picture sizes, the endpoint of
// its pictures.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "devices/transport/transport.h"

namespace dubsar::uvc {

using Guid = std::array<std::uint8_t, 16>;  ///< as it stands in the descriptor

struct ExtensionUnit {
  std::uint8_t unit = 0;
  Guid guid{};
};

/// One picture size of an uncompressed format.
struct FrameSize {
  std::uint8_t format_index = 0, frame_index = 0;
  int width = 0, height = 0;
  int bits_per_pixel = 0;
  std::uint32_t interval_100ns = 0;  ///< the default one
  constexpr std::size_t frame_bytes() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(bits_per_pixel) / 8;
  }
  bool operator==(const FrameSize&) const = default;
};

/// The first camera of a device.
struct VideoFunction {
  std::uint8_t control_interface = 0, stream_interface = 0;
  std::uint8_t bulk_endpoint = 0;  ///< to the host; 0: the pictures come isochronously
  std::optional<std::uint8_t> camera_terminal, processing_unit;
  std::vector<ExtensionUnit> extension_units;
  std::vector<FrameSize> frames;

  const FrameSize* find(int width, int height) const noexcept;
};

/// Any bytes may come in. kBadData: lengths that do not fit, or no camera in it.
Result<VideoFunction> parse_configuration(std::span<const std::byte> bytes);

/// Asks the device for its configuration descriptor and parses it.
Result<VideoFunction> read_camera(Transport& transport);

}  // namespace dubsar::uvc
