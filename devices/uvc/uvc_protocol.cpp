#include "devices/uvc/uvc_protocol.h"

#include <cstring>

namespace dubsar::uvc {
namespace {

constexpr std::uint8_t kClassToInterface = 0x21;
constexpr std::uint8_t kClassFromInterface = 0xa1;
constexpr milliseconds kRequestTimeout{1000};

ControlRequest request(std::uint8_t type, std::uint8_t code, std::uint8_t interface, std::uint8_t unit,
                       std::uint8_t selector) noexcept {
  return {type, code, static_cast<std::uint16_t>(selector << 8), static_cast<std::uint16_t>(unit << 8 | interface)};
}

// Calls visit(offset, field) for the fields of a block in the order of the class definition, table 4-47.
template <class Block, class Visit>
void for_each_field(Block& block, const Visit& visit) {
  visit(0, block.hint);
  visit(2, block.format_index);
  visit(3, block.frame_index);
  visit(4, block.interval_100ns);
  visit(8, block.key_frame_rate);
  visit(10, block.p_frame_rate);
  visit(12, block.compression_quality);
  visit(14, block.compression_window);
  visit(16, block.delay_ms);
  visit(18, block.max_frame_bytes);
  visit(22, block.max_transfer_bytes);
}

}  // namespace

ControlRequest set_current(std::uint8_t interface, std::uint8_t unit, std::uint8_t selector) noexcept {
  return request(kClassToInterface, kSetCurrent, interface, unit, selector);
}
ControlRequest get_current(std::uint8_t interface, std::uint8_t unit, std::uint8_t selector) noexcept {
  return request(kClassFromInterface, kGetCurrent, interface, unit, selector);
}

ControlWrite control_write(const ControlRequest& to, std::uint32_t value, std::size_t bytes) noexcept {
  ControlWrite write{to, {}, bytes};
  for (std::size_t i = 0; i < bytes && i < write.data.size(); ++i) write.data[i] = std::byte(value >> 8 * i & 0xffU);
  return write;
}

std::array<std::byte, kStreamBlockBytes> encode(const StreamBlock& block) noexcept {
  std::array<std::byte, kStreamBlockBytes> bytes{};
  for_each_field(block,
                 [&](std::size_t at, const auto& field) { std::memcpy(bytes.data() + at, &field, sizeof field); });
  return bytes;
}

Result<StreamBlock> decode_stream_block(std::span<const std::byte> bytes) {
  if (bytes.size() != kStreamBlockBytes)
    return fail(ErrorKind::kBadData, "uvc: video probe block of {} bytes, expected {}", bytes.size(),
                kStreamBlockBytes);
  StreamBlock block;
  for_each_field(block, [&](std::size_t at, auto& field) { std::memcpy(&field, bytes.data() + at, sizeof field); });
  return block;
}

Result<StreamBlock> commit_stream(Transport& transport, std::uint8_t stream_interface, const StreamBlock& asked) {
  auto block = encode(asked);
  DUBSAR_TRY(transport.control(set_current(stream_interface, 0, kProbeControl), block, kRequestTimeout));
  DUBSAR_ASSIGN(const std::size_t length,
                transport.control(get_current(stream_interface, 0, kProbeControl), block, kRequestTimeout));
  DUBSAR_ASSIGN(const StreamBlock agreed, decode_stream_block(std::span(block).first(length)));
  if (agreed.format_index != asked.format_index || agreed.frame_index != asked.frame_index)
    return fail(ErrorKind::kBadData, "uvc: the device offers video mode {} of format {}, expected {} of {}",
                agreed.frame_index, agreed.format_index, asked.frame_index, asked.format_index);
  DUBSAR_TRY(transport.control(set_current(stream_interface, 0, kCommitControl), block, kRequestTimeout));
  return agreed;
}

Result<void> send(Transport& transport, const ControlWrite& write) {
  auto data = write.data;
  DUBSAR_TRY(transport.control(write.request, std::span(data).first(write.bytes), kRequestTimeout));
  return {};
}

}  // namespace dubsar::uvc
