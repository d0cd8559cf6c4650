#include "devices/leap/rigel_driver.h"

#include <algorithm>
#include <array>
#include <string>

namespace dubsar {
namespace {

constexpr milliseconds kTimeout{1000};
constexpr std::uint32_t kDarkLabel = 1;  // as on the LMC1; not checked on a device

class RigelKind final : public StereoCameraKind {
 public:
  explicit RigelKind(const RigelOptions& options) : options_(options) {}

  Result<Stream> prepare(Transport& transport) override {
    DUBSAR_ASSIGN(const uvc::VideoFunction camera, uvc::read_camera(transport));
    DUBSAR_ASSIGN(units_, rigel::find_units(camera));
    if (camera.bulk_endpoint == 0)
      return fail(ErrorKind::kUnavailable,
                  "rigel: this camera sends its pictures isochronously, which is not supported: use "
                  "Ultraleap's service (--input leapc)");
    DUBSAR_ASSIGN(const uvc::FrameSize size, wanted_size(camera));
    DUBSAR_ASSIGN(calibration_, read_calibration(transport));
    line_ = read_embedded_line(transport);

    uvc::StreamBlock block;
    block.hint = 1;  // keep the frame interval, adjust the rest
    block.format_index = size.format_index;
    block.frame_index = size.frame_index;
    block.interval_100ns = size.interval_100ns;
    block.max_frame_bytes = static_cast<std::uint32_t>(size.frame_bytes());
    DUBSAR_ASSIGN(const uvc::StreamBlock agreed, uvc::commit_stream(transport, camera.stream_interface, block));

    DUBSAR_ASSIGN(const auto exposure, rigel::exposure_us(units_, options_.exposure_us));
    DUBSAR_ASSIGN(const auto gain, rigel::gain(units_, options_.gain_step));
    DUBSAR_ASSIGN(const auto dark, rigel::dark_frame_interval(units_, options_.dark_frame_interval));
    for (const auto& write : {exposure, gain, dark}) DUBSAR_TRY(uvc::send(transport, write));
    for (const auto& write : rigel::leds(units_, options_.leds)) DUBSAR_TRY(uvc::send(transport, write));
    return Stream{size.width, size.height, size.frame_bytes(),
                  std::min<std::size_t>(agreed.max_transfer_bytes, kMaxReportBytes)};
  }

  const std::optional<lmc1::Calibration>& calibration() const override { return calibration_; }

  void unpack(std::span<const std::byte> bytes, Frame& frame) override {
    const std::size_t view = frame.view_bytes();
    const auto width = static_cast<std::size_t>(frame.width);
    const std::span<std::uint8_t> left = std::span(frame.pixels).first(view),
                                  right = std::span(frame.pixels).last(view);
    rigel::split_rows(bytes, frame.width, left, right);
    frame.exposure_us = 0;
    frame.dark = options_.dark_frame_interval == 1;
    if (!line_ || frame.height < 2) return;
    const auto metadata = rigel::decode_metadata(*line_, bytes.last(2 * width));
    frame.exposure_us = static_cast<int>(std::min<std::uint32_t>(metadata.exposure_us, 65535));
    frame.dark = frame.dark || (options_.dark_frame_interval > 1 && metadata.frame_label == kDarkLabel);
    for (const std::span<std::uint8_t> eye : {left, right})
      std::copy_n(eye.end() - static_cast<std::ptrdiff_t>(2 * width), width,
                  eye.end() - static_cast<std::ptrdiff_t>(width));
  }

  void lights_out(Transport& transport) noexcept override {
    for (const auto& write : rigel::leds(units_, false)) (void)uvc::send(transport, write);
  }

 private:
  Result<uvc::FrameSize> wanted_size(const uvc::VideoFunction& camera) const {
    std::string sizes;
    for (const uvc::FrameSize& size : camera.frames) {
      // Two grey pixels pose as one of 16 bits, so that the advertised width is one eye's.
      if (size.bits_per_pixel == 16 && size.width == options_.width && size.height == options_.height) return size;
      sizes += fmt::format("{}{}x{}", sizes.empty() ? "" : ", ", size.width, size.height);
    }
    return fail(ErrorKind::kBadData, "rigel: no pictures of {}x{} with 16 bits, the device offers {}", options_.width,
                options_.height, sizes);
  }

  Result<lmc1::Calibration> read_calibration(Transport& transport) const {
    std::array<std::byte, lmc1::kCalibrationBytes> blob{};
    DUBSAR_ASSIGN(const std::size_t length,
                  transport.control(rigel::get_extension(units_, rigel::Selector::kCalibration), blob, kTimeout));
    return lmc1::decode_calibration(std::span(blob).first(std::min(length, blob.size())));
  }

  std::optional<rigel::EmbeddedLine> read_embedded_line(Transport& transport) const {
    std::array<std::byte, rigel::kEmbeddedLineBytes> bytes{};
    const auto length =
        transport.control(rigel::get_extension(units_, rigel::Selector::kEmbeddedLine), bytes, kTimeout);
    if (!length) return std::nullopt;  // older firmware stalls the request
    return rigel::decode_embedded_line(std::span(bytes).first(std::min(*length, bytes.size())));
  }

  const RigelOptions options_;
  rigel::Units units_;
  std::optional<lmc1::Calibration> calibration_;
  std::optional<rigel::EmbeddedLine> line_;
};

}  // namespace

std::unique_ptr<StereoCameraKind> rigel_kind(const RigelOptions& options) {
  return std::make_unique<RigelKind>(options);
}

}  // namespace dubsar
