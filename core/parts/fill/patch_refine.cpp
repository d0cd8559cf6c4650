#include "core/parts/fill/patch_refine.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

namespace dubsar {
namespace {
constexpr int kMostRounds = 24;                 // each round can double the density; the rim needs far fewer
constexpr std::size_t kMostVertices = 400'000;  // a bound for absurd loops
constexpr float kDensity = 1.41421356f;         // Liepa's alpha

glm::vec3 unit(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 1e-12f ? v / length : glm::vec3(0.0f);
}

float angle_between(const glm::vec3& a, const glm::vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}
}  // namespace

Patch::Patch(const Loop& loop, std::vector<Triangle> triangles, std::vector<glm::vec3> added)
    : loop_(loop),
      rim_(static_cast<std::uint32_t>(loop.positions.size())),
      positions_(loop.positions),
      triangles_(std::move(triangles)) {
  positions_.insert(positions_.end(), added.begin(), added.end());
  find_spacing();

  across_.assign(triangles_.size(), {kNone, kNone, kNone});
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::size_t>> open;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t s = 0; s < 3; ++s) {
      const std::uint64_t edge = key(triangles_[t][s], triangles_[t][(s + 1) % 3]);
      edges_.insert(edge);
      if (const auto other = open.find(edge); other != open.end()) {
        across_[t][s] = other->second.first;
        across_[other->second.first][other->second.second] = t;
      } else {
        open.emplace(edge, std::pair{t, s});
      }
    }
}

/// Half of both edges of the rim at each of its vertices; of vertices that were added, the mean of these.
void Patch::find_spacing() {
  spacing_.assign(positions_.size(), 0.0f);
  std::unordered_map<std::uint64_t, int> walked;  // bridges to and fro
  const auto edge = [&](std::size_t i) { return std::pair{loop_.vertex(i), loop_.vertex((i + 1) % loop_.steps())}; };
  for (std::size_t i = 0; i < loop_.steps(); ++i) ++walked[key(edge(i).first, edge(i).second)];
  for (std::size_t i = 0; i < loop_.steps(); ++i) {
    const auto [a, b] = edge(i);
    if (walked[key(a, b)] > 1) continue;
    const float half = 0.5f * glm::distance(positions_[a], positions_[b]);
    spacing_[a] += half;
    spacing_[b] += half;
  }
  float sum = 0.0f;
  for (std::uint32_t i = 0; i < rim_; ++i) sum += spacing_[i];
  for (std::size_t i = rim_; i < spacing_.size(); ++i) spacing_[i] = sum / static_cast<float>(rim_);
}

glm::vec3 Patch::area_vector(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return glm::cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
}

bool Patch::may_join(std::uint32_t a, std::uint32_t b) const {
  if (edges_.count(key(a, b)) != 0) return false;
  return a >= rim_ || b >= rim_ || loop_.may_join(a, b);
}

void Patch::replace_neighbour(std::uint32_t triangle, std::uint32_t old_one, std::uint32_t new_one) {
  if (triangle == kNone) return;
  for (std::uint32_t& n : across_[triangle])
    if (n == old_one) n = new_one;
}

bool Patch::split(std::uint32_t triangle, float growth) {
  const Triangle t = triangles_[triangle];
  const glm::vec3 centre = (positions_[t[0]] + positions_[t[1]] + positions_[t[2]]) / 3.0f;
  const float spacing = (spacing_[t[0]] + spacing_[t[1]] + spacing_[t[2]]) / 3.0f;
  for (const std::uint32_t v : t)
    if (kDensity * glm::distance(centre, positions_[v]) <= std::max(spacing, spacing_[v])) return false;
  const auto v = static_cast<std::uint32_t>(positions_.size());
  positions_.push_back(centre);
  spacing_.push_back(spacing * growth);
  const auto second = static_cast<std::uint32_t>(triangles_.size()), third = second + 1;
  const auto across = across_[triangle];
  triangles_[triangle] = {t[0], t[1], v};
  triangles_.push_back({t[1], t[2], v});
  triangles_.push_back({t[2], t[0], v});
  across_[triangle] = {across[0], second, third};
  across_.push_back({across[1], third, triangle});
  across_.push_back({across[2], triangle, second});
  replace_neighbour(across[1], triangle, second);
  replace_neighbour(across[2], triangle, third);
  for (const std::uint32_t w : t) edges_.insert(key(v, w));
  for (const std::uint32_t part : {triangle, second, third}) flip_if_better(part, 0);
  return true;
}

