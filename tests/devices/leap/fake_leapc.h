#pragma once
// A libLeapC.so whose service, devices and frames the test moves by hand. Its structs are written down apart
// from the product's offsets, field by field as the vendor documents them, so that a mistake in either shows.

#include <cstddef>
#include <cstdint>

extern "C" {

#pragma pack(push, 1)
struct FakeVector {
  float x, y, z;
};
struct FakeQuaternion {
  float x, y, z, w;
};
struct FakeBone {
  FakeVector prev_joint, next_joint;
  float width;
  FakeQuaternion rotation;
};
struct FakeDigit {
  std::int32_t finger_id;
  FakeBone metacarpal, proximal, intermediate, distal;
  std::uint32_t is_extended;
};
struct FakePalm {
  FakeVector position, stabilized_position, velocity, normal;
  float width;
  FakeVector direction;
  FakeQuaternion orientation;
};
struct FakeHand {
  std::uint32_t id, flags, type;
  float confidence;
  std::uint64_t visible_time;
  float pinch_distance, grab_angle, pinch_strength, grab_strength;
  FakePalm palm;
  FakeDigit digits[5];
  FakeBone arm;
};
struct FakeTrackingEvent {
  void* reserved;
  std::int64_t frame_id, timestamp, tracking_frame_id;
  std::uint32_t hand_count;
  const FakeHand* hands;
  float framerate;
};
struct FakeDeviceEvent {
  std::uint32_t flags;
  void* handle;
  std::uint32_t id, status;
};
struct FakeDeviceStatusEvent {
  void* handle;
  std::uint32_t id, last_status, status;
};
struct FakeMessage {
  std::uint32_t size, type;
  const void* event;
  std::uint32_t device_id;
};
#pragma pack(pop)

static_assert(sizeof(FakeBone) == 44 && sizeof(FakeDigit) == 184 && sizeof(FakePalm) == 80 && sizeof(FakeHand) == 1084);
static_assert(offsetof(FakeHand, palm) == 40 && offsetof(FakeHand, digits) == 120 && offsetof(FakeHand, arm) == 1040);
static_assert(sizeof(FakeTrackingEvent) == 48 && offsetof(FakeTrackingEvent, hands) == 36);
static_assert(sizeof(FakeMessage) == 20 && sizeof(FakeDeviceEvent) == 20 && sizeof(FakeDeviceStatusEvent) == 20);

/// As new: service up, device 7 plugged in, nothing sent.
void fake_leapc_reset();
void fake_leapc_set_service(bool running);
void fake_leapc_set_device(bool plugged);
/// The clock of LeapGetNow; negative: the machine's monotonic clock plus an hour.
void fake_leapc_set_now(std::int64_t us);
/// What the next polls answer instead of success; 0: nothing special.
void fake_leapc_set_poll_error(std::uint32_t code);
/// Sends one frame to every connection.
void fake_leapc_send_frame(std::int64_t frame, std::int64_t time_us, const FakeHand* hands, std::uint32_t count);
/// Sends any event: `bytes` of it are copied; none when `bytes` is 0 (a null address).
void fake_leapc_send_event(std::uint32_t type, const void* event, std::uint32_t bytes, std::uint32_t device);
/// Another client switches the mode.
void fake_leapc_switch_mode(std::uint32_t mode);

struct FakeLeapcCounts {
  int open_connections, created, destroyed, polls_at_once;
  std::uint32_t mode;
  std::uint64_t policies;
};
FakeLeapcCounts fake_leapc_counts();

// The library itself, for tests that call it without the product.
std::uint32_t LeapCreateConnection(const void* config, void** connection);
std::uint32_t LeapOpenConnection(void* connection);
std::uint32_t LeapPollConnection(void* connection, std::uint32_t timeout_ms, FakeMessage* message);
void LeapCloseConnection(void* connection);
void LeapDestroyConnection(void* connection);
}
