#include "input/tracking/hands/hand_tracker.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace dubsar {
namespace {

// First guess, in units of the palm radius R, the largest circle in the silhouette of the palm: how far before its
// centre and how much deeper than what correlation finds the centre of the palm lies, open hand and fist.
constexpr double kForwardOpen = 0.0, kForwardFist = -0.06;
constexpr double kDeeperOpen = 0.11, kDeeperFist = 1.0;

// Reach of the fingers (in R) of a fist and of an open hand.
constexpr double kReachFist = 1.55, kReachOpen = 2.45;

// Part of the brightness of the palm from which on a pixel is skin and nothing else. Half of it is the outline.
constexpr double kFullSkin = 0.5;
constexpr double kBehindPalm = 1.3;   // R: what lies farther to the arm is not looked at: it may be a sleeve
constexpr double kManyPixels = 0.27;  // metres: nearer than this every second column is enough

double smooth_step(double t) { return t = std::clamp(t, 0.0, 1.0), t * t * (3.0 - 2.0 * t); }

std::array<EyeRays, 2> rays_of(const StereoLenses& lenses, int step) {
  return {EyeRays(lenses.ray_from_pixel[0], lenses.width, lenses.height, step),
          EyeRays(lenses.ray_from_pixel[1], lenses.width, lenses.height, step)};
}

/// The 26 joints of the fitted hand. Bent fingers are not in view: valid, not tracked; like everything without a fit.
void set_joints(const HandPose& pose, bool fits, HandFrame& hand) {
  const PosedHand posed = pose_hand(pose);
  const auto put = [&](HandJoint which, const glm::dvec3& at, double radius, bool tracked) {
    hand.joint(which) = {{at, hand.palm.rotation}, radius, true, tracked};
  };
  put(HandJoint::kPalm, posed.palm_m, 0.015 * pose.scale, true);
  put(HandJoint::kWrist, posed.wrist_m, 0.017 * pose.scale, fits);
  for (std::size_t finger = 0; finger < 5; ++finger) {
    const bool seen = fits && pose.flexion[finger] < 0.5 && hand.grab_strength < 0.5;
    const std::size_t count = finger == 0 ? 4 : 5;
    const int first =
        static_cast<int>(HandJoint::kThumbMetacarpal) + (finger == 0 ? 0 : 4 + 5 * (static_cast<int>(finger) - 1));
    for (std::size_t i = 0; i < count; ++i)
      put(static_cast<HandJoint>(first + static_cast<int>(i)), posed.joints_m[finger][i], posed.radii_m[finger][i],
          seen || (fits && i + 3 < count));
  }
  hand.pinch_distance_m = glm::distance(posed.tips_m[0], posed.tips_m[1]);
}

}  // namespace

HandTracker::HandTracker(const StereoLenses& lenses, const HandTrackerOptions& options)
    : rig_(lenses), options_(options), rays_{rays_of(lenses, 1), rays_of(lenses, 2)} {
  const auto pixels = static_cast<std::size_t>(rig_.width()) * static_cast<std::size_t>(rig_.height());
  pictures_.left.resize(pixels);
  pictures_.right.resize(pixels);
  pictures_.blurred.resize(pixels);
  pictures_.labels.resize(pixels);
}

void HandTracker::reset() {
  pictures_.dark.clear();
  known_.forget();
}

bool HandTracker::track(const Frame& frame, Hands& hands) {
  if (frame.views != 2 || frame.format != PixelFormat::kGray8 || frame.view_bytes() != rig_.device_pixels() ||
      frame.pixels.size() != 2 * frame.view_bytes())
    return false;
  if (frame.dark) {
    pictures_.dark = frame.pixels;
    return false;
  }
  pixels_ = frame.pixels;
  if (pictures_.dark.size() == frame.pixels.size()) {
    pictures_.lit.resize(pictures_.dark.size());
    for (std::size_t i = 0; i < pictures_.dark.size(); ++i)
      pictures_.lit[i] = static_cast<std::uint8_t>(std::max(0, int{frame.pixels[i]} - int{pictures_.dark[i]}) + 1);
    pixels_ = pictures_.lit;
  }

  const int width = rig_.width(), height = rig_.height();
  rig_.rectify(0, eye_pixels(0), 0, 0, width, height, pictures_.left);
  blur_121({pictures_.left.data(), width, height}, pictures_.blurred);
  const GrayView picture{pictures_.blurred.data(), width, height};
  hands.clear();
  known_.begin_frame();
  const auto threshold = skin_threshold(picture, options_.skin_fraction, options_.skin_margin);
  if (!threshold) return true;
  // The palm of a small hand at the far end of the range, and no less.
  const double palm_px = 0.035 * rig_.focal_px() / options_.farthest_m;
  const auto regions = find_regions(picture, threshold->grey, static_cast<int>(std::numbers::pi * palm_px * palm_px),
                                    options_.most_hands, pictures_.labels, pictures_.stack);
  const int d_max = static_cast<int>(std::ceil(rig_.focal_px() * rig_.baseline_m() / options_.nearest_m)) + 1;
  for (const Region& region : regions) {
    const auto silhouette = outline(pictures_.labels, width, height, region, pictures_.distance);
    if (!silhouette) continue;
    const int reach = static_cast<int>(1.5 * silhouette->radius_px);
    const glm::ivec2 palm(silhouette->palm_px);
    rig_.rectify(1, eye_pixels(1), std::max(0, palm.x - reach - d_max), std::max(0, palm.y - reach),
                 std::min(width, palm.x + reach), std::min(height, palm.y + reach), pictures_.right);
    double confidence = 0.0;
    const auto first = guess(*silhouette, confidence);
    if (!first) continue;
    hands.push_back(measure(region, *silhouette, *first, threshold->background, frame.time));
    hands.back().confidence *= confidence;
  }
  return true;
}

