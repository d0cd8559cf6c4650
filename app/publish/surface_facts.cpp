#include "app/publish/surface_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/system/parallel.h"
#include "core/mesh/mesh_check.h"

namespace dubsar::app {
namespace {

constexpr std::int64_t kFactGrain = 1 << 16;

struct Box {
  glm::dvec3 least{std::numeric_limits<double>::infinity()}, most{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& p) { least = glm::min(least, p), most = glm::max(most, p); }
  void add(const Box& b) { least = glm::min(least, b.least), most = glm::max(most, b.most); }
  glm::dvec3 size() const { return most.x >= least.x ? most - least : glm::dvec3(0.0); }
};

/// What the triangles of a body add up to.
struct BodySum {
  double area = 0.0, volume = 0.0, inferred_area = 0.0;
  std::array<EvidenceAreas, kEvidenceSides.size()> sides{};
  Box box;  ///< along the tablet's axes
  std::int64_t triangles = 0;

  void add(const BodySum& other) {
    area += other.area;
    volume += other.volume;
    inferred_area += other.inferred_area;
    for (std::size_t side = 0; side < sides.size(); ++side)
      for (std::size_t known = 0; known < kEvidenceCount; ++known) sides[side][known] += other.sides[side][known];
    box.add(other.box);
    triangles += other.triangles;
  }
};

/// By the id of the body, and the box of everything along the axes of the scan.
struct Sums {
  std::array<BodySum, PartitionTable::kMost> bodies;
  Box all;
};

/// How a triangle is known: as the least certain of its corners, but what is not inferred as a whole is at worst a
/// film.
Evidence evidence_of(const TriMesh& mesh, std::size_t t) {
  if (!mesh.triangle_inferred.empty() && mesh.triangle_inferred[t] != 0) return Evidence::kInferred;
  if (mesh.evidence.empty()) return Evidence::kMeasured;
  std::uint8_t worst = 0;
  for (const std::uint32_t v : mesh.triangles[t]) worst = std::max(worst, mesh.evidence[v]);
  return static_cast<Evidence>(std::min(worst, evidence_byte(Evidence::kFilm)));
}

/// Index into kEvidenceSides of a direction in the tablet's own axes.
std::size_t side_of(const glm::dvec3& n) {
  const glm::dvec3 a = glm::abs(n);
  if (a.z >= a.x && a.z >= a.y) return n.z >= 0.0 ? 0 : 1;
  if (a.y >= a.x) return n.y >= 0.0 ? 2 : 3;
  return n.x < 0.0 ? 4 : 5;
}

/// Of each triangle.
std::vector<PartitionId> bodies_of(const TriMesh& mesh) {
  std::array<PartitionId, 256> body_of{};
  for (std::size_t id = 0; id < body_of.size(); ++id)
    body_of[id] = mesh.partitions.body_of(static_cast<PartitionId>(id));
  std::vector<PartitionId> bodies(mesh.triangles.size());
  parallel_for(static_cast<std::int64_t>(bodies.size()), kFactGrain, [&](std::int64_t i) {
    const auto t = static_cast<std::size_t>(i);
    bodies[t] = body_of[mesh.partition_of(t)];
  });
  return bodies;
}

Sums sum_bodies(const TriMesh& mesh, const std::vector<PartitionId>& bodies, const glm::dmat3& turn) {
  return parallel_reduce<Sums>(
      static_cast<std::int64_t>(mesh.triangles.size()), kFactGrain, {},
      [&](std::int64_t begin, std::int64_t end) {
        Sums part;
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
          BodySum& body = part.bodies[bodies[t]];
          std::array<glm::dvec3, 3> p;
          for (std::size_t corner = 0; corner < 3; ++corner) {
            p[corner] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[mesh.triangles[t][corner]]));
            body.box.add(turn * p[corner]);
            part.all.add(p[corner]);
          }
          const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
          const double area = 0.5 * glm::length(normal);
          body.area += area;
          body.volume += glm::dot(p[0], normal) / 6.0;
          const auto known = static_cast<std::size_t>(evidence_of(mesh, t));
          if (known == static_cast<std::size_t>(Evidence::kInferred)) body.inferred_area += area;
          body.sides[side_of(turn * normal)][known] += area;
          ++body.triangles;
        }
        return part;
      },
      [](Sums all, const Sums& part) {
        for (std::size_t id = 0; id < all.bodies.size(); ++id) all.bodies[id].add(part.bodies[id]);
        all.all.add(part.all);
        return all;
      });
}

