#include "devices/transport/sim_transport.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace dubsar {

struct SimDevice::Shared {
  Shared(std::string device_name, bool keeps_messages, UsbId who)
      : name(std::move(device_name)), messages(keeps_messages), id(who) {}
  const std::string name;
  const bool messages;
  const UsbId id;
  std::mutex mutex;
  std::condition_variable arrived;
  std::shared_ptr<const SimBehaviour> behaviour = std::make_shared<SimBehaviour>();  // guarded by mutex
  std::deque<std::vector<std::byte>> queue;                                          // guarded by mutex
  bool plugged = true;                                                               // guarded by mutex
  int plug_number = 0;  ///< guarded by mutex; a transport of an earlier plugging is lost
  int open_count = 0;   // guarded by mutex
};

namespace {

template <class Shared>
class SimTransport final : public Transport {
 public:
  SimTransport(std::shared_ptr<Shared> shared, int plug_number)
      : shared_(std::move(shared)), plug_number_(plug_number) {}
  ~SimTransport() override {
    const std::lock_guard lock(shared_->mutex);
    --shared_->open_count;
  }

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    std::unique_lock lock(shared_->mutex);
    const auto ready = [this] { return lost() || !shared_->queue.empty(); };
    if (timeout.count() > 0) shared_->arrived.wait_for(lock, timeout, ready);
    if (lost()) return gone();
    if (shared_->queue.empty()) return std::size_t{0};
    auto& next = shared_->queue.front();
    const std::size_t length = std::min(report.size(), next.size());
    std::copy_n(next.begin(), length, report.begin());
    if (shared_->messages || length == next.size())
      shared_->queue.pop_front();
    else
      next.erase(next.begin(), next.begin() + static_cast<std::ptrdiff_t>(length));
    return length;
  }

  Result<void> write(std::span<const std::byte> report) override {
    DUBSAR_ASSIGN(const auto behaviour, present());
    if (!behaviour->on_write) return {};
    return behaviour->on_write(report);
  }

  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    DUBSAR_ASSIGN(const auto behaviour, present());
    if (!behaviour->on_get_feature) return Transport::get_feature(id, out);
    DUBSAR_ASSIGN(const auto answer, behaviour->on_get_feature(id));
    const std::size_t length = std::min(out.size(), answer.size());
    std::copy_n(answer.begin(), length, out.begin());
    return length;
  }

  Result<void> set_feature(std::span<const std::byte> report) override {
    DUBSAR_ASSIGN(const auto behaviour, present());
    if (!behaviour->on_set_feature) return Transport::set_feature(report);
    return behaviour->on_set_feature(report);
  }

  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    DUBSAR_ASSIGN(const auto behaviour, present());
    if (!behaviour->on_control) return Transport::control(request, data, timeout);
    return behaviour->on_control(request, data);
  }
  UsbId usb_id() const noexcept override { return shared_->id; }

 private:
  bool lost() const { return !shared_->plugged || shared_->plug_number != plug_number_; }
  tl::unexpected<Error> gone() const {
    return fail(ErrorKind::kUnavailable, "{}: the device was unplugged", shared_->name);
  }
  Result<std::shared_ptr<const SimBehaviour>> present() {
    const std::lock_guard lock(shared_->mutex);
    if (lost()) return gone();
    return shared_->behaviour;
  }

  std::shared_ptr<Shared> shared_;
  int plug_number_;
};

}  // namespace

SimDevice::SimDevice(std::string name, bool messages, UsbId id)
    : shared_(std::make_shared<Shared>(std::move(name), messages, id)) {}

SimDevice::~SimDevice() { unplug(); }

void SimDevice::set_behaviour(SimBehaviour behaviour) {
  const std::lock_guard lock(shared_->mutex);
  shared_->behaviour = std::make_shared<const SimBehaviour>(std::move(behaviour));
}

void SimDevice::send(std::span<const std::byte> report) {
  {
    const std::lock_guard lock(shared_->mutex);
    if (!shared_->plugged || shared_->open_count == 0) return;
    if (shared_->queue.size() >= kMaxQueued) shared_->queue.pop_front();
    shared_->queue.emplace_back(report.begin(), report.end());
  }
  shared_->arrived.notify_one();
}

void SimDevice::unplug() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->plugged = false;
    ++shared_->plug_number;
    shared_->queue.clear();
  }
  shared_->arrived.notify_all();
}

void SimDevice::plug() {
  const std::lock_guard lock(shared_->mutex);
  shared_->plugged = true;
}

bool SimDevice::plugged() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->plugged;
}

int SimDevice::open_count() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->open_count;
}

Result<std::unique_ptr<Transport>> SimDevice::open() {
  const std::lock_guard lock(shared_->mutex);
  if (!shared_->plugged) return fail(ErrorKind::kUnavailable, "{}: not plugged in", shared_->name);
  ++shared_->open_count;
  return std::make_unique<SimTransport<Shared>>(shared_, shared_->plug_number);
}

}  // namespace dubsar
