#include "devices/leap/leapc_connection.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "devices/leap/leapc_clock.h"
#include "devices/leap/leapc_library.h"
#include "devices/mailbox.h"

namespace dubsar::leapc {
namespace {

using std::chrono::steady_clock;

constexpr const char* kNoServiceText =
    "leapc: Ultraleap's tracking service does not answer: start it with \"sudo systemctl start "
    "ultraleap-hand-tracking-service\" (its log: journalctl -u ultraleap-hand-tracking-service)";
constexpr const char* kConnectingText = "leapc: connecting to Ultraleap's tracking service";
constexpr const char* kNoDeviceText =
    "leapc: the tracking service runs, but no device is plugged in: plug it into a port of the machine "
    "itself";

/// One LeapC connection, opened; closed and freed by its destructor.
class Handle {
 public:
  static Result<Handle> open(const Library& library) {
    Library::Connection connection = nullptr;
    std::uint32_t code = library.create_connection(nullptr, &connection);
    if (code != kSuccess || connection == nullptr)
      return fail(ErrorKind::kUnavailable, "leapc: {} cannot make a connection: {}", library.path(), result_text(code));
    Handle handle(library, connection);
    if (code = library.open_connection(connection); code != kSuccess)
      return fail(ErrorKind::kUnavailable, "leapc: {} cannot open a connection: {}", library.path(), result_text(code));
    return handle;
  }
  Handle(Handle&& other) noexcept : library_(other.library_), connection_(std::exchange(other.connection_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(library_, other.library_);
    std::swap(connection_, other.connection_);
    return *this;
  }
  ~Handle() {
    if (connection_ == nullptr) return;
    library_->close_connection(connection_);
    library_->destroy_connection(connection_);
  }
  Library::Connection get() const noexcept { return connection_; }

 private:
  Handle(const Library& library, Library::Connection connection) : library_(&library), connection_(connection) {}
  const Library* library_;
  Library::Connection connection_;
};

class LibraryConnection final : public Connection {
 public:
  LibraryConnection(Options options, const Clock& clock) : options_(std::move(options)), clock_(clock) {}
  ~LibraryConnection() override { LibraryConnection::stop(); }

  Result<void> start() override {
    stop();
    DUBSAR_ASSIGN(library_, Library::load(options_.library));
    DUBSAR_ASSIGN(Handle handle, Handle::open(*library_));
    std::unique_lock lock(mutex_);
    box_.tell(State::kNoService, kConnectingText, false);
    counters_ = {};
    stopping_ = false;
    thread_ = std::thread([this, owned = std::move(handle)]() mutable {
      try {
        run(std::move(owned));
      } catch (const std::exception& mistake) {  // costs the hands, not the session
        box_.tell(State::kNoService,
                  fmt::format("leapc: reading has stopped by a mistake of this program: {}", mistake.what()), false);
      }
    });
    if (options_.patience == milliseconds(0)) return {};
    if (changed_.wait_for(lock, options_.patience, [&] { return counters_.connections > 0; })) return {};
    lock.unlock();
    stop();
    return fail(ErrorKind::kUnavailable, "{}", kNoServiceText);
  }

  void stop() noexcept override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    box_.tell(State::kStopped, {}, false);
  }

  bool poll(ServiceFrame& newest) override { return box_.take(newest); }
  State state() const override { return box_.state(); }
  std::string reason() const override { return box_.reason(); }
  Counters counters() const override {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

 private:
  // --- the thread; everything it keeps between two messages is in Session ---

  struct Session {
    explicit Session(Handle h) : handle(std::move(h)) {}
    Handle handle;
    ClockMap times;
    TimestampNs sampled = 0;
    bool connected = false;
    bool said_so = false;  // that there is no service
    std::set<std::uint32_t> devices;
    std::string trouble;     // of the device that failed last
    bool right_mode = true;  // false: somebody has switched the device to another mode
    steady_clock::time_point silent_since = steady_clock::now();
    ServiceFrame frame;
  };

  void run(Handle handle) {
    Session session(std::move(handle));
    while (!stopping()) {
      if (!session.connected) wait_for_service(session);
      // Newer libraries may write more than the 20 bytes that we know.
      alignas(8) std::array<std::byte, 256> message{};
      const std::uint32_t code = library_->poll_connection(
          session.handle.get(), static_cast<std::uint32_t>(std::max<std::int64_t>(options_.poll.count(), 0)),
          message.data());
      if (code == kSuccess) {
        receive(session, decode_message(std::span(message).first<kMessageBytes>()));
      } else if (code != kTimeout) {
        {
          const std::lock_guard lock(mutex_);
          ++counters_.errors;
        }
        if (code == kNotConnected || code == kNotAvailable) {
          lose(session, kNoServiceText);
        } else if (!session.connected) {
          tell(State::kNoService, fmt::format("{}; the library says: {}", kNoServiceText, result_text(code)));
        }
        pause();  // these answers come at once
      }
    }
  }

  bool stopping() const {
    const std::lock_guard lock(mutex_);
    return stopping_;
  }
  void pause() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, options_.poll, [&] { return stopping_; });
  }
  void tell(State state, std::string reason) { box_.tell(state, std::move(reason)); }
  void refuse() {
    const std::lock_guard lock(mutex_);
    ++counters_.refused;
  }

  void wait_for_service(Session& session) {
    const auto now = steady_clock::now();
    if (!session.said_so && now - session.silent_since > options_.connecting) {
      session.said_so = true;
      tell(State::kNoService, kNoServiceText);
    }
    if (now - session.silent_since <= options_.reopen) return;
    session.silent_since = now;
    if (auto again = Handle::open(*library_)) session.handle = std::move(*again);
  }

