#include "input/hand_tracking/hand_tracker.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace dubsar {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

// Proportions of a hand in units of its palm radius R, the largest circle in the silhouette of the palm (about 43 mm);
// right hand, x to the right, y to the fingers. From the same anthropometry as the synthetic hands.
struct FingerShape {
  double nominal_angle;     ///< of the tip, seen from the palm, negative towards the thumb
  glm::dvec2 knuckle;
  double curled;            ///< from the knuckle to the tip of a bent finger
};
constexpr std::array<FingerShape, 5> kShape{{{-72 * kDegree, {-1.35, 0.2}, 0.5},
                                             {-22 * kDegree, {-0.63, 0.77}, 0.35},
                                             {-3 * kDegree, {-0.1, 0.81}, 0.35},
                                             {14 * kDegree, {0.4, 0.72}, 0.35},
                                             {33 * kDegree, {0.8, 0.53}, 0.3}}};
constexpr double kFingerRadius = 0.17, kThumbRadius = 0.2;
constexpr double kWristBehind = 1.2;

// Where the centre of the palm lies from the centre of that circle, in R, open hand and fist; and how much deeper than
// the depth that correlation finds. Tuned on synthetic hands of sizes 0.9 to 1.1 (tests/input/hand_tracking).
constexpr double kForwardOpen = 0.0, kForwardFist = -0.06;
constexpr double kDeeperOpen = 0.11, kDeeperFist = 1.0;

// Reach of the fingers (in R) of a fist and of an open hand.
constexpr double kReachFist = 1.55, kReachOpen = 2.45;
constexpr double kTipReach = 1.75;  // a finger that reaches this far has a tip worth measuring

double smooth_step(double t) { return t = std::clamp(t, 0.0, 1.0), t * t * (3.0 - 2.0 * t); }

glm::dvec2 rotated(const glm::dvec2& v, double angle) {
  return {v.x * std::cos(angle) - v.y * std::sin(angle), v.x * std::sin(angle) + v.y * std::cos(angle)};
}

/// Fingers (0 thumb to 4 little) of the tips, whose angles rise, for a hand whose thumb is on the negative side; and the
/// sum of squared differences from the nominal angles.
struct Assignment {
  std::array<int, 5> tip_of_finger{-1, -1, -1, -1, -1};
  double cost = 1e9;
};
Assignment assign(const std::vector<double>& angles) {
  Assignment best;
  const auto tips = static_cast<int>(angles.size());
  if (tips == 0 || tips > 5) return best;
  for (unsigned chosen = 0; chosen < 32; ++chosen) {
    if (__builtin_popcount(chosen) != tips) continue;
    Assignment candidate;
    candidate.cost = 0.0;
    std::size_t tip = 0;
    for (std::size_t finger = 0; finger < 5; ++finger) {
      if ((chosen >> finger & 1U) == 0) continue;
      const double difference = angles[tip] - kShape[finger].nominal_angle;
      candidate.cost += difference * difference;
      candidate.tip_of_finger[finger] = static_cast<int>(tip++);
    }
    if (candidate.cost < best.cost) best = candidate;
  }
  return best;
}

}  // namespace

HandTracker::HandTracker(const StereoLenses& lenses, const HandTrackerOptions& options) : rig_(lenses), options_(options) {
  const auto pixels = static_cast<std::size_t>(rig_.width()) * static_cast<std::size_t>(rig_.height());
  left_.resize(pixels);
  right_.resize(pixels);
  blurred_.resize(pixels);
  labels_.resize(pixels);
}

void HandTracker::reset() {
  dark_.clear();
  known_.clear();
}

glm::dvec3 HandTracker::point_m(const glm::dvec2& pixel, double depth_m) const noexcept {
  const glm::dvec2 ray = rig_.ray(pixel);
  return {ray.x * depth_m - 0.5 * rig_.baseline_m(), depth_m, -ray.y * depth_m};
}

