#include "devices/leap/hand_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace dubsar {
namespace {

/// A cone in the frame of one eye: x to the right eye, y down the picture, z out of the device. Metres.
struct EyeCone {
  glm::dvec3 a, ab;
  double radius_a, radius_change, length2;
};

glm::dvec3 eye_from_device(const glm::dvec3& p, double eye_x_m) { return {p.x - eye_x_m, -p.z, p.y}; }

/// First hit of the ray t * d (d.z = 1) with a round cone, by sphere tracing its distance, which never oversteps.
double hit(const EyeCone& cone, const glm::dvec3& d, double inverse_length, double t, double t_end,
           glm::dvec3& normal) {
  for (int step = 0; step < 64 && t < t_end; ++step) {
    const glm::dvec3 ap = d * t - cone.a;
    const double s = std::clamp(glm::dot(ap, cone.ab) / cone.length2, 0.0, 1.0);
    const glm::dvec3 away = ap - cone.ab * s;
    const double axis_distance = glm::length(away);
    const double distance = axis_distance - (cone.radius_a + s * cone.radius_change);
    if (distance < 2e-5) {
      normal = away / std::max(axis_distance, 1e-9);
      return t;
    }
    t += distance * inverse_length;
  }
  return std::numeric_limits<double>::infinity();
}

/// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t next_random(std::uint64_t& state) noexcept {
  std::uint64_t z = state += 0x9e3779b97f4a7c15U;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
  z = (z ^ z >> 27) * 0x94d049bb133111ebU;
  return z ^ z >> 31;
}

std::vector<float> rays_of(const lmc1::Lens& lens, int width, int height) {
  std::vector<float> rays;
  rays.reserve(2U * static_cast<std::size_t>(width * height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 ray = lens.ray_from_pixel({x, y});
      rays.push_back(static_cast<float>(ray.x));
      rays.push_back(static_cast<float>(ray.y));
    }
  return rays;
}

}  // namespace

HandRenderer::HandRenderer(const lmc1::Calibration& calibration, const HandRenderOptions& options)
    : options_(options),
      left_{-0.5e-3 * calibration.baseline_mm, lmc1::Lens(calibration.left, options.width, options.height), {}},
      right_{0.5e-3 * calibration.baseline_mm, lmc1::Lens(calibration.right, options.width, options.height), {}} {
  left_.rays = rays_of(left_.lens, options.width, options.height);
  right_.rays = rays_of(right_.lens, options.width, options.height);
}

void HandRenderer::render(std::span<const PosedHand> hands, std::uint64_t seed, std::span<std::uint8_t> left,
                          std::span<std::uint8_t> right) const {
  render_eye(left_, hands, 2 * seed, left);
  render_eye(right_, hands, 2 * seed + 1, right);
}

