#include "input/tracking/webcam_hands/webcam_hand_tracker.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace dubsar {
namespace {

constexpr double kLeastPresence = 0.5;
constexpr double kNearestM = 0.05, kFarthestM = 3.0;
constexpr double kSameHand = 0.35;  // of the square's side between two middles
// reach of a finger's tip from the wrist, in lengths of its bones: stretched out, and in a fist
constexpr double kOpenReach = 0.90, kFistReach = 0.55;

constexpr std::array<HandJoint, kLandmarks> kJointOf{
    HandJoint::kWrist,     HandJoint::kThumbMetacarpal, HandJoint::kThumbProximal,      HandJoint::kThumbDistal,
    HandJoint::kThumbTip,  HandJoint::kIndexProximal,   HandJoint::kIndexIntermediate,  HandJoint::kIndexDistal,
    HandJoint::kIndexTip,  HandJoint::kMiddleProximal,  HandJoint::kMiddleIntermediate, HandJoint::kMiddleDistal,
    HandJoint::kMiddleTip, HandJoint::kRingProximal,    HandJoint::kRingIntermediate,   HandJoint::kRingDistal,
    HandJoint::kRingTip,   HandJoint::kLittleProximal,  HandJoint::kLittleIntermediate, HandJoint::kLittleDistal,
    HandJoint::kLittleTip};

/// -Z along `forward`, +Y as near to `back` as that allows.
glm::dquat orientation(const glm::dvec3& forward, const glm::dvec3& back) {
  const double length = glm::length(forward);
  if (!(length > 1e-6)) return {1.0, 0.0, 0.0, 0.0};
  const glm::dvec3 z = -forward / length;
  const glm::dvec3 across = glm::cross(back, z);
  if (!(glm::length(across) > 1e-6)) return {1.0, 0.0, 0.0, 0.0};
  const glm::dvec3 x = glm::normalize(across);
  return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

double grab_of(const std::array<glm::dvec3, kLandmarks>& at) {
  double reach = 0.0;
  for (const std::size_t knuckle : {5, 9, 13, 17}) {
    double bones = glm::length(at[knuckle] - at[0]);
    for (std::size_t i = knuckle; i < knuckle + 3; ++i) bones += glm::length(at[i + 1] - at[i]);
    reach += 0.25 * glm::length(at[knuckle + 3] - at[0]) / std::max(bones, 1e-6);
  }
  return std::clamp((kOpenReach - reach) / (kOpenReach - kFistReach), 0.0, 1.0);
}

}  // namespace

std::optional<glm::dvec3> place_hand(const HandSeen& hand, int width, int height, const CameraView& camera,
                                     double hand_size) {
  // u (z + Z) = f (x + X) for each landmark, likewise v: linear in (X, Y, Z)
  const double f = camera.focal_px(width);
  double sum_u = 0, sum_v = 0, squares = 0, right_x = 0, right_y = 0, right_z = 0;
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const double u = (hand.points_px[i].x - 0.5 * width) / f, v = (hand.points_px[i].y - 0.5 * height) / f;
    const glm::dvec3 p = hand_size * hand.shape_m[i];
    const double a = u * p.z - p.x, b = v * p.z - p.y;  // X - u Z = a, Y - v Z = b
    sum_u += u;
    sum_v += v;
    squares += u * u + v * v;
    right_x += a;
    right_y += b;
    right_z -= u * a + v * b;
  }
  constexpr auto n = static_cast<double>(kLandmarks);
  const double determinant = squares - (sum_u * sum_u + sum_v * sum_v) / n;  // zero when all landmarks are one pixel
  if (!(determinant > 1e-9)) return std::nullopt;
  const double z = (right_z + (sum_u * right_x + sum_v * right_y) / n) / determinant;
  if (!(z >= kNearestM && z <= kFarthestM)) return std::nullopt;
  return glm::dvec3(-(right_x + sum_u * z) / n, -(right_y + sum_v * z) / n, z);
}

HandFrame hand_from_landmarks(const std::array<glm::dvec3, kLandmarks>& at, Chirality chirality) {
  HandFrame hand;
  hand.valid = hand.tracked = true;
  hand.chirality = chirality;
  const glm::dvec3 side = glm::cross(at[5] - at[0], at[17] - at[0]);
  const glm::dvec3 back = chirality == Chirality::kLeft ? side : -side;
  const auto set = [&](HandJoint which, const glm::dvec3& position_m, const glm::dvec3& forward, bool tracked) {
    HandJointPose& joint = hand.joint(which);
    joint.pose = {position_m, orientation(forward, back)};
    joint.valid = true;
    joint.tracked = tracked;
  };
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const bool tip = i > 0 && i % 4 == 0;
    set(kJointOf[i], at[i], i == 0 ? at[9] - at[0] : tip ? at[i] - at[i - 1] : at[i + 1] - at[i], true);
  }
  // where the metacarpals meet the wrist: a sixth of the way to the knuckles
  constexpr std::array<HandJoint, 4> kMetacarpals{HandJoint::kIndexMetacarpal, HandJoint::kMiddleMetacarpal,
                                                  HandJoint::kRingMetacarpal, HandJoint::kLittleMetacarpal};
  for (std::size_t finger = 0; finger < 4; ++finger) {
    const glm::dvec3 bone = at[5 + 4 * finger] - at[0];
    set(kMetacarpals[finger], at[0] + bone / 6.0, bone, false);
  }
  set(HandJoint::kPalm, 0.5 * (at[0] + at[9]), at[9] - at[0], true);
  hand.palm = hand.joint(HandJoint::kPalm).pose;
  hand.grab_strength = grab_of(at);
  hand.pinch_distance_m = glm::length(at[4] - at[8]);
  return hand;
}