bool HandTracker::inside(const glm::dvec2& pixel, std::uint8_t label) const noexcept {
  const int x = static_cast<int>(std::lround(pixel.x)), y = static_cast<int>(std::lround(pixel.y));
  return x >= 0 && y >= 0 && x < rig_.width() && y < rig_.height() &&
         labels_[static_cast<std::size_t>(y * rig_.width() + x)] == label;
}

bool HandTracker::track(const Frame& frame, Hands& hands) {
  if (frame.views != 2 || frame.format != PixelFormat::kGray8 || frame.view_bytes() != rig_.device_pixels() ||
      frame.pixels.size() != 2 * frame.view_bytes())
    return false;
  if (frame.dark) {
    dark_ = frame.pixels;
    return false;
  }
  const std::vector<std::uint8_t>* pixels = &frame.pixels;
  if (dark_.size() == frame.pixels.size()) {
    lit_.resize(dark_.size());
    for (std::size_t i = 0; i < dark_.size(); ++i)
      lit_[i] = static_cast<std::uint8_t>(std::max(0, int{frame.pixels[i]} - int{dark_[i]}) + 1);
    pixels = &lit_;
  }
  const auto eye_pixels = [&](int eye) {
    return std::span(*pixels).subspan(static_cast<std::size_t>(eye) * frame.view_bytes(), frame.view_bytes());
  };

  const int width = rig_.width(), height = rig_.height();
  rig_.rectify(0, eye_pixels(0), 0, 0, width, height, left_);
  blur_121({left_.data(), width, height}, blurred_);
  const GrayView picture{blurred_.data(), width, height};
  hands.clear();
  previous_.swap(known_);
  known_.clear();
  const auto threshold = skin_threshold(picture, options_.skin_fraction, options_.skin_margin);
  if (!threshold) return true;
  // The palm of a small hand at the far end of the range, and no less.
  const double palm_px = 0.035 * rig_.focal_px() / options_.farthest_m;
  const auto regions = find_regions(picture, *threshold, static_cast<int>(kPi * palm_px * palm_px), options_.most_hands,
                                    labels_, stack_);
  const int d_max = static_cast<int>(std::ceil(rig_.focal_px() * rig_.baseline_m() / options_.nearest_m)) + 1;
  for (const Region& region : regions) {
    const auto silhouette = outline(region);
    if (!silhouette) continue;
    const int reach = static_cast<int>(4.0 * silhouette->radius_px);
    const glm::ivec2 palm(silhouette->palm_px);
    rig_.rectify(1, eye_pixels(1), std::max(0, palm.x - reach - d_max), std::max(0, palm.y - reach),
                 std::min(width, palm.x + reach), std::min(height, palm.y + reach), right_);
    if (auto hand = measure(*silhouette, frame.time)) hands.push_back(std::move(*hand));
  }
  return true;
}