  void lose(Session& session, const char* why) {
    if (session.connected) session.silent_since = steady_clock::now();
    session.connected = false;
    session.devices.clear();
    tell(State::kNoService, why);
  }

  void judge(const Session& session) {
    if (!session.connected) return;
    if (!session.devices.empty() && session.right_mode) return tell(State::kTracking, {});
    if (!session.right_mode)
      return tell(State::kNoDevice,
                  "leapc: another program has switched the device to another mounting: end it, or name its mode");
    tell(State::kNoDevice, session.trouble.empty() ? kNoDeviceText : "leapc: " + session.trouble);
  }

  template <std::size_t Bytes>
  static bool copy_event(const Message& message, std::array<std::byte, Bytes>& event) {
    if (message.event == 0) return false;
    std::memcpy(event.data(), reinterpret_cast<const void*>(message.event), Bytes);
    return true;
  }

  void receive(Session& session, const Message& message) {
    switch (message.type) {
      case Event::kConnection:
        return greet(session);
      case Event::kConnectionLost:
        return lose(session, kNoServiceText);
      case Event::kTracking:
        return take_frame(session, message);
      case Event::kDevice: {
        std::array<std::byte, kDeviceBytes> event{};
        if (!copy_event(message, event)) return refuse();
        const Device device = decode_device(event);
        session.trouble = device_trouble(device.status);
        if (session.trouble.empty()) session.devices.insert(device.id);
        return judge(session);
      }
      case Event::kDeviceLost: {
        std::array<std::byte, kDeviceBytes> event{};
        if (!copy_event(message, event)) return refuse();
        session.devices.erase(decode_device(event).id);
        session.devices.erase(0);
        session.trouble.clear();
        return judge(session);
      }
      case Event::kDeviceFailure: {
        std::array<std::byte, 4> event{};
        if (!copy_event(message, event)) return refuse();
        std::uint32_t status = 0;
        std::memcpy(&status, event.data(), sizeof status);
        session.trouble = device_trouble(status);
        if (message.device == 0) session.devices.clear();
        session.devices.erase(message.device);
        return judge(session);
      }
      case Event::kDeviceStatus: {
        std::array<std::byte, kDeviceBytes> event{};
        if (!copy_event(message, event)) return refuse();
        const Device device = decode_device_status(event);
        session.trouble = device_trouble(device.status);
        if (session.trouble.empty())
          session.devices.insert(device.id);
        else
          session.devices.erase(device.id);
        return judge(session);
      }
      case Event::kTrackingMode: {
        std::array<std::byte, kModeBytes> event{};
        if (!copy_event(message, event)) return refuse();
        std::uint32_t mode = 0;
        std::memcpy(&mode, event.data() + 4, sizeof mode);
        session.right_mode = mode == static_cast<std::uint32_t>(options_.mode);
        return judge(session);
      }
      case Event::kPolicy:
      case Event::kDroppedFrame:
      case Event::kImage:
        return;
    }
  }

  void greet(Session& session) {
    session.connected = true;
    session.right_mode = true;
    session.devices.clear();
    session.times = {};
    // Hands also when our window has no focus; nothing that we do not read.
    std::uint32_t code =
        library_->set_policy_flags(session.handle.get(), kPolicyBackgroundFrames, kPolicyImages | kPolicyMapPoints);
    if (const std::uint32_t mode =
            library_->set_tracking_mode(session.handle.get(), static_cast<std::uint32_t>(options_.mode));
        mode != kSuccess)
      code = mode;
    judge(session);
    {
      const std::lock_guard lock(mutex_);
      ++counters_.connections;
      if (code != kSuccess) ++counters_.errors;
    }
    changed_.notify_all();
  }

  void take_frame(Session& session, const Message& message) {
    std::array<std::byte, kTrackingBytes> event{};
    if (!copy_event(message, event)) return refuse();
    const auto tracking = decode_tracking(event);
    if (!tracking) return refuse();
    session.frame.hands.clear();
    std::uint64_t refused = 0;
    for (std::uint32_t i = 0; i < tracking->hands; ++i) {
      // The only address that is followed without a length beside it: the library's array of hands.
      std::array<std::byte, kHandBytes> bytes{};
      std::memcpy(bytes.data(), reinterpret_cast<const void*>(tracking->hands_at + i * kHandBytes), kHandBytes);
      if (auto hand = decode_hand(bytes))
        session.frame.hands.push_back(*hand);
      else
        ++refused;
    }
    const TimestampNs now = clock_.now();
    if (session.times.empty() || now - session.sampled >= ClockMap::kSampleEveryNs) {
      const std::int64_t theirs = library_->get_now();
      session.times.add(now, theirs, clock_.now());
      session.sampled = now;
    }
    session.frame.time = std::min(session.times.ours(tracking->time_us), now);  // the future is the clocks' error
    session.frame.number = tracking->frame;
    session.frame.frames_per_s = tracking->frames_per_s;
    if (session.devices.empty()) {  // its greeting was missed
      session.devices.insert(message.device);
      judge(session);
    }
    {
      const std::lock_guard lock(mutex_);
      counters_.refused += refused;
      if (session.right_mode) ++counters_.frames;
    }
    if (session.right_mode) box_.put(session.frame);
  }

  const Options options_;
  const Clock& clock_;
  std::shared_ptr<const Library> library_;
  std::thread thread_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  Counters counters_;

  Mailbox<ServiceFrame, State> box_{State::kStopped};
};

}  // namespace

std::unique_ptr<Connection> make_connection(const Options& options, const Clock& clock) {
  return std::make_unique<LibraryConnection>(options, clock);
}

}  // namespace dubsar::leapc
