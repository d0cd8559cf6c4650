#pragma once
// A scanner for tests: analytic line integrals of ellipsoids, a curve of what rays lose, uneven pixels, an axis that is
// off, and filtered backprojection by its formula. It shares nothing with core/rays.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "core/volume/volume.h"

namespace dubsar::test {

/// Adds `density` inside; centre and half axes in voxels, from the middle of the grid.
struct Ellipsoid {
  double x, y, z, a, b, c, density;
};

struct Scanner {
  int views = 160;
  double turn = std::numbers::pi;          ///< angle of all views
  double first_angle = 0.0;                ///< of the first view
  double axis_off = 0.0;                   ///< pixels
  std::function<double(double)> recorded;  ///< of a straight line integral; nothing: the same
  double stray = 0.0;       ///< scatter over the open beam where it is most, of a field over the detector
  double absorbed = 0.045;  ///< by a voxel of clay, and
  double spread = 20.0;     ///< voxels, where there is such a field
  double noise = 0.0;       ///< of a recorded line integral, standard deviation
  double uneven = 0.0;      ///< of pixels: standard deviation of what they add to a line integral
  unsigned seed = 1;
};

/// A tablet in its envelope: clay of density 1, a gap, and a pit in the long side of the tablet.
inline std::vector<Ellipsoid> tablet_in_envelope(double scale) {
  std::vector<Ellipsoid> parts{{0, 0, 0, 43, 27, 40, 1}, {0, 0, 0, 31, 17, 30, -1}, {0, 0, 0, 28, 14, 27, 1}};
  for (Ellipsoid& e : parts)
    for (double* value : {&e.x, &e.y, &e.z, &e.a, &e.b, &e.c}) *value *= scale;
  return parts;
}

/// Line integral at distance `u` from the axis of rays perpendicular to (cos, sin), in the slice `z`.
inline double line_integral(const std::vector<Ellipsoid>& object, double cosine, double sine, double u, double z) {
  double sum = 0.0;
  for (const Ellipsoid& e : object) {
    const double depth = 1.0 - (z - e.z) * (z - e.z) / (e.c * e.c);
    if (depth <= 0.0) continue;
    const double a = e.a * std::sqrt(depth), b = e.b * std::sqrt(depth);
    const double reach2 = a * a * cosine * cosine + b * b * sine * sine;
    const double at = u - e.x * cosine - e.y * sine;
    if (at * at < reach2) sum += e.density * 2.0 * a * b * std::sqrt(reach2 - at * at) / reach2;
  }
  return sum;
}

/// Scatter of one view, [z][u]: light that is absorbed, a L e^(-a L), spread by a Gauss over the detector, and 1 where
/// it is most.
inline std::vector<double> stray_of_view(const std::vector<Ellipsoid>& object, Dims dims, const Scanner& scanner,
                                         double cosine, double sine, int half) {
  const int bins = 2 * half + 1, planes = static_cast<int>(dims.z);
  const auto at = [bins](int z, int u) {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(bins) + static_cast<std::size_t>(u);
  };
  std::vector<double> source(static_cast<std::size_t>(bins) * static_cast<std::size_t>(planes)), across(source),
      out(source);
  for (int z = 0; z < planes; ++z)
    for (int u = 0; u < bins; ++u) {
      const double p = scanner.absorbed *
                       line_integral(object, cosine, sine, u - half + scanner.axis_off, z - 0.5 * double(planes - 1));
      source[at(z, u)] = p * std::exp(-p);
    }
  const auto weight = [&](int k) { return std::exp(-0.5 * k * k / (scanner.spread * scanner.spread)); };
  for (int z = 0; z < planes; ++z)
    for (int u = 0; u < bins; ++u)
      for (int v = 0; v < bins; ++v) across[at(z, u)] += weight(u - v) * source[at(z, v)];
  for (int z = 0; z < planes; ++z)
    for (int u = 0; u < bins; ++u)
      for (int w = 0; w < planes; ++w) out[at(z, u)] += weight(z - w) * across[at(w, u)];
  return out;
}

inline Volume<float> scan(const std::vector<Ellipsoid>& object, Dims dims, const Scanner& scanner) {
  const int half = static_cast<int>(std::ceil(0.5 * std::hypot(double(dims.x), double(dims.y)))) + 2,
            bins = 2 * half + 1;
  std::vector<std::vector<double>> strays;
  double most_stray = 0.0;
  for (int view = 0; scanner.stray > 0.0 && view < scanner.views; ++view) {
    const double angle = scanner.first_angle + scanner.turn * view / scanner.views;
    strays.push_back(stray_of_view(object, dims, scanner, std::cos(angle), std::sin(angle), half));
    most_stray = std::max(most_stray, *std::max_element(strays.back().begin(), strays.back().end()));
  }
  std::mt19937 random(scanner.seed);
  std::normal_distribution<double> normal;
  Volume<float> out(dims);
  std::fill(out.voxels.data(), out.voxels.data() + dims.count(), 0.0F);
  std::vector<double> p(static_cast<std::size_t>(bins)), q(p);
  for (std::int64_t z = 0; z < dims.z; ++z) {
    std::vector<double> stripes(p.size());
    for (double& s : stripes) s = scanner.uneven * normal(random);
    for (int view = 0; view < scanner.views; ++view) {
      const double angle = scanner.first_angle + scanner.turn * view / scanner.views;
      const double c = std::cos(angle), s = std::sin(angle);
      for (int u = 0; u < bins; ++u) {
        double sum = 0.0;  // over the width of a pixel
        for (const double part : {-1.0 / 3.0, 0.0, 1.0 / 3.0})
          sum += line_integral(object, c, s, u - half + part + scanner.axis_off, double(z) - 0.5 * double(dims.z - 1)) /
                 3.0;
        if (scanner.recorded) sum = scanner.recorded(sum);
        if (scanner.stray > 0.0) {
          const double stray = strays[static_cast<std::size_t>(view)][static_cast<std::size_t>(z * bins + u)];
          sum = -std::log(std::exp(-scanner.absorbed * sum) + scanner.stray * stray / most_stray) / scanner.absorbed;
        }
        p[static_cast<std::size_t>(u)] = sum + stripes[static_cast<std::size_t>(u)] + scanner.noise * normal(random);
      }
      for (int u = 0; u < bins; ++u) {
        double sum = 0.25 * p[static_cast<std::size_t>(u)];
        for (int v = (u + 1) % 2; v < bins; v += 2)
          sum -= p[static_cast<std::size_t>(v)] / (std::numbers::pi * std::numbers::pi * (u - v) * (u - v));
        q[static_cast<std::size_t>(u)] = sum * std::numbers::pi / scanner.views;
      }
      for (std::int64_t y = 0; y < dims.y; ++y)
        for (std::int64_t x = 0; x < dims.x; ++x) {
          const double at =
              (double(x) - 0.5 * double(dims.x - 1)) * c + (double(y) - 0.5 * double(dims.y - 1)) * s + half;
          const auto cell = static_cast<std::size_t>(at);
          const double right = at - double(cell);
          out.at(x, y, z) += static_cast<float>((1.0 - right) * q[cell] + right * q[cell + 1]);
        }
    }
  }
  return out;
}

/// Light that was scattered adds `scatter` of the open beam to each ray; `absorbed`: per voxel of clay. What is
/// recorded of a straight line integral, in voxels of clay.
inline std::function<double(double)> scattering(double scatter, double absorbed) {
  return
      [=](double length) { return -std::log((std::exp(-absorbed * length) + scatter) / (1.0 + scatter)) / absorbed; };
}

/// The inverse of scattering().
inline double straight_length(double recorded, double scatter, double absorbed) {
  return -std::log((1.0 + scatter) * std::exp(-absorbed * recorded) - scatter) / absorbed;
}

}  // namespace dubsar::test