std::optional<HandTracker::Silhouette> HandTracker::outline(const Region& region) {
  distance_inside(labels_, rig_.width(), rig_.height(), region, distance_);
  const int w = region.x1 - region.x0 + 2, h = region.y1 - region.y0 + 2;
  float thickest = 0.0F;
  std::vector<float> row_best(static_cast<std::size_t>(h));
  for (int y = 0; y < h; ++y) {
    const float* row = distance_.data() + y * w;
    row_best[static_cast<std::size_t>(y)] = *std::max_element(row, row + w);
    thickest = std::max(thickest, row_best[static_cast<std::size_t>(y)]);
  }
  // The arm may be as thick as the palm, but a wrist lies between: from the fingers' side up, the first thick place that is
  // followed by a narrower one.
  float radius = 0.0F;
  int palm_row = 0;
  for (int y = h - 1; y >= 0; --y) {
    const float here = row_best[static_cast<std::size_t>(y)];
    if (here > radius) {
      radius = here;
      palm_row = y;
    } else if (radius > 0.5F * thickest && here < 0.88F * radius) {
      break;
    }
  }
  if (radius < 3.0F) return std::nullopt;
  const float* row = distance_.data() + palm_row * w;
  const int palm_column = static_cast<int>(std::max_element(row, row + w) - row);

  Silhouette s;
  s.radius_px = static_cast<double>(radius);
  glm::dvec2 sum(0.0);
  double weight = 0.0;
  const int near = static_cast<int>(0.7F * radius);
  for (int y = std::max(0, palm_row - near); y <= std::min(h - 1, palm_row + near); ++y)
    for (int x = std::max(0, palm_column - near); x <= std::min(w - 1, palm_column + near); ++x) {
      const float d = distance_[static_cast<std::size_t>(y * w + x)];
      if (d <= 0.85F * radius) continue;
      const double share = static_cast<double>(d - 0.85F * radius);
      sum += share * glm::dvec2(x, y);
      weight += share;
    }
  s.palm_px = sum / weight + glm::dvec2(region.x0 - 1, region.y0 - 1);

  // The arm: the widest run of the silhouette along circles around the palm, on the user's side (up in the picture).
  constexpr int kDirections = 180;
  glm::dvec2 arm(0.0);
  for (const double circle : {1.5, 1.8, 2.1}) {
    std::array<bool, kDirections> in{};
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * kPi * i / kDirections;
      in[static_cast<std::size_t>(i)] =
          inside(s.palm_px + circle * s.radius_px * glm::dvec2(std::cos(angle), std::sin(angle)), region.label);
    }
    double best = 0.0;
    glm::dvec2 best_direction(0.0);
    for (int i = 0; i < kDirections; ++i) {
      if (!in[static_cast<std::size_t>(i)] || in[static_cast<std::size_t>((i + kDirections - 1) % kDirections)]) continue;
      int length = 0;
      while (length < kDirections && in[static_cast<std::size_t>((i + length) % kDirections)]) ++length;
      const double middle = 2.0 * kPi * (i + 0.5 * (length - 1)) / kDirections;
      const glm::dvec2 direction(std::cos(middle), std::sin(middle));
      const double score = length * (0.5 - direction.y);  // nothing of what points well to the fingers' side
      if (score > best) {
        best = score;
        best_direction = direction;
      }
    }
    arm += best_direction;
  }
  s.arm_seen = glm::length(arm) > 1.0;
  s.forward = s.arm_seen ? -glm::normalize(arm) : glm::dvec2(0.0, 1.0);

  // How far the silhouette reaches in every direction of the fingers' side.
  constexpr int kRays = 121;  // -120 to 120 degrees
  std::array<double, kRays> reach{};
  for (int i = 0; i < kRays; ++i) {
    const glm::dvec2 direction = rotated(s.forward, (2.0 * i - 120.0) * kDegree);
    double r = 0.8 * s.radius_px;
    while (r < 4.0 * s.radius_px && inside(s.palm_px + r * direction, region.label)) r += 0.5;
    reach[static_cast<std::size_t>(i)] = r / s.radius_px;
  }
  std::array<double, 55> front{};  // -54 to 54 degrees: four fingers without the thumb
  std::copy_n(reach.begin() + 33, front.size(), front.begin());
  std::nth_element(front.begin(), front.begin() + 43, front.end());
  s.reach = front[43];

  for (int i = 1; i + 1 < kRays; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (reach[at] < kTipReach || s.fingers.size() == 5) continue;
    // One finger: the run of rays that stay within 85 % of its longest.
    std::size_t low = at, high = at;
    bool is_top = true;
    while (low > 0 && reach[low - 1] > 0.85 * reach[at]) is_top = (reach[--low] < reach[at]) && is_top;
    while (high + 1 < kRays && reach[high + 1] > 0.85 * reach[at]) is_top = (reach[++high] <= reach[at]) && is_top;
    if (!is_top || low == 0 || high + 1 == kRays) continue;
    const double angle = (static_cast<double>(low + high) - 120.0) * kDegree;
    const double length = (reach[at] - kFingerRadius) * s.radius_px;
    // The middle of the finger across the ray, where its tip is round.
    const glm::dvec2 along = rotated(s.forward, angle), across(-along.y, along.x);
    glm::dvec2 tip = s.palm_px + length * along;
    double left = 0.0, right = 0.0;
    while (left < s.radius_px && inside(tip + left * across, region.label)) left += 0.5;
    while (right < s.radius_px && inside(tip - right * across, region.label)) right += 0.5;
    tip += 0.5 * (left - right) * across;
    s.fingers.push_back({tip, angle});
  }
  return s;
}

