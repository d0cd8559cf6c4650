#include "input/tracking/hands/hand_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr std::size_t kN = HandFit::kParameters;
constexpr std::size_t kCones = kHandConeCount;
constexpr double kSampleSd = 0.35;

/// p: 0-2 position, 3-5 turn about the palm in the device's axes, 6 log size, 7-11 flexion, 12 spread, 13
/// wrist, 14 and 15 log of finger length and palm width.
HandPose moved(const HandPose& pose, const HandFit::Vector& p) {
  HandPose m = pose;
  m.palm.position_m += glm::dvec3(p[0], p[1], p[2]);
  const glm::dvec3 turn(p[3], p[4], p[5]);
  const double angle = glm::length(turn);
  if (angle > 1e-12) m.palm.rotation = glm::normalize(glm::angleAxis(angle, turn / angle) * m.palm.rotation);
  m.scale = std::clamp(m.scale * std::exp(p[6]), 0.5, 1.6);
  for (std::size_t f = 0; f < 5; ++f) m.flexion[f] = std::clamp(m.flexion[f] + p[7 + f], -0.15, 1.1);
  m.spread = std::clamp(m.spread + p[12], -0.3, 1.5);
  m.wrist_turn_rad = std::clamp(m.wrist_turn_rad + p[13], -0.7, 0.7);
  m.finger_length = std::clamp(m.finger_length * std::exp(p[14]), 0.7, 1.4);
  m.palm_width = std::clamp(m.palm_width * std::exp(p[15]), 0.7, 1.4);
  return m;
}

constexpr HandFit::Vector kDelta{1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3,
                                 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3};

glm::dvec3 eye_from_device(const glm::dvec3& p, double eye_x_m) { return {p.x - eye_x_m, -p.z, p.y}; }

RayBox box_of(const glm::dvec3& a, double radius_a, const glm::dvec3& b, double radius_b) {
  RayBox box{{1e9F, 1e9F}, {-1e9F, -1e9F}};
  for (const bool end : {false, true}) {
    const glm::vec3 c(end ? b : a);
    const auto r = static_cast<float>(end ? radius_b : radius_a);
    const float front = std::max(0.02F, c.z - r), back = c.z + r;
    box.low = glm::min(box.low, {(c.x - r) / (c.x > r ? back : front), (c.y - r) / (c.y > r ? back : front)});
    box.high = glm::max(box.high, {(c.x + r) / (c.x < -r ? back : front), (c.y + r) / (c.y < -r ? back : front)});
  }
  return box;
}

/// Cholesky in place; false: not positive definite.
bool solve(std::array<double, kN * kN> m, const HandFit::Vector& right, HandFit::Vector& x) {
  for (std::size_t j = 0; j < kN; ++j) {
    double d = m[j * kN + j];
    for (std::size_t k = 0; k < j; ++k) d -= m[j * kN + k] * m[j * kN + k];
    if (!(d > 1e-30)) return false;
    m[j * kN + j] = std::sqrt(d);
    for (std::size_t i = j + 1; i < kN; ++i) {
      double v = m[i * kN + j];
      for (std::size_t k = 0; k < j; ++k) v -= m[i * kN + k] * m[j * kN + k];
      m[i * kN + j] = v / m[j * kN + j];
    }
  }
  for (std::size_t i = 0; i < kN; ++i) {
    double v = right[i];
    for (std::size_t k = 0; k < i; ++k) v -= m[i * kN + k] * x[k];
    x[i] = v / m[i * kN + i];
  }
  for (std::size_t i = kN; i-- > 0;) {
    double v = x[i];
    for (std::size_t k = i + 1; k < kN; ++k) v -= m[k * kN + i] * x[k];
    x[i] = v / m[i * kN + i];
  }
  return true;
}

}  // namespace

