#include "tests/lab/uhid_device.h"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace dubsar::lab {
namespace {

using std::chrono::steady_clock;

template <std::size_t N>
void put_text(const std::string& text, __u8 (&field)[N]) {
  std::memcpy(field, text.data(), std::min(text.size(), N - 1));
}

bool send_event(int uhid, const uhid_event& event) { return ::write(uhid, &event, sizeof event) == sizeof event; }

}  // namespace

UhidDevice::UhidDevice(HidIdentity identity, OpenTransport simulator, std::function<void()> live, milliseconds period)
    : identity_(std::move(identity)), open_simulator_(std::move(simulator)), live_(std::move(live)), period_(period) {}

Result<void> UhidDevice::plug() {
  unplug();
  DUBSAR_ASSIGN(auto simulator, open_simulator_());
  uhid_ = ::open("/dev/uhid", O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (uhid_ < 0) return fail_errno(errno, "uhid: cannot open /dev/uhid");
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& create = event.u.create2;
  put_text(identity_.name, create.name);
  put_text(identity_.serial, create.uniq);
  const auto& descriptor = identity_.report_descriptor;
  create.rd_size = static_cast<__u16>(descriptor.size());
  std::copy(descriptor.begin(), descriptor.end(), create.rd_data);
  create.bus = BUS_USB;
  create.vendor = identity_.vendor_id;
  create.product = identity_.product_id;
  if (!send_event(uhid_, event)) {
    const int error = errno;
    ::close(uhid_);
    uhid_ = -1;
    return fail_errno(error, "uhid: the kernel refuses " + identity_.name);
  }
  stopping_ = false;
  thread_ = std::thread([this, held = std::move(simulator)] { run(*held); });
  return {};
}

void UhidDevice::unplug() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
  if (uhid_ >= 0) ::close(uhid_);  // the kernel takes the device away
  uhid_ = -1;
}

void UhidDevice::run(Transport& simulator) {
  auto due = steady_clock::now();
  while (!stopping_) {
    const auto left = std::chrono::ceil<milliseconds>(due - steady_clock::now());
    pollfd wait{uhid_, POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1000))) > 0)
      while (answer(simulator)) {
      }
    if (steady_clock::now() < due) continue;
    due = std::max(due + period_, steady_clock::now());
    live_();
    uhid_event event{};
    event.type = UHID_INPUT2;
    const auto report = std::as_writable_bytes(std::span(+event.u.input2.data, UHID_DATA_MAX));
    for (;;) {
      const auto length = simulator.read(report, milliseconds(0));
      if (!length || *length == 0) break;
      event.u.input2.size = static_cast<__u16>(*length);
      (void)send_event(uhid_, event);
    }
  }
}

bool UhidDevice::answer(Transport& simulator) {
  uhid_event event{};
  if (::read(uhid_, &event, sizeof event) <= 0) return false;
  switch (event.type) {
    case UHID_OUTPUT:
      (void)simulator.write(std::as_bytes(std::span(+event.u.output.data, event.u.output.size)));
      break;
    case UHID_SET_REPORT: {
      const uhid_set_report_req asked = event.u.set_report;
      const auto report = std::as_bytes(std::span(+asked.data, asked.size));
      const bool done = asked.rtype == UHID_FEATURE_REPORT ? simulator.set_feature(report).has_value()
                                                           : simulator.write(report).has_value();
      uhid_event reply{};
      reply.type = UHID_SET_REPORT_REPLY;
      reply.u.set_report_reply.id = asked.id;
      reply.u.set_report_reply.err = done ? 0 : EIO;
      (void)send_event(uhid_, reply);
      break;
    }
    case UHID_GET_REPORT: {
      const uhid_get_report_req asked = event.u.get_report;
      uhid_event reply{};
      reply.type = UHID_GET_REPORT_REPLY;
      uhid_get_report_reply_req& answer = reply.u.get_report_reply;
      answer.id = asked.id;
      const auto length =
          simulator.get_feature(asked.rnum, std::as_writable_bytes(std::span(+answer.data, UHID_DATA_MAX)));
      answer.err = length ? 0 : EIO;
      answer.size = length ? static_cast<__u16>(*length) : __u16{0};
      (void)send_event(uhid_, reply);
      break;
    }
    default:
      break;  // start, stop, open, close: nothing to do
  }
  return true;
}

}  // namespace dubsar::lab
