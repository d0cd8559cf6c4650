#include "devices/leap/leap_camera.h"

#include <array>
#include <utility>

#include "devices/leap/lmc1_driver.h"
#include "devices/leap/rigel_driver.h"

namespace dubsar {
namespace {

constexpr milliseconds kTimeout{1000};

constexpr std::array<LeapProduct, 5> kProducts{{
    {lmc1::kVendorId, lmc1::kProductId, "Leap Motion Controller", true},
    {rigel::kVendorId, rigel::kRigel, "Leap Motion Rigel", true},
    {rigel::kVendorId, rigel::kSir170, "Ultraleap Stereo IR 170", true},
    {rigel::kVendorId, 0x1204, "Ultraleap 3Di", false},
    {rigel::kVendorId, 0x1206, "Leap Motion Controller 2", false},
}};

Result<std::unique_ptr<StereoCameraKind>> find_kind(const LeapCameraOptions& options, Transport& transport) {
  std::array<std::byte, 18> device{};
  const auto length = transport.control(uvc::kGetDevice, device, kTimeout);
  if (!length && length.error().kind == ErrorKind::kUnavailable) return tl::unexpected<Error>(length.error());
  const auto u16 = [&](std::size_t at) {
    return static_cast<std::uint16_t>(static_cast<unsigned>(device[at]) | static_cast<unsigned>(device[at + 1]) << 8);
  };
  const LeapProduct* const product =
      length && *length == device.size() ? find_leap_product(u16(8), u16(10)) : kProducts.data();
  if (product == nullptr)
    return fail(ErrorKind::kBadData, "leap: the device is {:04x}:{:04x}, which is no Leap camera", u16(8), u16(10));
  if (!product->by_usb)
    return fail(ErrorKind::kUnavailable, "leap: {}: {}; {}", product->name, kLeapServiceReason, kLeapServiceRemedy);
  if (product->vendor_id == lmc1::kVendorId) {
    Lmc1Options lmc1;
    lmc1.exposure_us = options.exposure_us;
    lmc1.dark_frame_interval = options.dark_frame_interval;
    lmc1.calibration_settle = options.calibration_settle;
    return lmc1_kind(lmc1);
  }
  RigelOptions rigel;
  rigel.exposure_us = options.exposure_us;
  rigel.dark_frame_interval = options.dark_frame_interval;
  DUBSAR_ASSIGN(const uvc::VideoFunction camera, uvc::read_camera(transport));
  if (camera.find(640, 240) != nullptr) rigel.height = 240;
  return rigel_kind(rigel);
}

}  // namespace

std::span<const LeapProduct> leap_products() noexcept { return kProducts; }

const LeapProduct* find_leap_product(std::uint16_t vendor_id, std::uint16_t product_id) noexcept {
  for (const LeapProduct& product : kProducts)
    if (product.vendor_id == vendor_id && product.product_id == product_id) return &product;
  return nullptr;
}

std::unique_ptr<StereoCamera> make_leap_camera(OpenTransport open, const LeapCameraOptions& options,
                                               const Clock& clock) {
  return make_stereo_camera(
      std::move(open), [options](Transport& transport) { return find_kind(options, transport); }, clock);
}

}  // namespace dubsar