WebcamHandTracker::WebcamHandTracker(std::unique_ptr<HandNetworks> networks, const WebcamHandOptions& options)
    : networks_(std::move(networks)), options_(options) {}

Result<std::optional<HandFrame>> WebcamHandTracker::look(const Frame& frame, Known& known) {
  const PictureView picture{frame.pixels.data(), frame.width, frame.height};
  DUBSAR_ASSIGN(const HandSeen seen, networks_->place_landmarks(picture, known.crop));
  if (!(seen.presence >= kLeastPresence)) return std::optional<HandFrame>();
  const auto middle_m = place_hand(seen, frame.width, frame.height, options_.camera, options_.hand_size);
  if (!middle_m) return std::optional<HandFrame>();
  known.crop = seen.next_crop();
  known.right_votes = std::clamp(known.right_votes + seen.right - 0.5, -5.0, 5.0);
  const Chirality chirality = known.right_votes > 0.2    ? Chirality::kRight
                              : known.right_votes < -0.2 ? Chirality::kLeft
                                                         : Chirality::kUnknown;
  const glm::dvec3 place_m = known.place.filter(frame.time, *middle_m);
  const Pose screen_from_camera = options_.camera.screen_from_camera();
  std::array<glm::dvec3, kLandmarks> landmarks_m;
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const glm::dvec3 p = options_.hand_size * seen.shape_m[i];
    landmarks_m[i] = transform(screen_from_camera, place_m + glm::dvec3(-p.x, -p.y, p.z));
  }
  HandFrame hand = hand_from_landmarks(landmarks_m, chirality);
  hand.time = frame.time;
  hand.id = known.id;
  hand.confidence = seen.presence;
  if (known.palm_m && frame.time > known.time)
    hand.velocity_mps = (hand.palm.position_m - *known.palm_m) / (1e-9 * static_cast<double>(frame.time - known.time));
  known.palm_m = hand.palm.position_m;
  known.time = frame.time;
  return std::optional(hand);
}

Result<void> WebcamHandTracker::track(const Frame& frame, Hands& hands) {
  if (frame.format != PixelFormat::kRgb8 || frame.width < 1 || frame.height < 1 ||
      frame.pixels.size() < frame.view_bytes())
    return fail(ErrorKind::kBadData, "hand tracker: a frame of {} x {} and {} bytes, expected colour", frame.width,
                frame.height, frame.pixels.size());
  hands.clear();
  const auto same = [](const SquareCrop& a, const SquareCrop& b) {
    return glm::length(a.centre_px - b.centre_px) < kSameHand * std::max(a.side_px, b.side_px);
  };
  for (std::size_t i = 0; i < known_.size();) {
    DUBSAR_ASSIGN(const auto hand, look(frame, known_[i]));
    const bool twice = hand && std::any_of(known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(i),
                                           [&](const Known& other) { return same(other.crop, known_[i].crop); });
    if (!hand || twice) {
      known_.erase(known_.begin() + static_cast<std::ptrdiff_t>(i));
      continue;
    }
    hands.push_back(*hand);
    ++i;
  }
  const bool look_around = known_.empty() || frames_ % options_.look_around_frames == 0;
  ++frames_;
  if (!look_around || known_.size() >= static_cast<std::size_t>(options_.most_hands)) return {};
  DUBSAR_ASSIGN(const auto palms, networks_->find_palms({frame.pixels.data(), frame.width, frame.height}));
  for (const SquareCrop& palm : palms) {
    if (known_.size() == static_cast<std::size_t>(options_.most_hands)) break;
    if (std::any_of(known_.begin(), known_.end(), [&](const Known& known) { return same(known.crop, palm); })) continue;
    Known known;
    known.id = next_id_;
    known.crop = palm;
    known.place = OneEuroVector(options_.place_filter);
    // the palm's square is coarse; landmarks from it are used only to look again
    DUBSAR_ASSIGN(const auto first, look(frame, known));
    if (!first) continue;
    DUBSAR_ASSIGN(const auto hand, look(frame, known));
    if (!hand ||
        std::any_of(known_.begin(), known_.end(), [&](const Known& other) { return same(other.crop, known.crop); }))
      continue;
    ++next_id_;
    known_.push_back(std::move(known));
    hands.push_back(*hand);
  }
  return {};
}

}  // namespace dubsar
