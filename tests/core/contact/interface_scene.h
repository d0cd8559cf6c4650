#pragma once
// Sheets of vertices, and a scan with one film of air, whose truth is a formula.

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <utility>
#include <vector>

#include "core/contact/dips.h"
#include "core/contact/interface_mesh.h"

namespace dubsar {

/// Two triangles for each square of (edge - 1)^2 whose lower corner `has`; vertices that no square has stay unused.
inline InterfaceMesh sheet(
    int edge, const std::function<glm::vec3(int, int)>& place,
    const std::function<bool(int, int)>& has = [](int, int) { return true; }) {
  InterfaceMesh mesh;
  const auto id = [&](int x, int y) { return static_cast<std::uint32_t>(y * edge + x); };
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) mesh.added.push_back(place(x, y));
  for (int y = 0; y + 1 < edge; ++y)
    for (int x = 0; x + 1 < edge; ++x)
      if (has(x, y)) {
        mesh.triangles.push_back({id(x, y), id(x + 1, y), id(x + 1, y + 1)});
        mesh.triangles.push_back({id(x, y), id(x + 1, y + 1), id(x, y + 1)});
      }
  mesh.strength.assign(mesh.added.size(), 0.0f);
  return mesh;
}

/// A plane in the middle of a grid of 48^3, and clay of density 1 with a film of air along it: a Gaussian of 1 step.
struct FilmScene {
  static constexpr std::int64_t kEdge = 48;
  glm::vec3 normal = glm::normalize(glm::vec3(0.31f, -0.23f, 0.92f));
  glm::vec3 middle{23.4f, 24.1f, 23.7f};
  float depth = 0.5f;  ///< of the dip
  float noise = 0.0f;  ///< deviation, of each voxel

  float distance(const glm::vec3& p) const { return glm::dot(p - middle, normal); }
  /// The point of the plane at some steps from its middle, lifted out of it.
  glm::vec3 at(float u, float v, float lift) const {
    const glm::vec3 across = glm::normalize(glm::cross(normal, glm::vec3(1.0f, 0.0f, 0.0f)));
    return middle + u * glm::cross(across, normal) + v * across + lift * normal;
  }

  BandDensity density() const {
    const Dims dims{kEdge, kEdge, kEdge};
    BitVolume inside(dims);
    Volume<float> scan(dims);
    std::mt19937 bits(11);
    const auto uniform = [&] { return (static_cast<float>(bits()) + 0.5f) / 4294967296.0f; };
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
          const float d = distance(glm::vec3(x, y, z));
          inside.set(x, y, z, true);
          const float gauss = std::sqrt(-2.0f * std::log(uniform())) * std::cos(6.2831853f * uniform());
          scan.at(x, y, z) = 1.0f - depth * std::exp(-0.5f * d * d) + noise * gauss;
        }
    std::vector<PatchPoint> samples;
    samples.reserve(400);
    for (int v = -10; v < 10; ++v)
      for (int u = -10; u < 10; ++u)
        samples.push_back({at(static_cast<float>(u), static_cast<float>(v), 0.0f), normal});
    SilentProgress progress;
    const ContactBand band = ContactBand::make(inside, std::move(samples), 8.0f, progress).value();
    VolumeSource source(scan);
    return BandDensity::read(band, source, progress).value();
  }
};

}  // namespace dubsar
