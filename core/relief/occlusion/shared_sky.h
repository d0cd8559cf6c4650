#pragma once
// The directions in which light is looked for, and how neighbours on a surface share them: each follows some of the
// rays, spread as evenly over the sky as all, and takes what the others found into account.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Directions of the rays about +z and their weights. Fibonacci spiral: z_i = 1 - (i + .5) / n, azimuth i times the
/// golden angle; weight w1 = sin(phi) sqrt(cos(phi)) with cos(phi) = z.
struct SkyRays {
  std::vector<glm::vec3> directions;
  std::vector<float> weights;
  double weight_sum = 0.0;
};

/// Part `part` of `parts` that share about `count` rays: a spiral of count / parts, rounded up, whose turns lie between
/// those of the others. One part: the whole spiral.
SkyRays sky_rays_of_part(int count, int parts, int part);

/// Which part of the sky is looked at from a place: another one in each neighbouring voxel, for 19 parts, in each of
/// those in two rings around it.
int sky_part_at(const glm::vec3& position, int parts);

/// Each vertex's light becomes an average of its own and that of its neighbours in two rings that look the same way and
/// are about as bright. Where all are equally bright nothing changes. 12 bytes a vertex; each thread reads all
/// triangles.
void share_light(std::span<const glm::vec3> normals, std::span<const Triangle> triangles, std::vector<float>& light);

}  // namespace dubsar