std::optional<HandFrame> HandTracker::measure(const Silhouette& s, TimestampNs time) {
  const GrayView left{left_.data(), rig_.width(), rig_.height()}, right{right_.data(), rig_.width(), rig_.height()};
  const double fb = rig_.focal_px() * rig_.baseline_m();
  const int d_min = std::max(1, static_cast<int>(fb / options_.farthest_m) - 1);
  const int d_max = static_cast<int>(std::ceil(fb / options_.nearest_m)) + 1;
  const auto match = match_disk(left, right, s.palm_px, 1.25 * s.radius_px, 1, d_min, d_max, 0.6);
  if (!match) return std::nullopt;

  HandFrame hand;
  hand.time = time;
  hand.valid = hand.tracked = true;
  hand.grab_strength = 1.0 - smooth_step((s.reach - kReachFist) / (kReachOpen - kReachFist));
  const double depth = fb / match->disparity_px;
  const double radius_m = s.radius_px * depth / rig_.focal_px();
  if (radius_m < 0.02 || radius_m > 0.09) return std::nullopt;  // not a hand
  hand.confidence = std::clamp((match->score - 0.6) / 0.35, 0.0, 1.0) * (s.arm_seen ? 1.0 : 0.5);

  const double grab = hand.grab_strength;
  const double forward_m = radius_m * glm::mix(kForwardOpen, kForwardFist, grab);
  const glm::dvec3 to_fingers(s.forward.x, 0.0, -s.forward.y);
  hand.palm.position_m = point_m(s.palm_px, depth) + forward_m * to_fingers;
  const double deeper = radius_m * glm::mix(kDeeperOpen, kDeeperFist, grab);
  hand.palm.position_m += deeper * glm::normalize(hand.palm.position_m);
  // -Z along the fingers, +Y up: a turn about Y.
  hand.palm.rotation = glm::angleAxis(std::atan2(-to_fingers.x, -to_fingers.z), glm::dvec3(0.0, 1.0, 0.0));

  Known known;
  const auto same = std::min_element(previous_.begin(), previous_.end(), [&](const Known& a, const Known& b) {
    return glm::distance(a.palm_m, hand.palm.position_m) < glm::distance(b.palm_m, hand.palm.position_m);
  });
  if (same != previous_.end() && glm::distance(same->palm_m, hand.palm.position_m) < 0.12) {
    known = *same;
    previous_.erase(same);
    if (time > known.time)
      hand.velocity_mps = (hand.palm.position_m - known.palm_m) / (1e-9 * static_cast<double>(time - known.time));
  } else {
    known.id = next_id_++;
  }
  known.palm_m = hand.palm.position_m;
  known.time = time;
  place_joints(s, depth + deeper, radius_m, known, hand);
  hand.id = known.id;
  known_.push_back(known);
  return hand;
}

