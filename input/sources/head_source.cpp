#include "input/sources/head_source.h"

#include <cmath>

#include "devices/head_tracker/head_tracker.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "input/sources/device_feed.h"
#include "input/sources/threaded_source.h"

namespace dubsar {
namespace {

constexpr glm::dvec3 kEyesFromNeck_m{0.0, 0.075, -0.0805};
constexpr double kNearest_m = 0.1, kFarthest_m = 3.0, kFarthestBeside_m = 2.5;
constexpr TimestampNs kSilentNs = 1'000'000'000, kServerRetryNs = 900'000'000;

class HeadReader final : public SourceReader {
 public:
  HeadReader(std::unique_ptr<HeadTracker> tracker, std::shared_ptr<const std::atomic<bool>> ended,
             const HeadPlacement& placement)
      : tracker_(std::move(tracker)), ended_(std::move(ended)), placement_(placement) {}

  bool read(TimestampNs now, milliseconds timeout, InputFrame& frame) override {
    const auto sample = tracker_->poll(now, timeout);
    if (!sample) return false;
    frame.time = sample->time;
    frame.heads.clear();
    if (const auto head = head_frame(*sample, placement_)) frame.heads.push_back(*head);
    return true;
  }
  bool connected() const override { return tracker_->connected(); }
  std::string reason() const override { return tracker_->reason(); }
  void wake() override { tracker_->wake(); }
  bool finished() const override { return ended_ && *ended_; }
  std::string note() const override { return tracker_->note(); }
  void recentre() override { tracker_->recentre(); }

 private:
  std::unique_ptr<HeadTracker> tracker_;
  std::shared_ptr<const std::atomic<bool>> ended_;
  HeadPlacement placement_;
};

}  // namespace

glm::dvec3 usual_place_m(std::string_view tracker) noexcept {
  return tracker == "vrpn" ? glm::dvec3(0.0) : glm::dvec3(0.0, 0.0, 0.6);
}

std::optional<HeadFrame> head_frame(const HeadSample& sample, const HeadPlacement& placement) {
  const Pose& place = placement.screen_from_tracker;
  const glm::dquat turn = place.rotation * (sample.has_orientation ? sample.pose.rotation : glm::dquat(1, 0, 0, 0));
  glm::dvec3 middle{0.0};
  if (sample.has_position) {
    middle = transform(place, sample.pose.position_m) + turn * placement.eyes_m;
  } else {
    middle = place.position_m - kEyesFromNeck_m + turn * (kEyesFromNeck_m + placement.eyes_m);
  }
  HeadFrame head;
  head.time = sample.time;
  head.tracked = true;
  head.confidence = sample.has_position ? 1.0 : 0.5;
  const glm::dvec3 half = turn * glm::dvec3(0.5 * placement.ipd_m, 0.0, 0.0);
  head.left_eye_m = middle - half;
  head.right_eye_m = middle + half;
  for (const glm::dvec3& eye : {*head.left_eye_m, *head.right_eye_m}) {
    if (!(eye.z >= kNearest_m && eye.z <= kFarthest_m)) return std::nullopt;
    if (!(std::abs(eye.x) <= kFarthestBeside_m && std::abs(eye.y) <= kFarthestBeside_m)) return std::nullopt;
  }
  return head;
}

Result<std::unique_ptr<InputSource>> make_head_source(const InputConfig& config) {
  OptionReader options(config, "head");
  DeviceSpec choice;
  choice.driver = options.first_word();
  const auto found = find_backend(head_tracker_backends(), choice.driver, "head tracker");
  if (!found) return fail(ErrorKind::kUsage, "input head: {}; write head:NAME", found.error().message);
  const bool opentrack = choice.driver == "opentrack", vrpn = choice.driver == "vrpn";
  if (opentrack || vrpn) {
    choice.address = options.text("address", choice.address);
    choice.port = options.integer("port", 0, 65535, 0);
  }
  if (opentrack) {
    choice.allow_remote = options.flag("remote");
    DUBSAR_ASSIGN(choice.invert, parse_axes(options.text("invert")));
    choice.sender = options.text("sender");
    DUBSAR_TRY(parse_opentrack_sender(choice.sender));
  }
  if (vrpn) {
    choice.tracker = options.text("tracker");
    choice.sensor = options.integer("sensor", 0, 1000, 0);
  }
  HeadPlacement placement;
  placement.screen_from_tracker = options.placement(Pose{usual_place_m(choice.driver)});
  placement.eyes_m = 1e-3 * options.triple("eyes", 500.0, glm::dvec3(0.0));
  placement.ipd_m = 1e-3 * options.number("ipd", 40.0, 90.0, 63.0);
  DUBSAR_ASSIGN(DeviceFeed device, source_device(choice, options, config, placement.screen_from_tracker));
  DUBSAR_TRY(options.finish());

  HeadTrackerConfig tracker_config;
  tracker_config.open = std::move(device.open);
  tracker_config.invert = choice.invert;
  tracker_config.sender = choice.sender;
  tracker_config.tracker = choice.tracker;
  tracker_config.sensor = choice.sensor;
  tracker_config.stamps = &session_clock(config);
  DUBSAR_ASSIGN(auto tracker, (*found)->create(tracker_config));
  DeviceSourceTraits traits;
  traits.name = "head:" + choice.driver;
  traits.has_end = device.ended != nullptr;
  traits.before_poll = device.before_poll;
  traits.silent_ns = kSilentNs;
  if (is_orientation_only(choice.driver))
    traits.note = traits.name + ": measures where the head looks, not where it is; its place is that of a neck model";
  if (vrpn || opentrack) traits.retry_ns = kServerRetryNs;
  return make_device_source(
      std::move(traits), std::make_unique<HeadReader>(std::move(tracker), std::move(device.ended), placement), config);
}

}  // namespace dubsar