void HandRenderer::render_eye(const Eye& eye, std::span<const PosedHand> hands, std::uint64_t seed,
                              std::span<std::uint8_t> picture) const {
  const int width = options_.width, height = options_.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  DUBSAR_CHECK(picture.size() == pixels);
  std::vector<float> depth(pixels, std::numeric_limits<float>::infinity()), light(pixels, 0.0F);

  for (const PosedHand& hand : hands) {
    for (const Cone& cone : hand.cones) {
      EyeCone c;
      c.a = eye_from_device(cone.a_m, eye.x_m);
      c.ab = eye_from_device(cone.b_m, eye.x_m) - c.a;
      c.radius_a = cone.radius_a_m;
      c.radius_change = cone.radius_b_m - cone.radius_a_m;
      c.length2 = std::max(glm::dot(c.ab, c.ab), 1e-12);
      // Pixels that can see it: the box around the pictures of both end spheres.
      int x0 = width, x1 = -1, y0 = height, y1 = -1;
      bool behind = false;
      double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
      for (const double s : {0.0, 1.0}) {
        const glm::dvec3 centre = c.a + c.ab * s;
        const double radius = c.radius_a + s * c.radius_change, front = centre.z - radius;
        behind = behind || front < 0.02;
        nearest = std::min(nearest, front);
        farthest = std::max(farthest, centre.z + radius);
        for (const double dx : {-1.0, 1.0})
          for (const double dy : {-1.0, 1.0}) {
            const glm::dvec2 ray((centre.x + dx * radius) / std::max(dx * centre.x > 0 ? front : centre.z, 0.02),
                                 (centre.y + dy * radius) / std::max(dy * centre.y > 0 ? front : centre.z, 0.02));
            const auto pixel = eye.lens.pixel_from_ray(ray);
            const glm::dvec2 at = pixel ? *pixel : glm::dvec2(dx > 0 ? width : 0, dy > 0 ? height : 0);
            x0 = std::min(x0, static_cast<int>(std::floor(std::clamp(at.x, 0.0, width - 1.0))) - 2);
            x1 = std::max(x1, static_cast<int>(std::ceil(std::clamp(at.x, 0.0, width - 1.0))) + 2);
            y0 = std::min(y0, static_cast<int>(std::floor(std::clamp(at.y, 0.0, height - 1.0))) - 2);
            y1 = std::max(y1, static_cast<int>(std::ceil(std::clamp(at.y, 0.0, height - 1.0))) + 2);
          }
      }
      if (behind) continue;  // nearer than 20 mm: the device sees nothing useful there
      for (int y = std::max(y0, 0); y <= std::min(y1, height - 1); ++y)
        for (int x = std::max(x0, 0); x <= std::min(x1, width - 1); ++x) {
          const std::size_t at =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
          const glm::dvec3 d(eye.rays[2 * at], eye.rays[2 * at + 1], 1.0);
          const double length = glm::length(d);
          glm::dvec3 normal;
          const double t = hit(c, d, 1.0 / length, nearest, std::min<double>(farthest, depth[at]), normal);
          if (!(t < static_cast<double>(depth[at]))) continue;
          depth[at] = static_cast<float>(t);
          const auto lit_from = [&](const glm::dvec3& place) {
            const glm::dvec3 from = d * t - place;
            const double range = glm::length(from);
            return std::max(0.0, -glm::dot(normal, from) / range) * (0.2 / range) * (0.2 / range);
          };
          double sum = options_.light_x_m.empty() ? lit_from({0.0, 0.0, 0.0}) : 0.0;
          for (const double x_m : options_.light_x_m)
            sum += lit_from({x_m - eye.x_m, 0.0, 0.0}) / static_cast<double>(options_.light_x_m.size());
          light[at] = static_cast<float>(sum);
        }
    }
  }

  // The sum of four uniform numbers is near enough to normal for a sensor: variance 4/12.
  constexpr double kScale = 1.7320508075688772 / 65536.0;
  const double light_level = options_.lights_on ? options_.reflected : 0.0;
  std::uint64_t state = seed;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint64_t bits = next_random(state);
    double noise = -2.0 * 65535.0;
    for (int k = 0; k < 4; ++k) noise += static_cast<double>(bits >> 16 * k & 0xffffU);
    const double grey =
        options_.ambient + light_level * static_cast<double>(light[i]) + options_.noise_sd * kScale * noise;
    picture[i] = static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0));
  }
}

lmc1::Calibration example_calibration(bool distorted) {
  lmc1::Calibration calibration;
  calibration.version = 1;
  calibration.score = 135;
  calibration.unix_time = 1363910400;  // 2013-03-22
  calibration.baseline_mm = 40.089F;
  calibration.left.focal_px = 133.905F;
  calibration.right.focal_px = 133.931F;
  calibration.left.offset_x_px = -0.56F;
  calibration.left.offset_y_px = 4.30F;
  calibration.right.offset_x_px = 0.94F;
  calibration.right.offset_y_px = 6.33F;
  for (lmc1::EyeCalibration* eye : {&calibration.left, &calibration.right}) {
    eye->old_focal_px = 131.365F;
    if (distorted) eye->radial = {1.272F, 0.2982F, 0.0177F, 1.464F, 0.3432F, -0.00671F};
  }
  return calibration;
}

}  // namespace dubsar