void HandFit::assemble(std::span<const EyeSamples> eyes, const HandPrior& prior, const HandPose& pose,
                       const HandFitStep& how, Normal& normal) {
  const double blur_m = how.blur_m;
  const PosedHand hand = pose_hand(pose);
  for (std::size_t j = 0; j < kN; ++j) {
    Vector step{};
    step[j] = kDelta[j];
    const PosedHand other = pose_hand(moved(pose, step));
    const auto slope = [&](double to, double from) { return static_cast<float>((to - from) / kDelta[j]); };
    for (std::size_t c = 0; c < kCones; ++c) {
      // In the eye's axes: x, -z, y of the device.
      const Cone &from = hand.cones[c], &to = other.cones[c];
      kernels::ConeSlopes& v = slopes_[c];
      v.ax[j] = slope(to.a_m.x, from.a_m.x);
      v.ay[j] = -slope(to.a_m.z, from.a_m.z);
      v.az[j] = slope(to.a_m.y, from.a_m.y);
      v.bx[j] = slope(to.b_m.x, from.b_m.x);
      v.by[j] = -slope(to.b_m.z, from.b_m.z);
      v.bz[j] = slope(to.b_m.y, from.b_m.y);
      v.radius_a[j] = slope(to.radius_a_m, from.radius_a_m);
      v.radius_b[j] = slope(to.radius_b_m, from.radius_b_m);
    }
  }

  kernels::NormalSums sums{};
  double squares = 0.0;
  normal.samples = 0;
  for (const EyeSamples& eye : eyes) {
    best_.resize(eye.tiles.size());
    for (Best& b : best_) {
      b.depth.fill(-1.0F);
      b.cone.fill(0.0F);
    }
    const auto view = [&](std::size_t t) {
      const EyeSamples::Tile& tile = eye.tiles[t];
      return kernels::TileView{tile.rays->x.data(), tile.rays->y.data(),   tile.rays->z.data(), tile.skin.data(),
                               tile.weight.data(),  best_[t].depth.data(), best_[t].cone.data()};
    };
    const kernels::Outline outline{static_cast<float>(eye.half_skin), static_cast<float>(eye.light_x_m)};
    std::array<kernels::ConeTerms, kCones> terms;
    for (std::size_t c = 0; c < kCones; ++c) {
      const Cone& cone = hand.cones[c];
      const glm::dvec3 a = eye_from_device(cone.a_m, eye.eye_x_m), b = eye_from_device(cone.b_m, eye.eye_x_m),
                       e = b - a;
      const double change = cone.radius_b_m - cone.radius_a_m, ee = glm::dot(e, e);
      const auto f = [](double v) { return static_cast<float>(v); };
      terms[c] = {f(a.x),
                  f(a.y),
                  f(a.z),
                  f(e.x),
                  f(e.y),
                  f(e.z),
                  f(glm::dot(a, a)),
                  f(glm::dot(a, e)),
                  f(ee),
                  f(0.5 * (cone.radius_a_m + cone.radius_b_m) * change / ee),
                  f(cone.radius_a_m),
                  f(change)};
      if (a.z < 0.03 || b.z < 0.03) continue;
      const RayBox box = box_of(a, cone.radius_a_m + blur_m, b, cone.radius_b_m + blur_m);
      for (std::size_t t = 0; t < eye.tiles.size(); t += how.stride)
        if (eye.boxes[t].meets(box)) kernels::deepen(terms[c], static_cast<float>(c), outline, view(t));
    }
    for (std::size_t t = 0; t < eye.tiles.size(); t += how.stride)
      squares += static_cast<double>(
          kernels::add_samples(terms.data(), slopes_.data(), outline, view(t), static_cast<float>(blur_m), sums));
    normal.samples += eye.samples;
  }
  const double inverse_variance = static_cast<double>(how.stride) / (kSampleSd * kSampleSd);
  normal.squares = static_cast<double>(how.stride) * squares;
  normal.cost = 0.5 * inverse_variance * squares;
  for (std::size_t j = 0; j < kN; ++j) {
    normal.gradient[j] = inverse_variance * static_cast<double>(sums.gradient[j]);
    for (std::size_t k = 0; k <= j; ++k)
      normal.matrix[j * kN + k] = inverse_variance * static_cast<double>(sums.matrix[j * kernels::kHandLanes + k]);
  }

  const auto believe = [&](double difference, double sd, std::size_t j) {
    const double weight = (j == 6 ? 1.0 : how.shape_trust) / (sd * sd);
    normal.cost += 0.5 * weight * difference * difference;
    normal.gradient[j] += weight * difference;
    normal.matrix[j * kN + j] += weight;
  };
  believe(std::log(pose.scale / prior.pose.scale), prior.scale_sd, 6);
  for (std::size_t f = 0; f < 5; ++f) believe(pose.flexion[f] - prior.pose.flexion[f], prior.flexion_sd, 7 + f);
  believe(pose.spread - prior.pose.spread, prior.spread_sd, 12);
  believe(pose.wrist_turn_rad - prior.pose.wrist_turn_rad, prior.wrist_sd_rad, 13);
  believe(std::log(pose.finger_length / prior.pose.finger_length), prior.shape_sd, 14);
  believe(std::log(pose.palm_width / prior.pose.palm_width), prior.shape_sd, 15);
  // Tilt: the back of the hand (+Y) against the prior's; a turn w moves it by w x up.
  const glm::dvec3 up = pose.palm.rotation * glm::dvec3(0, 1, 0),
                   difference = up - prior.pose.palm.rotation * glm::dvec3(0, 1, 0);
  const double w = 1.0 / (prior.tilt_sd_rad * prior.tilt_sd_rad);
  normal.cost += 0.5 * w * (difference.x * difference.x + difference.z * difference.z);
  for (const int axis : {0, 2}) {
    // d up.x = w.y up.z - w.z up.y; d up.z = w.x up.y - w.y up.x
    const glm::dvec3 row = axis == 0 ? glm::dvec3(0, up.z, -up.y) : glm::dvec3(up.y, -up.x, 0);
    for (int j = 0; j < 3; ++j) {
      normal.gradient[static_cast<std::size_t>(3 + j)] += w * row[j] * difference[axis];
      for (int k = 0; k <= j; ++k)
        normal.matrix[static_cast<std::size_t>(3 + j) * kN + static_cast<std::size_t>(3 + k)] += w * row[j] * row[k];
    }
  }
}

HandFitResult HandFit::fit(std::span<const EyeSamples> eyes, const HandPrior& prior, const HandPose& start,
                           std::span<const HandFitStep> steps) {
  HandPose pose = start;
  Normal now, next;
  for (const HandFitStep& step : steps) {
    assemble(eyes, prior, pose, step, now);
    double damping = 1e-3;
    for (int iteration = 0; iteration < step.iterations; ++iteration) {
      std::array<double, kN* kN> matrix = now.matrix;
      for (std::size_t j = 0; j < kN; ++j) matrix[j * kN + j] *= 1.0 + damping;
      Vector change{};
      Vector downhill = now.gradient;
      for (double& g : downhill) g = -g;
      if (!solve(matrix, downhill, change)) break;
      const HandPose candidate = moved(pose, change);
      assemble(eyes, prior, candidate, step, next);
      if (next.cost < now.cost) {
        const bool settled = now.cost - next.cost < 1e-3 * now.cost;
        pose = candidate;
        std::swap(now, next);
        damping *= 0.2;
        if (settled) break;
      } else {
        damping = std::max(damping * 20.0, 1e-2);
      }
    }
  }
  return {pose, now.cost, now.samples > 0 ? std::sqrt(now.squares / now.samples) : 1.0};
}

}  // namespace dubsar
