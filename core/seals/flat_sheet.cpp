#include "core/seals/flat_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <limits>
#include <numbers>

namespace dubsar {
namespace {

constexpr int kFlatRounds = 20;  // after five nothing moves on bands that are nearly developable
constexpr int kGradientSteps = 60;
constexpr double kGradientEnd = 1e-10;  // of the first residual

/// A triangle of the sheet in a plane of its own, and the weights of its edges: half cotangents of the opposite angles.
struct OwnPlane {
  std::array<std::size_t, 3> corner{};
  std::array<glm::dvec2, 3> own{};
  std::array<double, 3> weight{};  ///< of the edge from corner k to the next
};

std::vector<OwnPlane> triangles_of(const FlatSheet& sheet) {
  std::vector<OwnPlane> out;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    const glm::dvec3 ab = sheet.base_mm[b] - sheet.base_mm[a], ac = sheet.base_mm[c] - sheet.base_mm[a];
    const double length = glm::length(ab), twice = glm::length(glm::cross(ab, ac));
    if (!(twice > 1e-12)) return;
    OwnPlane t{{a, b, c}, {glm::dvec2(0.0), {length, 0.0}, {glm::dot(ab, ac) / length, twice / length}}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec2 p = t.own[k] - t.own[(k + 2) % 3], q = t.own[(k + 1) % 3] - t.own[(k + 2) % 3];
      t.weight[k] = std::max(0.5 * glm::dot(p, q) / twice, 1e-3);  // a blunt angle must not push points apart
    }
    out.push_back(t);
  };
  for (int j = 0; j + 1 < sheet.rows; ++j)
    for (int i = 0; i + 1 < sheet.columns; ++i) {
      add(sheet.index(i, j), sheet.index(i + 1, j), sheet.index(i + 1, j + 1));
      add(sheet.index(i, j), sheet.index(i + 1, j + 1), sheet.index(i, j + 1));
    }
  return out;
}

/// The map from a triangle's own plane to where its corners lie flat: columns of its matrix.
glm::dmat2 map_of(const OwnPlane& t, const std::vector<glm::dvec2>& flat) {
  const glm::dmat2 own(t.own[1] - t.own[0], t.own[2] - t.own[0]),
      laid(flat[t.corner[1]] - flat[t.corner[0]], flat[t.corner[2]] - flat[t.corner[0]]);
  return laid * glm::inverse(own);
}

std::array<double, 2> singular_values(const glm::dmat2& m) {
  const double e = 0.5 * (m[0][0] + m[1][1]), f = 0.5 * (m[0][0] - m[1][1]), g = 0.5 * (m[0][1] + m[1][0]),
               h = 0.5 * (m[0][1] - m[1][0]), q = std::hypot(e, h), r = std::hypot(f, g);
  return {q + r, std::abs(q - r)};
}

class GlobalStep {
 public:
  GlobalStep(const std::vector<OwnPlane>& triangles, std::size_t points) : triangles_(triangles), diagonal_(points) {
    for (const OwnPlane& t : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::size_t v : {t.corner[k], t.corner[(k + 1) % 3]}) diagonal_[v] += t.weight[k];
  }

  /// Moves the points to where the turned triangles want them; the middle of all stays.
  void solve(std::vector<glm::dvec2>& flat) const {
    std::vector<glm::dvec2> wanted(flat.size(), glm::dvec2(0.0));
    for (const OwnPlane& t : triangles_) {
      const glm::dmat2 m = map_of(t, flat);
      const double angle = std::atan2(m[0][1] - m[1][0], m[0][0] + m[1][1]), c = std::cos(angle), s = std::sin(angle);
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 e = t.own[(k + 1) % 3] - t.own[k],
                         turned = t.weight[k] * glm::dvec2(c * e.x - s * e.y, s * e.x + c * e.y);
        wanted[t.corner[(k + 1) % 3]] += turned;
        wanted[t.corner[k]] -= turned;
      }
    }
    std::vector<glm::dvec2> rest = times(flat), step, p;
    for (std::size_t v = 0; v < flat.size(); ++v) rest[v] = wanted[v] - rest[v];
    step = scaled(rest);
    p = step;
    double rz = sum(rest, step);
    const double end = kGradientEnd * rz;
    for (int k = 0; k < kGradientSteps && rz > end && rz > 0.0; ++k) {
      const std::vector<glm::dvec2> ap = times(p);
      const double along = sum(p, ap);
      if (!(along > 0.0)) break;
      const double a = rz / along;
      for (std::size_t v = 0; v < flat.size(); ++v) {
        flat[v] += a * p[v];
        rest[v] -= a * ap[v];
      }
      step = scaled(rest);
      const double next = sum(rest, step), b = next / rz;
      for (std::size_t v = 0; v < flat.size(); ++v) p[v] = step[v] + b * p[v];
      rz = next;
    }
  }

 private:
  std::vector<glm::dvec2> times(const std::vector<glm::dvec2>& x) const {
    std::vector<glm::dvec2> out(x.size(), glm::dvec2(0.0));
    for (const OwnPlane& t : triangles_)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = t.corner[k], b = t.corner[(k + 1) % 3];
        const glm::dvec2 d = t.weight[k] * (x[b] - x[a]);
        out[b] += d;
        out[a] -= d;
      }
    return out;
  }
  std::vector<glm::dvec2> scaled(const std::vector<glm::dvec2>& x) const {
    std::vector<glm::dvec2> out(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) out[v] = x[v] / std::max(diagonal_[v], 1e-9);
    return out;
  }
  static double sum(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) {
    double out = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) out += glm::dot(a[v], b[v]);
    return out;
  }

  const std::vector<OwnPlane>& triangles_;
  std::vector<double> diagonal_;
};

}  // namespace

void lay_flat(FlatSheet& sheet) {
  const std::vector<OwnPlane> triangles = triangles_of(sheet);
  const GlobalStep step(triangles, sheet.flat_mm.size());
  for (int round = 0; round < kFlatRounds; ++round) step.solve(sheet.flat_mm);
  const int middle = sheet.rows / 2;
  const glm::dvec2 along =
      glm::normalize(sheet.flat_mm[sheet.index(sheet.columns - 1, middle)] - sheet.flat_mm[sheet.index(0, middle)]);
  glm::dvec2 low(std::numeric_limits<double>::max());
  for (glm::dvec2& p : sheet.flat_mm) {
    p = {along.x * p.x + along.y * p.y, along.x * p.y - along.y * p.x};
    low = glm::dvec2(std::min(low.x, p.x), std::min(low.y, p.y));
  }
  for (glm::dvec2& p : sheet.flat_mm) p -= low;
}

SheetDistortion distortion_of(const FlatSheet& sheet) {
  std::vector<double> lengths, angles;
  for (const OwnPlane& t : triangles_of(sheet)) {
    const auto [s1, s2] = singular_values(map_of(t, sheet.flat_mm));
    lengths.push_back(std::max(std::abs(s1 - 1.0), std::abs(1.0 - s2)));
    angles.push_back(std::asin(std::clamp((s1 - s2) / std::max(s1 + s2, 1e-12), 0.0, 1.0)) * 180.0 / std::numbers::pi);
  }
  SheetDistortion out;
  if (lengths.empty()) return out;
  std::sort(lengths.begin(), lengths.end());
  std::sort(angles.begin(), angles.end());
  const auto at = static_cast<std::size_t>(0.95 * static_cast<double>(lengths.size() - 1));
  out.length_95 = lengths[at];
  out.length_most = lengths.back();
  out.angle_95_deg = angles[at];
  return out;
}

}  // namespace dubsar
