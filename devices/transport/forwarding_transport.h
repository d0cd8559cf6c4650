#pragma once
// A transport around another one, for those that change or watch some of what passes and hand on the rest.

#include <memory>
#include <utility>

#include "devices/transport/transport.h"

namespace dubsar {

/// Hands on every call.
class ForwardingTransport : public Transport {
 public:
  explicit ForwardingTransport(std::unique_ptr<Transport> below) : below_(std::move(below)) {}
  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    return below_->read(report, timeout);
  }
  Result<void> write(std::span<const std::byte> report) override { return below_->write(report); }
  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    return below_->get_feature(id, out);
  }
  Result<void> set_feature(std::span<const std::byte> report) override { return below_->set_feature(report); }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    return below_->control(request, data, timeout);
  }
  UsbId usb_id() const noexcept override { return below_->usb_id(); }
  DroppedInput dropped() const noexcept override { return below_->dropped(); }
  bool is_hardware() const noexcept override { return below_->is_hardware(); }

 protected:
  Transport& below() noexcept { return *below_; }

 private:
  std::unique_ptr<Transport> below_;
};

}  // namespace dubsar
