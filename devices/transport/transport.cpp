#include "devices/transport/transport.h"

namespace dubsar {

Result<std::size_t> Transport::get_feature(std::uint8_t id, std::span<std::byte>) {
  return fail(ErrorKind::kUsage, "transport: feature report {} asked of a device without feature reports", id);
}

Result<void> Transport::set_feature(std::span<const std::byte>) {
  return fail(ErrorKind::kUsage, "transport: feature report sent to a device without feature reports");
}

Result<std::size_t> Transport::control(const ControlRequest& request, std::span<std::byte>, milliseconds) {
  return fail(ErrorKind::kUsage, "transport: control request {:#x} sent to a device that is not reached by USB",
              request.request);
}

}  // namespace dubsar
