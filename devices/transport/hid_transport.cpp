#include "devices/transport/hid_transport.h"

#include <hidapi.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>

#include "core/base/system/clock.h"
#include "devices/udev_rule.h"

namespace dubsar {
namespace {

constexpr TimestampNs kSilenceBeforeLookNs = 250'000'000;

/// hidapi's global state: hid_open_path and hid_error(NULL) are not safe in several threads at once.
std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  return mutex;
}

std::string narrow(const wchar_t* text) {
  std::string out;
  for (; text && *text && out.size() < 256; ++text) out += *text >= 32 && *text < 127 ? static_cast<char>(*text) : '?';
  return out;
}

struct NodeIdentity {
  ::dev_t device;
  ::ino_t inode;
  bool operator==(const NodeIdentity&) const = default;
};

std::optional<NodeIdentity> identity_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return NodeIdentity{status.st_dev, status.st_ino};
}

class HidTransport final : public Transport {
 public:
  HidTransport(hid_device* device, std::string path, NodeIdentity identity, const Clock& clock, UsbId id)
      : device_(device), path_(std::move(path)), identity_(identity), clock_(&clock), heard_(clock.now()), id_(id) {}
  ~HidTransport() override { ::hid_close(device_); }

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    DUBSAR_TRY(check_present());
    const int milliseconds_left = static_cast<int>(std::clamp<std::int64_t>(timeout.count(), 0, 3'600'000));
    const int length =
        ::hid_read_timeout(device_, reinterpret_cast<unsigned char*>(report.data()), report.size(), milliseconds_left);
    if (length < 0) return lose(::hid_error(device_));
    const TimestampNs now = clock_->now();
    if (length > 0) {
      heard_ = now;
    } else if (now - heard_ >= kSilenceBeforeLookNs) {
      heard_ = now;
      if (identity_of(path_) != identity_) return lose(L"the device node has disappeared");
    }
    return static_cast<std::size_t>(length);
  }

  Result<void> write(std::span<const std::byte> report) override {
    DUBSAR_TRY(check_present());
    const int written = ::hid_write(device_, reinterpret_cast<const unsigned char*>(report.data()), report.size());
    if (written < 0) return refused("output report");
    return {};
  }

  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    DUBSAR_TRY(check_present());
    if (out.empty()) return fail(ErrorKind::kUsage, "hid: no room for feature report {}", id);
    out[0] = static_cast<std::byte>(id);
    const int length = ::hid_get_feature_report(device_, reinterpret_cast<unsigned char*>(out.data()), out.size());
    if (length < 0) return refused("request of a feature report");
    return std::min(static_cast<std::size_t>(length), out.size());
  }

  Result<void> set_feature(std::span<const std::byte> report) override {
    DUBSAR_TRY(check_present());
    const int written =
        ::hid_send_feature_report(device_, reinterpret_cast<const unsigned char*>(report.data()), report.size());
    if (written < 0) return refused("feature report");
    return {};
  }

  UsbId usb_id() const noexcept override { return id_; }

 private:
  tl::unexpected<Error> lose(const wchar_t* why) {
    lost_reason_ = fmt::format("hid: {}: the device is lost: {}", path_, narrow(why));
    return tl::unexpected<Error>({ErrorKind::kUnavailable, *lost_reason_});
  }
  Result<void> check_present() const {
    if (lost_reason_) return tl::unexpected<Error>({ErrorKind::kUnavailable, *lost_reason_});
    return {};
  }
  /// A refused report with its node gone is a loss, otherwise the device did not like it.
  tl::unexpected<Error> refused(std::string_view what) {
    const std::string why = narrow(::hid_error(device_));
    if (identity_of(path_) != identity_) return lose(L"the device node has disappeared");
    return fail(ErrorKind::kIo, "hid: {}: {} refused: {}", path_, what, why);
  }

  hid_device* device_;
  std::string path_;
  NodeIdentity identity_;
  const Clock* clock_;
  TimestampNs heard_;
  UsbId id_;
  std::optional<std::string> lost_reason_;
};

}  // namespace

Result<std::unique_ptr<Transport>> open_hid(const std::string& path, const Clock& clock, UsbId id) {
  const auto identity = identity_of(path);
  if (!identity) return fail(ErrorKind::kUnavailable, "hid: {} is not there", path);
  if (::access(path.c_str(), R_OK | W_OK) != 0) {
    const int error = errno;
    if (error == EACCES || error == EPERM)
      return fail(ErrorKind::kPermission, "hid: {} may not be opened by this user; {}", path, kUdevRemedy);
    return fail_errno(error, "hid: cannot open " + path);
  }
  const std::lock_guard lock(hidapi_mutex());
  hid_device* const device = ::hid_open_path(path.c_str());
  if (!device) return fail(ErrorKind::kIo, "hid: {} cannot be opened: {}", path, narrow(::hid_error(nullptr)));
  return std::make_unique<HidTransport>(device, path, *identity, clock, id);
}

}  // namespace dubsar
