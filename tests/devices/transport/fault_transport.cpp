#include "tests/devices/transport/fault_transport.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <random>
#include <utility>

#include "devices/transport/forwarding_transport.h"

namespace dubsar {
namespace {

constexpr std::pair<std::string_view, FaultKind> kNames[] = {{"drop", FaultKind::kDrop},
                                                             {"truncate", FaultKind::kTruncate},
                                                             {"garbage", FaultKind::kGarbage},
                                                             {"stall", FaultKind::kStall},
                                                             {"unplug", FaultKind::kUnplug}};

/// Takes `lead` and a number from the front of `text`.
std::optional<std::uint64_t> take_number(std::string_view& text, char lead) {
  if (text.empty() || text.front() != lead) return std::nullopt;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

class FaultTransport final : public ForwardingTransport {
 public:
  FaultTransport(std::unique_ptr<Transport> below, std::vector<Fault> faults, std::uint64_t seed)
      : ForwardingTransport(std::move(below)), faults_(std::move(faults)), random_(seed) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    DUBSAR_TRY(check_plugged());
    if (Fault* const stall = active(FaultKind::kStall)) {
      --stall->count;
      return std::size_t{0};
    }
    auto read = below().read(report, timeout);
    if (!read || *read == 0) return read;
    const Fault* const drop = active(FaultKind::kDrop);
    const Fault* const truncate = active(FaultKind::kTruncate);
    const bool garbage = active(FaultKind::kGarbage) != nullptr;
    ++report_number_;
    if (drop) return std::size_t{0};
    if (garbage)
      for (std::byte& byte : report.first(*read)) byte = static_cast<std::byte>(random_() & 0xFFU);
    return truncate ? std::min(*read, truncate->length) : *read;
  }
  Result<void> write(std::span<const std::byte> report) override {
    DUBSAR_TRY(check_plugged());
    return below().write(report);
  }
  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    DUBSAR_TRY(check_plugged());
    return below().get_feature(id, out);
  }
  Result<void> set_feature(std::span<const std::byte> report) override {
    DUBSAR_TRY(check_plugged());
    return below().set_feature(report);
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    DUBSAR_TRY(check_plugged());
    return below().control(request, data, timeout);
  }

 private:
  /// A fault of this kind that concerns the next report; stalls count down, the others end by report number.
  Fault* active(FaultKind kind) {
    for (Fault& fault : faults_) {
      if (fault.kind != kind || fault.count == 0 || report_number_ < fault.at) continue;
      if (kind == FaultKind::kStall || report_number_ - fault.at < fault.count) return &fault;
    }
    return nullptr;
  }
  Result<void> check_plugged() {
    if (!unplugged_)
      for (const Fault& fault : faults_)
        unplugged_ = unplugged_ || (fault.kind == FaultKind::kUnplug && report_number_ >= fault.at);
    if (unplugged_)
      return fail(ErrorKind::kUnavailable, "fault: unplugged by the script after {} reports", report_number_);
    return {};
  }

  std::vector<Fault> faults_;
  std::mt19937_64 random_;
  std::uint64_t report_number_ = 0;  ///< of the report that arrives next
  bool unplugged_ = false;
};

}  // namespace

Result<std::vector<Fault>> parse_faults(std::string_view text) {
  std::vector<Fault> faults;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    const std::string_view name = part.substr(0, part.find('@'));
    const auto known = std::find_if(std::begin(kNames), std::end(kNames), [&](auto& k) { return k.first == name; });
    std::string_view rest = part.substr(name.size());
    const auto at = take_number(rest, '@');
    if (known == std::end(kNames) || !at)
      return fail(ErrorKind::kUsage,
                  "fault: \"{}\" found, expected drop, truncate, garbage, stall or unplug, then @AT[xCOUNT][:LENGTH]",
                  part);
    Fault fault{known->second, *at, 1, 0};
    if (const auto count = take_number(rest, 'x')) fault.count = *count;
    if (const auto length = take_number(rest, ':')) fault.length = static_cast<std::size_t>(*length);
    if (!rest.empty()) return fail(ErrorKind::kUsage, "fault: \"{}\" left over in \"{}\"", rest, part);
    faults.push_back(fault);
  }
  return faults;
}

std::unique_ptr<Transport> make_fault_transport(std::unique_ptr<Transport> below, std::vector<Fault> faults,
                                                std::uint64_t seed) {
  return std::make_unique<FaultTransport>(std::move(below), std::move(faults), seed);
}

}  // namespace dubsar
