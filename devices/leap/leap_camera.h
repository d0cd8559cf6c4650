#pragma once
// Whichever Leap camera is plugged in: the products there are, and one driver that asks the device what it
// is.

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "devices/leap/stereo_camera.h"

namespace dubsar {

struct LeapProduct {
  std::uint16_t vendor_id = 0, product_id = 0;
  std::string_view name;
  bool by_usb = true;  ///< false: how its pictures are sent is not public, only the maker's service reaches it
};

/// In the order in which they are taken when several are plugged in.
std::span<const LeapProduct> leap_products() noexcept;
/// nullptr: not one of them.
const LeapProduct* find_leap_product(std::uint16_t vendor_id, std::uint16_t product_id) noexcept;

inline constexpr std::string_view kLeapServiceReason =
    "how its pictures are sent is not public: only Ultraleap's own service reaches it";
inline constexpr std::string_view kLeapServiceRemedy =
    "install Ultraleap's hand tracking software and use --input leapc";

struct LeapCameraOptions {
  int exposure_us = 200;
  int dark_frame_interval = 0;         ///< every n-th frame is taken without light; 0: none
  milliseconds calibration_settle{4};  ///< of the LMC1, as in Lmc1Options
};

/// Sizes that the hand tracker can use: 640x240 (binned rows) where the camera has it, else 640x480. A device
/// that does not say what it is (a recording without its descriptor) is taken for an LMC1; kUnavailable for
/// those that only the service reaches.
std::unique_ptr<StereoCamera> make_leap_camera(OpenTransport open, const LeapCameraOptions& options,
                                               const Clock& clock);

}  // namespace dubsar
