#include "core/parts/patch_moves.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/numbers/sort_unique.h"
#include "core/base/system/parallel.h"
#include "core/mesh/intersections.h"

namespace dubsar {
namespace {

constexpr int kMoveRounds = 6;  ///< of moves between two attempts to add vertices
constexpr int kMostCounted = 1000;
constexpr float kLookRound = 1.0f;  ///< a star, for what its vertex may come to cross; moves are shorter
constexpr float kHomeCube = 8.0f;   ///< steps
constexpr float kRoom = 4.0f;       ///< around the star of a vertex that is its group's alone
constexpr float kSafe = 2.0f;  ///< of which this is left when it is moved: what it reads and where it may come to lie

TriangleBox together(const TriangleBox& a, const TriangleBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

}  // namespace

bool TangleOwner::matters_to(const TangleOwner& other) const {
  if (patch == kNoPatch && other.patch == kNoPatch) return false;
  const auto is_of = [&](PartitionId body) {
    return body != PartitionTable::kNone && (body == other.front || body == other.back);
  };
  return is_of(front) || is_of(back);
}

glm::vec3 in_steps(const glm::vec3& place, double step) {
  const auto one = [&](float x) { return static_cast<float>(std::round(static_cast<double>(x) / step) * step); };
  return {one(place.x), one(place.y), one(place.z)};
}

PatchMoves::PatchMoves(TangleMesh& mesh, double step, std::span<const std::uint32_t> beside)
    : mesh_(mesh),
      step_(step),
      first_(mesh.positions.size() - mesh.first_extra + 2, 0),
      stuck_(mesh.positions.size() - mesh.first_extra, 0) {
  for (const std::uint32_t t : beside) grid_.add(t, box_of(mesh.positions, mesh.triangles[t]));
  const auto each_corner = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        if (v >= mesh.first_extra) visit(v - mesh.first_extra, t);
  };
  each_corner([&](std::uint32_t v, std::uint32_t) { ++first_[v + 2]; });  // one further: where the next one goes
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  star_.resize(first_.back());
  each_corner([&](std::uint32_t v, std::uint32_t t) { star_[first_[v + 1]++] = t; });
  first_.pop_back();
}

void PatchMoves::run(const CrossingPairs& pairs, std::span<std::uint8_t> moved, std::span<std::uint8_t> changed) {
  DUBSAR_CHECK(moved.size() + 1 == first_.size() && changed.size() == mesh_.triangles.size());
  std::vector<std::uint32_t> work;
  for (const auto& pair : pairs)
    for (const std::uint32_t t : pair) mesh_.add_extras(t, work);
  for (int round = 0; round < kMoveRounds && !work.empty(); ++round) {
    sort_unique(work);
    Homes homes;
    const std::vector<Group> groups = far_apart(work, homes);
    std::vector<Outcome> outcomes(groups.size());
    parallel_for(static_cast<std::int64_t>(groups.size()), 1, [&](std::int64_t i) {
      const auto g = static_cast<std::size_t>(i);
      outcomes[g] = move_group(groups[g], static_cast<std::uint32_t>(g), homes);
    });
    std::vector<std::uint32_t> next;
    bool better = false;
    for (const Outcome& outcome : outcomes) {
      next.insert(next.end(), outcome.next.begin(), outcome.next.end());
      better = better || !outcome.moved.empty();
      for (const std::uint32_t v : outcome.moved) {
        moved[v - mesh_.first_extra] = 1;
        for (const std::uint32_t t : star_of(v)) {
          const TriangleBox box = box_of(mesh_.positions, mesh_.triangles[t]);
          grid_.add(t, box);
          changed[t] = 1;
          const auto [before, is_new] = reach_.try_emplace(t, box);
          if (!is_new) before->second = together(before->second, box);
        }
      }
    }
    note_stuck(outcomes);
    if (!better)  // wider: neighbours make room
      for (const std::uint32_t v : work)
        for (const std::uint32_t t : star_of(v)) mesh_.add_extras(t, next);
    work.swap(next);
  }
}

/// Who found nothing better need not seek again until something near has moved.
void PatchMoves::note_stuck(const std::vector<Outcome>& outcomes) {
  std::vector<TriangleBox> moved;
  for (const Outcome& outcome : outcomes) {
    for (const std::uint32_t v : outcome.stuck) stuck_[v - mesh_.first_extra] = 1;
    for (const TriangleBox& box : outcome.boxes) moved.push_back(box.grown(kLookRound));
  }
  if (moved.empty()) return;
  const BrickSet near(moved);
  for (std::uint32_t i = 0; i < stuck_.size(); ++i)
    if (stuck_[i] != 0 && near.meets(star_box(mesh_.first_extra + i))) stuck_[i] = 0;
}

TriangleBox PatchMoves::star_box(std::uint32_t v) const {
  TriangleBox box{mesh_.positions[v], mesh_.positions[v]};
  for (const std::uint32_t t : star_of(v)) box = together(box, box_of(mesh_.positions, mesh_.triangles[t]));
  return box;
}

/// Vertices around which the same cubes lie are of one group, and whatever triangle lies or lay in its cubes and is
/// moved, is moved by the group.
std::vector<PatchMoves::Group> PatchMoves::far_apart(const std::vector<std::uint32_t>& work, Homes& homes) const {
  DisjointSets sets(work.size());
  for (std::uint32_t i = 0; i < work.size(); ++i) {
    TriangleBox box = star_box(work[i]);
    for (const std::uint32_t t : star_of(work[i]))
      if (const auto been = reach_.find(t); been != reach_.end()) box = together(box, been->second);
    for_each_cube(box.grown(kRoom), kHomeCube, [&](std::int64_t key) {
      if (const auto [place, is_new] = homes.try_emplace(key, i); !is_new) sets.join(place->second, i);
    });
  }
  std::vector<Group> groups;
  std::vector<std::uint32_t> number(work.size());
  for (std::uint32_t i = 0; i < work.size(); ++i) {
    const std::uint32_t root = sets.root(i);  // the first of its group
    if (root == i) {
      number[i] = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
    }
    number[i] = number[root];
    groups[number[i]].push_back(work[i]);
  }
  for (auto& [key, owner] : homes) owner = number[owner];
  return groups;
}

PatchMoves::Outcome PatchMoves::move_group(const Group& group, std::uint32_t number, const Homes& homes) {
  Outcome outcome;
  Around around;
  for (const std::uint32_t v : group) {
    bool home = true;  // else it has come too far from where the group began: next round
    for_each_cube(star_box(v).grown(kSafe), kHomeCube, [&](std::int64_t key) {
      const auto owner = homes.find(key);
      home = home && owner != homes.end() && owner->second == number;
    });
    if (!home) {
      outcome.next.push_back(v);
      continue;
    }
    look_around(v, around);
    const TriangleBox before = star_box(v), near = before.grown(kLookRound);
    const bool stuck =
        stuck_[v - mesh_.first_extra] != 0 && std::none_of(outcome.boxes.begin(), outcome.boxes.end(),
                                                           [&](const TriangleBox& moved) { return moved.meets(near); });
    const bool better = !stuck && relieve(v, around);
    if (better) {
      outcome.moved.push_back(v);
      outcome.boxes.push_back(together(before, star_box(v)));
    }
    around.met.clear();
    if (crossings_at(v, mesh_.positions[v], kMostCounted, around) == 0) continue;
    for (const auto& pair : around.met) mesh_.add_extras(pair[1], outcome.next);
    outcome.next.push_back(v);
    if (!better) outcome.stuck.push_back(v);
  }
  return outcome;
}

/// Triangles beside the star of a vertex that matter to it, wherever it may be moved, and those of the star among them.
void PatchMoves::look_around(std::uint32_t v, Around& around) const {
  const std::span<const std::uint32_t> star = star_of(v);
  const TriangleBox box = star_box(v).grown(kLookRound);
  grid_.near(box, around.near);
  std::vector<std::uint32_t> added;
  around.added.near(box, added);
  if (!added.empty()) {
    around.near.insert(around.near.end(), added.begin(), added.end());
    sort_unique(around.near);
  }
  around.star.clear();
  around.boxes.clear();
  std::erase_if(around.near, [&](std::uint32_t t) {
    const bool of_star = std::find(star.begin(), star.end(), t) != star.end();
    if (of_star) around.star.push_back(t);
    return of_star || !mesh_.owner[star.front()].matters_to(mesh_.owner[t]);  // the star is of one patch
  });
  for (const std::uint32_t t : around.near) around.boxes.push_back(box_of(mesh_.positions, mesh_.triangles[t]));
}

/// How many of them the star of a vertex at `place` crosses, counted up to `most`, and remembered.
int PatchMoves::crossings_at(std::uint32_t v, const glm::vec3& place, int most, Around& around) {
  const glm::vec3 before = mesh_.positions[v];
  mesh_.positions[v] = place;
  int count = 0;
  const auto look_at = [&](std::uint32_t t, std::uint32_t other) {
    if (count >= most || !triangles_cross(mesh_.positions, mesh_.triangles[t], mesh_.triangles[other])) return;
    ++count;
    around.met.push_back({t, other});
  };
  for (const std::uint32_t t : star_of(v)) {
    const TriangleBox box = box_of(mesh_.positions, mesh_.triangles[t]);
    for (std::size_t i = 0; i < around.near.size() && count < most; ++i)
      if (box.meets(around.boxes[i])) look_at(t, around.near[i]);
    for (const std::uint32_t other : around.star)
      if (other > t && mesh_.owner[t].matters_to(mesh_.owner[other])) look_at(t, other);
  }
  mesh_.positions[v] = before;
  return count;
}

/// The same of those alone that it met elsewhere: most places are no better, and this tells it soon.
int PatchMoves::crossings_met(std::uint32_t v, const glm::vec3& place, int most, const Around& around) {
  const glm::vec3 before = mesh_.positions[v];
  mesh_.positions[v] = place;
  int count = 0;
  for (std::size_t i = 0; i < around.met.size() && count < most; ++i) {
    const auto [t, other] = around.met[i];
    count += triangles_cross(mesh_.positions, mesh_.triangles[t], mesh_.triangles[other]);
  }
  mesh_.positions[v] = before;
  return count;
}

/// The nearest of some places where the vertex crosses least. True: less than before.
bool PatchMoves::relieve(std::uint32_t v, Around& around) {
  around.met.clear();
  int least = crossings_at(v, mesh_.positions[v], kMostCounted, around);
  if (least == 0) return false;
  const glm::vec3 start = mesh_.positions[v];
  glm::vec3 mean(0.0f), best = start;
  float count_around = 0.0f;
  for (const std::uint32_t t : star_of(v))
    for (const std::uint32_t w : mesh_.triangles[t])
      if (w != v) {
        mean += mesh_.positions[w];
        count_around += 1.0f;
      }
  mean /= count_around;
  const auto attempt = [&](const glm::vec3& place) {
    if (crossings_met(v, in_steps(place, step_), least, around) >= least) return;
    const int count = crossings_at(v, in_steps(place, step_), least, around);
    sort_unique(around.met);
    if (count >= least) return;
    least = count;
    best = in_steps(place, step_);
  };
  for (const float share : {0.25f, 0.5f, 0.75f, 1.0f})
    if (least > 0) attempt(start + share * (mean - start));
  for (const float reach : {0.06f, 0.12f, 0.25f, 0.5f, 0.9f})
    for (const glm::vec3& middle : {start, mean})
      for (int k = 0; k < 27 && least > 0; ++k)
        if (k != 13) attempt(middle + reach * glm::normalize(glm::vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
  if (best == start) return false;
  mesh_.positions[v] = best;
  for (const std::uint32_t t : star_of(v)) around.added.add(t, box_of(mesh_.positions, mesh_.triangles[t]));
  return true;
}

}  // namespace dubsar
