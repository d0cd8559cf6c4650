#include "tests/core/script/mark_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

/// Even-odd rule.
bool inside(const std::vector<glm::dvec2>& loop, const glm::dvec2& p) {
  bool in = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++)
    if ((loop[i].y > p.y) != (loop[j].y > p.y) &&
        p.x < (loop[j].x - loop[i].x) * (p.y - loop[i].y) / (loop[j].y - loop[i].y) + loop[i].x)
      in = !in;
  return in;
}

double off_line(const std::vector<glm::dvec3>& line, const glm::dvec3& p, const glm::dvec3& front) {
  double best = 1e30;
  const auto flat = [&](const glm::dvec3& v) { return v - front * glm::dot(v, front); };
  for (std::size_t k = 1; k < line.size(); ++k) {
    const glm::dvec3 a = flat(line[k - 1]), along = flat(line[k]) - a, q = flat(p);
    const double t = std::clamp(glm::dot(q - a, along) / std::max(1e-12, glm::dot(along, along)), 0.0, 1.0);
    best = std::min(best, glm::distance(q, a + t * along));
  }
  return best;
}

std::vector<glm::dvec3> vertex_normals(const TriMesh& mesh, const std::vector<glm::dvec3>& points) {
  std::vector<glm::dvec3> out(points.size(), glm::dvec3(0.0));
  for (const Triangle& t : mesh.triangles) {
    const glm::dvec3 n = glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    for (const std::uint32_t v : t) out[v] += n;
  }
  for (glm::dvec3& n : out) n = glm::length(n) > 0.0 ? glm::normalize(n) : glm::dvec3(0.0);
  return out;
}

}  // namespace

MarkScore judge_marks(const phantom::Phantom& truth, const TriMesh& mesh, const TextSides& sides, phantom::Owner owner,
                      std::span<const ScriptCrack> cracks, std::span<const ScriptSealing> sealings) {
  constexpr double kNear = 0.75;       // mm
  constexpr double kFaces = 0.8;       // cosine
  constexpr float kCrackReach = 3.0f;  // voxels
  MarkScore score;
  const double voxel = truth.options().voxel_mm;
  std::vector<glm::dvec3> points;
  for (const glm::vec3& p : mesh.positions) points.push_back(mesh.frame.mm_from_grid(glm::dvec3(p)));
  const std::vector<glm::dvec3> normals = vertex_normals(mesh, points);
  const bool envelope = owner == phantom::Owner::kEnvelope;
  const std::vector<phantom::Sealing> bands = envelope ? truth.sealings() : std::vector<phantom::Sealing>{};
  const auto crack_at = [&](const glm::dvec3& mm) {
    const glm::vec3 p(mm / voxel);
    return envelope && truth.cracked() ? truth.fields(p.x, p.y, p.z).crack.v : 1e9f;
  };
  for (const ScriptCrack& crack : cracks) {
    int real = 0;
    for (const glm::dvec3& p : crack.line_mm) real += static_cast<double>(crack_at(p)) * voxel < kNear;
    score.line += static_cast<int>(crack.line_mm.size());
    score.line_real += real;
    ++score.cracks;
    score.cracks_false += 2 * real < static_cast<int>(crack.line_mm.size());
  }
  std::vector<std::vector<glm::dvec2>> loops;
  std::vector<std::array<int, 2>> of_loop(sealings.size());
  for (const ScriptSealing& sealing : sealings) {
    auto& loop = loops.emplace_back();
    const glm::dvec3 right = sides.right_of(sealing.side), up = sides.up_of(sealing.side);
    for (const glm::dvec3& p : sealing.outline_mm) loop.emplace_back(glm::dot(p, right), glm::dot(p, up));
  }
  for (std::size_t v = 0; v < points.size(); ++v) {
    const glm::dvec3 p = points[v] / voxel;
    if (envelope && truth.cracked() && std::abs(crack_at(points[v])) < 0.7f &&
        truth.nearest_part(p) == phantom::Part::kCrack &&
        std::abs(truth.fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)).outer.v) <
            kCrackReach) {
      ++score.wall;
      score.wall_found += std::any_of(cracks.begin(), cracks.end(), [&](const ScriptCrack& crack) {
        return off_line(crack.line_mm, points[v], sides.normal_of(crack.side)) < kNear;
      });
    }
    bool whole = false, band = false;
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const phantom::SideFrame& frame = phantom::kSideFrames[static_cast<std::size_t>(bands[k].side)];
      glm::dvec3 out(0.0);  // phantoms lie nearly straight in their grid
      out[frame.normal.axis] = static_cast<double>(frame.normal.sign);
      if (glm::dot(out, normals[v]) < 0.5) continue;
      const auto place = truth.seal_place(k, p);
      band = band || place;
      whole = whole || (place && place->shown);
    }
    const TextSide side = sides.side_of(normals[v]);
    const bool faces = glm::dot(normals[v], sides.normal_of(side)) > kFaces;
    if (!faces) continue;
    bool drawn = false;
    for (std::size_t s = 0; s < loops.size(); ++s) {
      const glm::dvec2 q(glm::dot(points[v], sides.right_of(side)), glm::dot(points[v], sides.up_of(side)));
      if (sealings[s].side != side || !inside(loops[s], q)) continue;
      drawn = true;
      ++of_loop[s][0];
      of_loop[s][1] += band;
    }
    score.sealed += whole;
    score.sealed_found += whole && drawn;
    score.outlined += drawn;
    score.outlined_real += drawn && band;
  }
  score.sealings = static_cast<int>(sealings.size());
  for (const auto& [all, real] : of_loop) score.sealings_false += 2 * real < all;
  return score;
}

void MarkScore::add(const MarkScore& o) {
  wall += o.wall, wall_found += o.wall_found, line += o.line, line_real += o.line_real;
  cracks += o.cracks, cracks_false += o.cracks_false;
  sealed += o.sealed, sealed_found += o.sealed_found, outlined += o.outlined, outlined_real += o.outlined_real;
  sealings += o.sealings, sealings_false += o.sealings_false;
}

std::string MarkScore::text() const {
  const auto share = [](int part, int all) { return all ? static_cast<double>(part) / all : 0.0; };
  return fmt::format(
      "cracks {} ({} false), {:.3f} of {} places of walls found, {:.3f} of {} points real; sealings {} ({} false), "
      "{:.3f} of what is whole found, {:.3f} of what is outlined real",
      cracks, cracks_false, share(wall_found, wall), wall, share(line_real, line), line, sealings, sealings_false,
      share(sealed_found, sealed), share(outlined_real, outlined));
}

}  // namespace dubsar