/// By the id of the body. Bodies of our own surfaces share no vertices, so that one check is enough for all; those of
/// others may.
std::vector<bool> watertight_bodies(const TriMesh& mesh, const std::vector<PartitionId>& bodies, bool closed) {
  constexpr PartitionId kNobody = PartitionTable::kNone;
  std::vector<PartitionId> owner(mesh.positions.size(), kNobody);
  std::atomic<bool> apart = true;
  parallel_for(static_cast<std::int64_t>(bodies.size()), kFactGrain, [&](std::int64_t i) {
    const auto t = static_cast<std::size_t>(i);
    for (const std::uint32_t v : mesh.triangles[t]) {
      PartitionId before = kNobody;  // whoever comes first: another body than its own sees it
      if (!std::atomic_ref(owner[v]).compare_exchange_strong(before, bodies[t], std::memory_order_relaxed) &&
          before != bodies[t])
        apart.store(false, std::memory_order_relaxed);
    }
  });
  if (apart && closed) return std::vector<bool>(std::size_t{PartitionTable::kHighest} + 1, true);
  if (apart) return watertight_parts(mesh.positions.size(), mesh.triangles, bodies);
  std::vector<bool> watertight(PartitionTable::kMost, false);
  for (std::size_t id = 0; id < watertight.size(); ++id) {
    std::vector<Triangle> own;
    for (std::size_t t = 0; t < bodies.size(); ++t)
      if (bodies[t] == id) own.push_back(mesh.triangles[t]);
    if (!own.empty()) watertight[id] = check_mesh(mesh.positions, own).watertight();
  }
  return watertight;
}

bool crumbs(const PartFacts& part) { return part.kind == PartitionKind::kPores; }

std::string area_text(double area, bool mm) {
  return fmt::format("{:.{}f} {}", area, area < 100 ? 1 : 0, mm ? "mm2" : "voxel faces");
}

std::string volume_text(double volume, bool mm) {
  if (!mm) return fmt::format("{:.0f} voxels", volume);
  return volume < 1000.0 ? fmt::format("{:.0f} mm3", volume) : fmt::format("{:.1f} cm3", volume / 1000.0);
}

}  // namespace

Result<SurfaceFacts> surface_facts(const TriMesh& mesh, bool closed) {
  SurfaceFacts facts;
  facts.millimetres = mesh.frame.input_voxel.known();
  DUBSAR_ASSIGN(facts.way, find_tablet_frame(mesh));
  const std::vector<PartitionId> bodies = bodies_of(mesh);
  const Sums sums = sum_bodies(mesh, bodies, facts.way.tablet_from_model());
  const std::vector<bool> watertight = watertight_bodies(mesh, bodies, closed);
  facts.box = sums.all.size();
  for (std::size_t id = 0; id < sums.bodies.size(); ++id) {
    const BodySum& body = sums.bodies[id];
    if (body.triangles == 0) continue;
    const Partition* const row = mesh.partitions.find(static_cast<PartitionId>(id));
    PartFacts part;
    part.name = row != nullptr ? row->body_name() : "object";
    part.kind = row != nullptr ? row->kind : PartitionKind::kObject;
    part.size = body.box.size();
    part.area = body.area;
    part.volume = body.volume;
    part.inferred_area = body.inferred_area;
    part.sides = body.sides;
    part.watertight = watertight[id];
    facts.parts.push_back(std::move(part));
  }
  std::stable_sort(facts.parts.begin(), facts.parts.end(),
                   [](const PartFacts& a, const PartFacts& b) { return crumbs(a) != crumbs(b) ? crumbs(b) : false; });
  return facts;
}

double PartFacts::evidence_area(Evidence evidence) const {
  double sum = 0.0;
  for (const EvidenceAreas& side : sides) sum += side[static_cast<std::size_t>(evidence)];
  return sum;
}