std::optional<HandGuess> HandTracker::guess(const Silhouette& s, double& confidence) const {
  const GrayView left{pictures_.left.data(), rig_.width(), rig_.height()},
      right{pictures_.right.data(), rig_.width(), rig_.height()};
  const double fb = rig_.focal_px() * rig_.baseline_m();
  const int d_min = std::max(1, static_cast<int>(fb / options_.farthest_m) - 1);
  const int d_max = static_cast<int>(std::ceil(fb / options_.nearest_m)) + 1;
  const auto match = match_disk(left, right, s.palm_px, 1.25 * s.radius_px, 1, d_min, d_max, 0.6);
  HandGuess g;
  if (match) {
    g.depth_m = fb / match->disparity_px;
  } else {
    // As far as a hand of the last frame that was seen in this place.
    const auto here = std::find_if(known_.previous().begin(), known_.previous().end(), [&](const KnownHand& known) {
      const glm::dvec3& palm = known.palm_m;
      const glm::dvec2 seen((palm.x + 0.5 * rig_.baseline_m()) / palm.y, -palm.z / palm.y);
      return glm::distance(seen, rig_.ray(s.palm_px)) < s.radius_px / rig_.focal_px();
    });
    if (here == known_.previous().end()) return std::nullopt;
    g.depth_m = here->palm_m.y;
  }
  g.pixel_m = g.depth_m / rig_.focal_px();
  g.radius_m = s.radius_px * g.pixel_m;
  if (g.radius_m < 0.02 || g.radius_m > 0.09) return std::nullopt;  // not a hand
  confidence = std::clamp(((match ? match->score : 0.7) - 0.6) / 0.35, 0.0, 1.0) * (s.arm_seen ? 1.0 : 0.5);
  g.grab = 1.0 - smooth_step((s.reach - kReachFist) / (kReachOpen - kReachFist));
  g.finger_rad = s.finger_rad;
  const glm::dvec3 to_fingers(s.forward.x, 0.0, -s.forward.y);
  g.turn_rad = std::atan2(-to_fingers.x, -to_fingers.z);
  const glm::dvec2 ray = rig_.ray(s.palm_px);
  g.palm_m = glm::dvec3(ray.x * g.depth_m - 0.5 * rig_.baseline_m(), g.depth_m, -ray.y * g.depth_m) +
             g.radius_m * glm::mix(kForwardOpen, kForwardFist, g.grab) * to_fingers;
  g.palm_m += g.radius_m * glm::mix(kDeeperOpen, kDeeperFist, g.grab) * glm::normalize(g.palm_m);
  return g;
}

