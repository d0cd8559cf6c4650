#include "input/tracking/face/face_tracker.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr TimestampNs kForgotten = 500'000'000;
constexpr double kSameFace = 0.6;  // of its size between two looks
constexpr double kNoseDepth =
    0.6;  // of the nose tip before the pupils, in pupil distances (MediaPipe's canonical face)
constexpr double kLargestYaw = 1.05;  // 60 degrees; beyond that one eye is hidden
constexpr double kNearestM = 0.15, kFarthestM = 5.0;

bool same(const FaceSeen& a, const FaceSeen& b) {
  return glm::length(a.centre_px - b.centre_px) < kSameFace * std::max(a.size_px, b.size_px);
}

}  // namespace

EyesPlaced place_eyes(const FaceSeen& face, int width, int height, const FaceTrackerOptions& options) {
  const glm::dvec2 across = face.left_eye_px - face.right_eye_px,
                   between = 0.5 * (face.left_eye_px + face.right_eye_px);
  const double distance_px = std::max(1.0, glm::length(across));
  const glm::dvec2 unit = across / distance_px;
  const double f = options.camera.focal_px(width);
  // how far beside the camera's axis the head is: perspective moves the nose, which is nearer, and the nearer
  // eye outwards
  const double beside = glm::dot(between - 0.5 * glm::dvec2(width, height), unit) / f;
  EyesPlaced placed;
  if (face.nose_px) {
    const double offset = glm::dot(*face.nose_px - between, unit) / distance_px;
    placed.yaw_rad = std::clamp(std::atan(offset / kNoseDepth) - std::atan(beside), -kLargestYaw, kLargestYaw);
  }
  const double seen_share = std::max(0.2, std::cos(placed.yaw_rad) - beside * std::sin(placed.yaw_rad));
  const double depth_m = std::clamp(f * options.ipd_m * seen_share / distance_px, kNearestM, kFarthestM);
  const glm::dvec3 centre_m = options.camera.point_m(between, width, height, depth_m);
  // from the right eye to the left one; a head turned to its left has its left eye further away
  const glm::dvec3 half_m =
      0.5 * options.ipd_m *
      glm::dvec3(-unit.x * std::cos(placed.yaw_rad), -unit.y * std::cos(placed.yaw_rad), std::sin(placed.yaw_rad));
  const Pose screen_from_camera = options.camera.screen_from_camera();
  placed.left_m = transform(screen_from_camera, centre_m + half_m);
  placed.right_m = transform(screen_from_camera, centre_m - half_m);
  return placed;
}

FaceTracker::FaceTracker(std::unique_ptr<FaceDetector> detector, const FaceTrackerOptions& options)
    : detector_(std::move(detector)), options_(options) {}

void FaceTracker::take(const FaceSeen& face, TimestampNs time) {
  for (Person& person : people_)
    if (same(person.face, face)) {
      if (person.now) return;  // seen more exactly before
      person.face = face;
      person.seen = time;
      person.now = true;
      return;
    }
  if (people_.size() < static_cast<std::size_t>(options_.most_faces))
    people_.push_back({next_id_++, face, time, true, false});
}

Result<void> FaceTracker::track(const Frame& frame, std::vector<HeadFrame>& heads) {
  if (frame.format != PixelFormat::kRgb8 || frame.width < 1 || frame.height < 1 ||
      frame.pixels.size() < frame.view_bytes())
    return fail(ErrorKind::kBadData, "face tracker: a frame of {} x {} and {} bytes, expected colour", frame.width,
                frame.height, frame.pixels.size());
  const PictureView picture{frame.pixels.data(), frame.width, frame.height};
  std::erase_if(people_, [&](const Person& person) { return frame.time - person.seen > kForgotten; });
  // whoever is followed has the first look of every frame, however large others are
  const auto rank = [&](const Person& person) { return person.id == kept_id_ ? 1e9 : person.face.size_px; };
  std::stable_sort(people_.begin(), people_.end(), [&](const Person& a, const Person& b) { return rank(a) > rank(b); });
  int refined = 0;
  bool all_here = !people_.empty();
  for (Person& person : people_) {
    person.now = person.fine = false;
    if (refined == options_.most_refined) continue;
    ++refined;
    DUBSAR_ASSIGN(const auto again, detector_->refine(picture, person.face));
    if (!again) {
      all_here = false;
      continue;
    }
    person.face = *again;
    person.seen = frame.time;
    person.now = person.fine = true;
  }
  // two that have come to follow one face
  for (std::size_t i = 0; i < people_.size(); ++i)
    for (std::size_t k = people_.size(); k-- > i + 1;)
      if (people_[i].now && same(people_[i].face, people_[k].face) &&
          glm::length(people_[i].face.centre_px - people_[k].face.centre_px) < 0.3 * people_[i].face.size_px)
        people_.erase(people_.begin() + static_cast<std::ptrdiff_t>(k));
  if (!all_here || frames_++ % options_.look_around_frames == 0) {
    DUBSAR_ASSIGN(const auto found, detector_->find(picture));
    for (const FaceSeen& face : found) take(face, frame.time);
    for (Person& person : people_)
      if (person.now && !person.fine && refined < options_.most_refined) {
        DUBSAR_ASSIGN(const auto again, detector_->refine(picture, person.face));
        ++refined;
        if (again) person.face = *again;
      }
  }
  std::stable_sort(people_.begin(), people_.end(),
                   [](const Person& a, const Person& b) { return a.face.size_px > b.face.size_px; });
  heads.clear();
  for (const Person& person : people_) {
    if (!person.now && person.id == kept_id_) continue;
    const EyesPlaced eyes = place_eyes(person.face, frame.width, frame.height, options_);
    HeadFrame head;
    head.time = person.seen;
    head.id = person.id;
    head.tracked = person.now;
    head.confidence = person.face.score;
    head.left_eye_m = eyes.left_m;
    head.right_eye_m = eyes.right_m;
    heads.push_back(head);
  }
  if (const HeadFrame* const kept = keeper_.update(frame.time, heads)) kept_id_ = kept->id;
  return {};
}

}  // namespace dubsar