/// Replaces side a -> b of two triangles (a, b, c) and (b, a, d) by c -> d where the angles at c and d sum up
/// to more than a half turn and neither new triangle turns over.
bool Patch::flip_if_better(std::uint32_t triangle, std::size_t side) {
  const std::uint32_t other = across_[triangle][side];
  if (other == kNone) return false;
  const Triangle t = triangles_[triangle], u = triangles_[other];
  const std::uint32_t a = t[side], b = t[(side + 1) % 3], c = t[(side + 2) % 3];
  std::size_t back = 0;
  while (back < 3 && !(u[back] == b && u[(back + 1) % 3] == a)) ++back;
  if (back == 3) return false;
  const std::uint32_t d = u[(back + 2) % 3];
  const glm::vec3 &pa = positions_[a], &pb = positions_[b], &pc = positions_[c], &pd = positions_[d];
  constexpr float kHalfTurn = 3.14159265f,
                  kMargin = 1e-3f;  // the margin keeps rounding from flipping for ever
  if (angle_between(pa - pc, pb - pc) + angle_between(pa - pd, pb - pd) <= kHalfTurn + kMargin) return false;
  if (!may_join(c, d)) return false;
  const glm::vec3 mean = area_vector(a, b, c) + area_vector(b, a, d);
  if (glm::dot(area_vector(c, d, b), mean) <= 0.0f || glm::dot(area_vector(d, c, a), mean) <= 0.0f) return false;
  const std::uint32_t bc = across_[triangle][(side + 1) % 3], ca = across_[triangle][(side + 2) % 3];
  const std::uint32_t ad = across_[other][(back + 1) % 3], db = across_[other][(back + 2) % 3];
  triangles_[triangle] = {c, d, b};
  across_[triangle] = {other, db, bc};
  triangles_[other] = {d, c, a};
  across_[other] = {triangle, ca, ad};
  replace_neighbour(db, other, triangle);
  replace_neighbour(ca, triangle, other);
  edges_.erase(key(a, b));
  edges_.insert(key(c, d));
  return true;
}

Result<void> Patch::refine(float growth, Progress& progress) {
  for (int round = 0; round < kMostRounds; ++round) {
    if (progress.cancelled()) return cancelled_error();
    bool changed = false;
    const auto count = static_cast<std::uint32_t>(triangles_.size());
    for (std::uint32_t t = 0; t < count && positions_.size() < kMostVertices; ++t)
      changed = split(t, growth) || changed;
    for (int pass = 0; pass < kMostRounds; ++pass) {
      bool flipped = false;
      for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (std::size_t s = 0; s < 3; ++s) flipped = flip_if_better(t, s) || flipped;
      if (!flipped) break;
    }
    if (!changed) break;
  }
  return {};
}

/// Of each added vertex, its neighbours in no particular order.
std::vector<std::vector<std::uint32_t>> Patch::inner_neighbours() const {
  std::vector<std::vector<std::uint32_t>> neighbours(positions_.size() - rim_);
  for (const Triangle& t : triangles_)
    for (std::size_t i = 0; i < 3; ++i)  // the next corner of every triangle around a vertex gives each neighbour once
      if (t[i] >= rim_) neighbours[t[i] - rim_].push_back(t[(i + 1) % 3]);
  return neighbours;
}