nlohmann::json facts_json(const SurfaceFacts& facts) {
  using nlohmann::json;
  const auto vector = [](const glm::dvec3& v) { return json{v.x, v.y, v.z}; };
  json parts = json::array();
  double area = 0.0;
  EvidenceAreas all{};
  for (const PartFacts& part : facts.parts) {
    area += part.area;
    json known, sides;
    for (const auto& [evidence, name, short_name] : kEvidences) {
      known[std::string(name)] = part.evidence_area(evidence);
      all[static_cast<std::size_t>(evidence)] += part.evidence_area(evidence);
      for (std::size_t side = 0; side < kEvidenceSides.size(); ++side)
        sides[kEvidenceSides[side]][std::string(name)] = part.sides[side][static_cast<std::size_t>(evidence)];
    }
    parts.push_back({{"name", part.name},
                     {"size", vector(part.size)},
                     {"area", part.area},
                     {"volume", part.volume},
                     {"watertight", part.watertight},
                     {"inferred_area", part.inferred_area},
                     {"inferred_share", part.inferred_share()},
                     {"evidence", std::move(known)},
                     {"sides", std::move(sides)}});
  }
  const auto [measured, pocket, film, inferred] = all;
  return {{"unit", facts.millimetres ? "mm" : "voxel"},
          {"upright", facts.upright()},
          {"up_probability", facts.way.up_probability},
          {"obverse_probability", facts.way.obverse_probability},
          {"mirrored_probability", facts.way.mirrored_probability},
          {"box", vector(facts.box)},
          {"parts", std::move(parts)},
          {"evidence",
           {{"area", area},
            {"measured_area", measured},
            {"pocket_area", pocket},
            {"film_area", film},
            {"inferred_area", inferred},
            {"inferred_share", area > 0.0 ? inferred / area : 0.0}}}};
}

std::string size_text(const glm::dvec3& size, bool mm) {
  const int digits = mm ? (std::max({size.x, size.y, size.z}) < 10.0 ? 2 : 1) : 0;
  return fmt::format("{:.{}f} x {:.{}f} x {:.{}f} {}", size.x, digits, size.y, digits, size.z, digits,
                     mm ? "mm" : "voxels");
}

std::string facts_text(const SurfaceFacts& facts) {
  const bool mm = facts.millimetres;
  std::string text;
  std::size_t longest = 8;
  for (const PartFacts& part : facts.parts)
    if (!crumbs(part)) longest = std::max(longest, part.name.size());
  for (const PartFacts& part : facts.parts)
    if (!crumbs(part))
      text += fmt::format("  {:<{}}  {}, {}{}\n", part.name, longest, size_text(part.size, mm),
                          volume_text(part.volume, mm), part.watertight ? "" : ", open");
  if (facts.upright()) text += fmt::format("  {:<{}}  (width x height x thickness)\n", "", longest);
  if (!facts.way.sure()) text += "  " + facts.way.doubt() + "\n";
  for (const PartFacts& part : facts.parts)
    if (crumbs(part)) text += fmt::format("  and {}: {}\n", part.name, area_text(part.area, mm));
  std::string inferred;
  for (const PartFacts& part : facts.parts)
    if (part.inferred_area > 0.0)
      inferred += fmt::format("  {:<{}}  {}, {:.1f} % of its surface\n", part.name, longest,
                              area_text(part.inferred_area, mm), 100.0 * part.inferred_share());
  if (!inferred.empty()) text += "\nNot in the scan, closed smoothly, hatched in pictures:\n" + inferred;
  for (const PartFacts& part : facts.parts) {
    if (part.kind != PartitionKind::kTablet || part.area - part.evidence_area(Evidence::kMeasured) <= 0.0) continue;
    text += fmt::format("\nHow the {} is known, {}:\n  {:<12}{:>11}{:>11}{:>11}{:>11}\n", part.name,
                        mm ? "mm2" : "voxel faces", "", "measured", "pocket", "film", "inferred");
    for (std::size_t side = 0; side < kEvidenceSides.size(); ++side) {
      const auto& [measured, pocket, film, none] = part.sides[side];
      text += fmt::format("  {:<12}{:>11.1f}{:>11.1f}{:>11.1f}{:>11.1f}\n", kEvidenceSides[side], measured, pocket,
                          film, none);
    }
  }
  return text;
}

std::string what_it_is(const SurfaceFacts& facts) {
  bool tablet = false, envelope = false;
  std::size_t count = 0;
  for (const PartFacts& part : facts.parts) {
    tablet = tablet || part.name == "tablet";
    envelope = envelope || part.name == "envelope";
    count += crumbs(part) ? 0 : 1;
  }
  if (tablet && envelope) return "a tablet inside its envelope";
  if (tablet) return "a tablet";
  return count == 1 ? "one object" : fmt::format("{} objects", count);
}

}  // namespace dubsar::app
