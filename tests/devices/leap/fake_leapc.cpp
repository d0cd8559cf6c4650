#include "fake_leapc.h"

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

namespace {

constexpr std::uint32_t kOk = 0, kInvalid = 0xe2010001, kTimeout = 0xe2010004, kNotConnected = 0xe2010005,
                        kConcurrent = 0xe201000f;
constexpr std::uint32_t kDeviceId = 7;

struct Event {
  std::uint32_t type = 0, device = 0;
  std::vector<unsigned char> bytes;
  std::vector<FakeHand> hands;  // of a tracking event
};

struct Client {
  bool open = false, greeted = false, polling = false;
  std::deque<Event> queue;
  Event current;  // what the last poll handed out stays valid until the next
};

struct Service {
  std::mutex mutex;
  std::condition_variable changed;
  bool running = true, device = true;
  std::int64_t now_us = -1;
  std::uint32_t poll_error = 0, mode = 1;
  std::uint64_t policies = 0;
  int created = 0, destroyed = 0, polls_at_once = 0;
  std::set<Client*> clients;
};

Service& service() {
  static Service the_service;
  return the_service;
}

template <class T>
Event event_of(std::uint32_t type, const T& value) {
  Event event;
  event.type = type;
  event.bytes.resize(sizeof value);
  std::memcpy(event.bytes.data(), &value, sizeof value);
  return event;
}

void send(const Event& event) {
  for (Client* client : service().clients)
    if (client->open && client->greeted) client->queue.push_back(event);
  service().changed.notify_all();
}

Event device_event(std::uint32_t type) { return event_of(type, FakeDeviceEvent{0, nullptr, kDeviceId, 1}); }
Event mode_event() {
  const std::uint32_t body[2] = {0, service().mode};
  return event_of(0x10b, body);
}

void greet(Client& client) {
  client.greeted = true;
  client.queue.push_back(event_of(1, std::uint32_t{0}));
  if (service().device) client.queue.push_back(device_event(3));
}

}  // namespace

void fake_leapc_reset() {
  const std::lock_guard lock(service().mutex);
  Service& s = service();
  s.running = s.device = true;
  s.now_us = -1;
  s.poll_error = 0;
  s.mode = 1;
  s.policies = 0;
  s.created = s.destroyed = s.polls_at_once = 0;
}
void fake_leapc_set_service(bool running) {
  const std::lock_guard lock(service().mutex);
  service().running = running;
  for (Client* client : service().clients) {
    if (running || !client->greeted) continue;
    client->greeted = false;
    client->queue.clear();
    client->queue.push_back(event_of(2, std::uint32_t{0}));
  }
  service().changed.notify_all();
}
void fake_leapc_set_device(bool plugged) {
  const std::lock_guard lock(service().mutex);
  service().device = plugged;
  send(device_event(plugged ? 3 : 0x104));
}
void fake_leapc_set_now(std::int64_t us) {
  const std::lock_guard lock(service().mutex);
  service().now_us = us;
}
void fake_leapc_set_poll_error(std::uint32_t code) {
  const std::lock_guard lock(service().mutex);
  service().poll_error = code;
  service().changed.notify_all();
}
void fake_leapc_send_frame(std::int64_t frame, std::int64_t time_us, const FakeHand* hands, std::uint32_t count) {
  const std::lock_guard lock(service().mutex);
  Event event = event_of(0x100, FakeTrackingEvent{nullptr, frame, time_us, frame, count, nullptr, 115.0F});
  event.hands.assign(hands, hands + count);
  event.device = kDeviceId;
  send(event);
}
void fake_leapc_send_event(std::uint32_t type, const void* body, std::uint32_t bytes, std::uint32_t device) {
  const std::lock_guard lock(service().mutex);
  Event event;
  event.type = type;
  event.device = device;
  const auto* from = static_cast<const unsigned char*>(body);
  event.bytes.assign(from, from + bytes);
  send(event);
}
void fake_leapc_switch_mode(std::uint32_t mode) {
  const std::lock_guard lock(service().mutex);
  service().mode = mode;
  send(mode_event());
}
FakeLeapcCounts fake_leapc_counts() {
  const std::lock_guard lock(service().mutex);
  const Service& s = service();
  int open = 0;
  for (const Client* client : s.clients) open += client->open ? 1 : 0;
  return {open, s.created, s.destroyed, s.polls_at_once, s.mode, s.policies};
}

std::uint32_t LeapCreateConnection(const void*, void** connection) {
  const std::lock_guard lock(service().mutex);
  auto client = std::make_unique<Client>();
  *connection = client.get();
  service().clients.insert(client.release());
  ++service().created;
  return kOk;
}
std::uint32_t LeapOpenConnection(void* connection) {
  const std::lock_guard lock(service().mutex);
  static_cast<Client*>(connection)->open = true;
  return kOk;
}
void LeapCloseConnection(void* connection) {
  const std::lock_guard lock(service().mutex);
  static_cast<Client*>(connection)->open = false;
}
void LeapDestroyConnection(void* connection) {
  const std::lock_guard lock(service().mutex);
  auto* client = static_cast<Client*>(connection);
  service().clients.erase(client);
  delete client;
  ++service().destroyed;
}

std::uint32_t LeapPollConnection(void* connection, std::uint32_t timeout_ms, FakeMessage* message) {
  Service& s = service();
  std::unique_lock lock(s.mutex);
  auto& client = *static_cast<Client*>(connection);
  if (client.polling) {
    ++s.polls_at_once;
    return kConcurrent;
  }
  if (!client.open) return kNotConnected;
  client.polling = true;
  const auto ready = [&] {
    if (s.running && !client.greeted) greet(client);
    return !client.queue.empty() || s.poll_error != 0;
  };
  const bool any = s.changed.wait_for(lock, std::chrono::milliseconds(timeout_ms), ready);
  client.polling = false;
  if (s.poll_error != 0) return s.poll_error;
  if (!any) return kTimeout;
  client.current = std::move(client.queue.front());
  client.queue.pop_front();
  Event& event = client.current;
  if (event.type == 0x100 && event.bytes.size() == sizeof(FakeTrackingEvent) && !event.hands.empty()) {
    const FakeHand* const hands = event.hands.data();
    std::memcpy(event.bytes.data() + offsetof(FakeTrackingEvent, hands), &hands, sizeof hands);
  }
  *message = {sizeof(FakeMessage), event.type, event.bytes.empty() ? nullptr : event.bytes.data(), event.device};
  return kOk;
}

extern "C" std::uint32_t LeapSetPolicyFlags(void*, std::uint64_t set, std::uint64_t clear) {
  const std::lock_guard lock(service().mutex);
  service().policies = (service().policies | set) & ~clear;
  return kOk;
}
#ifndef FAKE_LEAPC_VERSION_4
extern "C" std::uint32_t LeapSetTrackingMode(void*, std::uint32_t mode) {
  const std::lock_guard lock(service().mutex);
  if (mode > 2) return kInvalid;
  service().mode = mode;
  send(mode_event());
  return kOk;
}
#endif
extern "C" std::int64_t LeapGetNow() {
  const std::lock_guard lock(service().mutex);
  if (service().now_us >= 0) return service().now_us;
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count() + 3'600'000'000;
}