Result<void> Patch::continue_surface(int steps, Progress& progress) {
  constexpr float kOverRelaxation = 1.6f, kRest = 1e-4f;
  const std::size_t inner = positions_.size() - rim_;
  if (inner == 0 || loop_.rim_normals.size() != loop_.steps()) return {};
  const auto neighbours = inner_neighbours();
  std::vector<glm::vec3> normals(positions_.size(), glm::vec3(0.0f));
  glm::vec3 mean_normal(0.0f);
  for (std::size_t i = 0; i < loop_.steps(); ++i) {
    normals[loop_.vertex(i)] += loop_.rim_normals[i];
    normals[loop_.vertex((i + 1) % loop_.steps())] += loop_.rim_normals[i];
  }
  for (std::uint32_t i = 0; i < rim_; ++i) {
    normals[i] = unit(normals[i]);
    mean_normal += normals[i];
  }
  for (std::size_t i = rim_; i < normals.size(); ++i) normals[i] = unit(mean_normal);
  for (int step = 0; step < steps; ++step) {
    if (progress.cancelled()) return cancelled_error();
    float largest = 0.0f;
    for (std::size_t i = 0; i < inner; ++i) {
      glm::vec3 mean(0.0f);
      for (const std::uint32_t v : neighbours[i]) mean += normals[v];
      const glm::vec3 before = normals[rim_ + i],
                      move = kOverRelaxation * (mean / static_cast<float>(neighbours[i].size()) - before);
      normals[rim_ + i] = unit(before + move);
      largest = std::max(largest, glm::distance(normals[rim_ + i], before));
    }
    if (largest < kRest) break;
  }
  std::vector<std::vector<glm::vec3>> between(inner);  // the normal half way to each neighbour: they stay as they are
  for (std::size_t i = 0; i < inner; ++i)
    for (const std::uint32_t v : neighbours[i]) between[i].push_back(unit(normals[rim_ + i] + normals[v]));
  for (int step = 0; step < steps; ++step) {
    if (progress.cancelled()) return cancelled_error();
    float largest = 0.0f;
    for (std::size_t i = 0; i < inner; ++i) {
      const glm::vec3 here = positions_[rim_ + i], normal = normals[rim_ + i];
      glm::vec3 mean(0.0f);
      float rise = 0.0f;
      for (std::size_t k = 0; k < neighbours[i].size(); ++k) {
        const glm::vec3 edge = positions_[neighbours[i][k]] - here;
        mean += edge;
        rise += glm::dot(edge, between[i][k]);
      }
      const auto count = static_cast<float>(neighbours[i].size());
      mean /= count;
      const glm::vec3 move = kOverRelaxation * rise / count * normal + 0.5f * (mean - normal * glm::dot(mean, normal));
      positions_[rim_ + i] += move;
      largest = std::max(largest, glm::length(move));
    }
    if (largest < kRest) break;
  }
  return {};
}

Result<void> Patch::relax(int steps, Progress& progress) {
  constexpr float kRest = 1e-4f, kOverRelaxation = 1.5f;
  const std::size_t inner = positions_.size() - rim_;
  if (inner == 0) return {};
  const auto neighbours = inner_neighbours();
  for (int step = 0; step < steps; ++step) {
    if (progress.cancelled()) return cancelled_error();
    float largest = 0.0f;
    for (std::size_t i = 0; i < inner; ++i) {
      glm::vec3 mean(0.0f);
      for (const std::uint32_t v : neighbours[i]) mean += positions_[v];
      mean /= static_cast<float>(neighbours[i].size());
      const glm::vec3 move = kOverRelaxation * (mean - positions_[rim_ + i]);
      positions_[rim_ + i] += move;
      largest = std::max(largest, glm::length(move));
    }
    if (largest < kRest) break;
  }
  return {};
}

void Patch::release(std::vector<Triangle>& triangles, std::vector<glm::vec3>& added) && {
  triangles = std::move(triangles_);
  added.assign(positions_.begin() + rim_, positions_.end());
}

}  // namespace dubsar