void HandTracker::place_joints(const Silhouette& s, double depth_m, double radius_m, Known& known, HandFrame& hand) const {
  // In the picture positive angles turn from x to y; y is down and forward is mostly down, so a right hand, palm to the
  // device, has its thumb at positive angles.
  std::vector<std::size_t> order(s.fingers.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto angles_for = [&](bool right_hand) {
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return right_hand ? s.fingers[a].angle_rad > s.fingers[b].angle_rad : s.fingers[a].angle_rad < s.fingers[b].angle_rad;
    });
    std::vector<double> angles;
    for (const std::size_t i : order) angles.push_back(right_hand ? -s.fingers[i].angle_rad : s.fingers[i].angle_rad);
    return angles;
  };
  const Assignment as_left = assign(angles_for(false)), as_right = assign(angles_for(true));
  if (s.fingers.size() == 5 && std::abs(as_left.cost - as_right.cost) > 0.1)
    known.right_votes = std::clamp(known.right_votes + (as_right.cost < as_left.cost ? 1 : -1), -10, 10);
  const bool is_right = known.right_votes != 0 ? known.right_votes > 0 : as_right.cost <= as_left.cost;
  hand.chirality = known.right_votes == 0 ? Chirality::kUnknown : known.right_votes > 0 ? Chirality::kRight : Chirality::kLeft;
  (void)angles_for(is_right);  // leaves `order` for this hand
  const Assignment& assigned = is_right ? as_right : as_left;

  const glm::dvec3 forward = hand.palm.rotation * glm::dvec3(0, 0, -1), side = hand.palm.rotation * glm::dvec3(1, 0, 0);
  const double mirror = is_right ? 1.0 : -1.0;
  const auto on_palm = [&](const glm::dvec2& at) {
    return hand.palm.position_m + radius_m * (mirror * at.x * side + at.y * forward);
  };
  const auto put = [&](HandJoint which, const glm::dvec3& position, double radius, bool tracked) {
    hand.joint(which) = {{position, hand.palm.rotation}, radius * radius_m, true, tracked};
  };
  put(HandJoint::kPalm, hand.palm.position_m, 0.35, true);
  put(HandJoint::kWrist, on_palm({0.0, -kWristBehind}), 0.4, false);

  const GrayView left{left_.data(), rig_.width(), rig_.height()}, right{right_.data(), rig_.width(), rig_.height()};
  const double fb = rig_.focal_px() * rig_.baseline_m();
  for (std::size_t finger = 0; finger < 5; ++finger) {
    const FingerShape& shape = kShape[finger];
    const double thickness = finger == 0 ? kThumbRadius : kFingerRadius;
    const glm::dvec3 knuckle = on_palm(shape.knuckle);
    glm::dvec3 tip = knuckle + radius_m * shape.curled * (forward - glm::dvec3(0, 0.8, 0));
    bool seen = false;
    if (const int index = assigned.tip_of_finger[finger]; index >= 0) {
      const glm::dvec2 pixel = s.fingers[order[static_cast<std::size_t>(index)]].tip_px;
      const double expected = fb / depth_m;
      const auto match = match_disk(left, right, pixel, std::max(4.0, 0.4 * s.radius_px), 1,
                                    std::max(1, static_cast<int>(0.75 * expected)), static_cast<int>(1.35 * expected) + 1, 0.7);
      tip = point_m(pixel, match ? fb / match->disparity_px : depth_m);
      seen = match.has_value();
    }
    const int first = static_cast<int>(HandJoint::kThumbMetacarpal) + (finger == 0 ? 0 : 4 + 5 * (static_cast<int>(finger) - 1));
    const auto joint = [&](int i) { return static_cast<HandJoint>(first + i); };
    const int last = finger == 0 ? 3 : 4;
    put(joint(0), finger == 0 ? on_palm({-0.4, -0.8}) : on_palm({0.4 * shape.knuckle.x, -0.8}), 0.3, false);
    put(joint(1), knuckle, thickness * 1.2, false);
    for (int i = 2; i < last; ++i) {
      const double share = finger == 0 ? 0.6 : (i == 2 ? 0.5 : 0.8);
      put(joint(i), glm::mix(knuckle, tip, share), thickness, false);
    }
    put(joint(last), tip, thickness, seen);
  }
  hand.pinch_distance_m =
      glm::distance(hand.joint(HandJoint::kThumbTip).pose.position_m, hand.joint(HandJoint::kIndexTip).pose.position_m);
}

}  // namespace dubsar
