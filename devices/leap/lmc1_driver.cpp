#include "devices/leap/lmc1_driver.h"

#include <array>
#include <optional>
#include <thread>
#include <utility>

namespace dubsar {
namespace {

constexpr milliseconds kControlTimeout{1000};

class Lmc1Kind final : public StereoCameraKind {
 public:
  explicit Lmc1Kind(const Lmc1Options& options) : options_(options) {}

  Result<Stream> prepare(Transport& transport) override {
    const lmc1::Mode* const mode = lmc1::find_mode(options_.width, options_.height);
    if (mode == nullptr)
      return fail(ErrorKind::kUsage, "leap: no video mode of {}x{}, expected 640 or 752 x 480, 240 or 120",
                  options_.width, options_.height);
    DUBSAR_ASSIGN(calibration_, read_lmc1_calibration(transport, options_.calibration_settle));
    DUBSAR_TRY(uvc::commit_stream(transport, lmc1::kStreamInterface, lmc1::request_mode(*mode)));
    DUBSAR_ASSIGN(const auto exposure, lmc1::exposure_us(options_.exposure_us));
    DUBSAR_ASSIGN(const auto gain, lmc1::analog_gain(options_.analog_gain_sixteenths));
    DUBSAR_ASSIGN(const auto dark, lmc1::dark_frame_interval(options_.dark_frame_interval));
    for (const auto& write : {lmc1::switch_on(lmc1::Switch::kHdr, false), lmc1::gamma(false), exposure, gain, dark})
      DUBSAR_TRY(uvc::send(transport, write));
    for (const lmc1::Switch led : kLeds) DUBSAR_TRY(uvc::send(transport, lmc1::switch_on(led, options_.leds)));
    return Stream{mode->width, mode->height, mode->frame_bytes(), 0};
  }

  const std::optional<lmc1::Calibration>& calibration() const override { return calibration_; }

  void unpack(std::span<const std::byte> bytes, Frame& frame) override {
    const auto metadata = lmc1::decode_metadata(bytes.last<lmc1::kMetadataBytes>());
    frame.exposure_us = metadata.exposure_us;
    // without dark frames every one is lit, whatever the label is (LeapUVC manual, "Image Metadata")
    const int interval = options_.dark_frame_interval;
    frame.dark = interval == 1 || (interval > 1 && metadata.label == 1);  // the label: not checked on a device
    const std::span<std::uint8_t> pixels(frame.pixels);
    lmc1::deinterleave(bytes, pixels.first(bytes.size() / 2), pixels.last(bytes.size() / 2));
  }

  void lights_out(Transport& transport) noexcept override {
    for (const lmc1::Switch led : kLeds) (void)uvc::send(transport, lmc1::switch_on(led, false));
  }

 private:
  static constexpr std::array<lmc1::Switch, 3> kLeds{lmc1::Switch::kLedLeft, lmc1::Switch::kLedCentre,
                                                     lmc1::Switch::kLedRight};
  const Lmc1Options options_;
  std::optional<lmc1::Calibration> calibration_;
};

}  // namespace

Result<lmc1::Calibration> read_lmc1_calibration(Transport& transport, milliseconds settle) {
  const auto sharpness = static_cast<std::uint8_t>(lmc1::Selector::kSharpness);
  const auto saturation = static_cast<std::uint8_t>(lmc1::Selector::kSaturation);
  std::array<std::byte, lmc1::kCalibrationBytes> blob{};
  for (std::size_t i = 0; i < blob.size(); ++i) {
    std::array<std::byte, 2> data{std::byte(static_cast<std::size_t>(lmc1::kCalibrationAddress) + i), std::byte{0}};
    DUBSAR_TRY(transport.control(lmc1::set_current(lmc1::kProcessingUnit, sharpness), data, kControlTimeout));
    if (settle > milliseconds{0} && transport.is_hardware()) std::this_thread::sleep_for(settle);
    DUBSAR_ASSIGN(const std::size_t length,
                  transport.control(lmc1::get_current(lmc1::kProcessingUnit, saturation), data, kControlTimeout));
    if (length != 2) return fail(ErrorKind::kBadData, "leap: calibration answer of {} bytes, expected 2", length);
    blob[i] = data[0];
  }
  return lmc1::decode_calibration(blob);
}

std::unique_ptr<StereoCameraKind> lmc1_kind(const Lmc1Options& options) { return std::make_unique<Lmc1Kind>(options); }

}  // namespace dubsar