void HandTracker::sample(int eye, const Region& region, const Silhouette& s, double depth_m, int background,
                         EyeSamples& samples) const {
  const double f = rig_.focal_px(), r = s.radius_px;
  const glm::dvec2 shift(eye == 0 ? 0.0 : f * rig_.baseline_m() / depth_m, 0.0);
  const glm::dvec2 margin(0.5 * r);
  glm::dvec2 low(region.x0, region.y0), high(region.x1, region.y1);
  low = glm::max(low, s.palm_px - glm::dvec2(6.0 * r, 2.0 * r)) - margin;
  high = glm::min(high, s.palm_px + glm::dvec2(6.0 * r)) + margin;
  const RayBox box{glm::vec2(rig_.ray(low - shift)), glm::vec2(rig_.ray(high - shift))};
  const std::span<const std::uint8_t> picture = eye_pixels(eye);
  samples.tiles.clear();
  samples.boxes.clear();
  samples.samples = 0;
  samples.eye_x_m = (eye == 0 ? -0.5 : 0.5) * rig_.baseline_m();
  samples.light_x_m = -samples.eye_x_m;  // the middle of the lights is the middle of the device
  samples.half_skin = 0.5 * kFullSkin;
  const glm::dvec2 centre(0.5 * (rig_.width() - 1), 0.5 * (rig_.height() - 1));
  std::vector<float> palm;
  double dark_squares = 0.0;
  int dark = 0;
  const EyeRays& set = rays_[depth_m < kManyPixels ? 1 : 0][static_cast<std::size_t>(eye)];
  for (std::size_t t = 0; t < set.tiles().size(); ++t) {
    if (!set.boxes()[t].meets(box)) continue;
    const EyeRays::Tile& rays = set.tiles()[t];
    EyeSamples::Tile& tile = samples.tiles.emplace_back();
    tile.rays = &rays;
    samples.boxes.push_back(set.boxes()[t]);
    for (std::size_t i = 0; i < EyeRays::kLanes; ++i) {
      const double z = static_cast<double>(rays.z[i]);
      const glm::dvec2 at =
          glm::dvec2(static_cast<double>(rays.x[i]), static_cast<double>(rays.y[i])) / z * f + centre + shift;
      // Light falls with the square of the distance: compared with skin of the same depth in the middle.
      tile.skin[i] = static_cast<float>(static_cast<double>(picture[rays.pixel[i]] - background) / (z * z));
      const int x = static_cast<int>(std::lround(at.x)), y = static_cast<int>(std::lround(at.y));
      if (x < 0 || y < 0 || x >= rig_.width() || y >= rig_.height()) continue;
      const std::uint8_t label = pictures_.labels[static_cast<std::size_t>(y * rig_.width() + x)];
      const glm::dvec2 from_palm = at - s.palm_px;
      if (label == region.label && glm::dot(from_palm, from_palm) < r * r) palm.push_back(tile.skin[i]);
      const bool another = label != 0 && label != kDroppedRegion && label != region.label;
      if (another || glm::dot(from_palm, s.forward) < -kBehindPalm * r) continue;
      tile.weight[i] = 1.0F;
      ++samples.samples;
      if (tile.skin[i] < 0.0F) {  // the dark half of the background's noise
        ++dark;
        dark_squares += static_cast<double>(tile.skin[i] * tile.skin[i]);
      }
    }
  }
  if (palm.empty()) return;
  const auto middle = palm.begin() + static_cast<std::ptrdiff_t>(0.6 * static_cast<double>(palm.size()));
  std::nth_element(palm.begin(), middle, palm.end());
  const float scale = 1.0F / std::max(static_cast<float>(kFullSkin) * *middle, 1.0F);
  for (EyeSamples::Tile& tile : samples.tiles)
    for (float& skin : tile.skin) skin = std::clamp(skin * scale, -0.5F, 1.0F);
  // Only the background shows it: skin is cut at 1.
  samples.noise =
      samples.samples > 0 ? static_cast<double>(scale) * std::sqrt(2.0 * dark_squares / samples.samples) : 0.0;
}

HandFrame HandTracker::measure(const Region& region, const Silhouette& s, const HandGuess& guess, int background,
                               TimestampNs time) {
  KnownHand known = known_.take(guess.palm_m);
  for (const int eye : {0, 1})
    sample(eye, region, s, guess.depth_m, background, samples_[static_cast<std::size_t>(eye)]);
  const FoundHand found = search_hand(fit_, samples_, guess, known.memory);

  HandFrame hand;
  hand.time = time;
  hand.id = known.id;
  hand.valid = hand.tracked = true;
  hand.confidence = found.fits ? 1.0 : 0.3;
  hand.palm = found.pose.palm;
  const auto& bent = found.pose.flexion;
  hand.grab_strength = found.fits ? std::clamp(0.25 * (bent[1] + bent[2] + bent[3] + bent[4]), 0.0, 1.0) : guess.grab;
  const int votes = known.memory.right_votes;
  hand.chirality = votes == 0 ? Chirality::kUnknown : votes > 0 ? Chirality::kRight : Chirality::kLeft;
  if (known.time != 0 && time > known.time)
    hand.velocity_mps = (hand.palm.position_m - known.palm_m) / (1e-9 * static_cast<double>(time - known.time));
  known.palm_m = hand.palm.position_m;
  known.time = time;
  set_joints(found.pose, found.fits, hand);
  known_.keep(known);
  return hand;
}

}  // namespace dubsar
