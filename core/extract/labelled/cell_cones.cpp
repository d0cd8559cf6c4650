#include "core/extract/labelled/cell_cones.h"

#include <algorithm>
#include <glm/common.hpp>

#include "core/extract/labelled/safe_drawing.h"

namespace dubsar {
namespace {

constexpr int kMostDrawn = 400;

class Cones {
 public:
  Cones(ConePlaces& drawing, std::span<const std::uint32_t> vertices) : drawing_(drawing), vertices_(vertices) {
    std::vector<ConePart> parts;
    for (const std::uint32_t v : vertices) {
      drawing.cone_of(v, parts);
      first_.push_back(triangles_.size());
      Crossings crossings;
      for (const ConePart& part : parts) {
        crossings.all.push_back(part.edge_point);
        if (part.next_is_chord || part.previous_is_chord) crossings.of_chords.push_back(part.edge_point);
        triangles_.push_back({v, part.next, part.edge_point});
        triangles_.push_back({part.previous, v, part.edge_point});
      }
      crossings_.push_back(std::move(crossings));
    }
    first_.push_back(triangles_.size());
  }

  /// Triangles along a chord belong to both of its vertices.
  bool touch() const {
    for (std::size_t p = 0; p + 1 < vertices_.size(); ++p)
      for (std::size_t i = first_[p]; i < first_[p + 1]; ++i)
        for (std::size_t j = first_[p + 1]; j < triangles_.size(); ++j)
          if (!same(triangles_[i], triangles_[j]) && triangles_touch(drawing_.places(), triangles_[i], triangles_[j]))
            return true;
    for (const Triangle& t : triangles_)
      if (has_zero_area(place(t[0]), place(t[1]), place(t[2]))) return true;
    return false;
  }

  /// `share` of the way from the chords to the mean of all crossings, in sixteenths.
  void put_at_means(std::int64_t share) {
    for (std::size_t p = 0; p < vertices_.size(); ++p) {
      const Crossings& c = crossings_[p];
      const ExactPlace all = weighted(c.all, {});
      put(p, c.of_chords.empty()
                 ? all
                 : weighted(c.of_chords, {}) + (all - weighted(c.of_chords, {})) * share / std::int64_t{16});
    }
  }
  void put_drawn(std::uint32_t& random) {
    for (std::size_t p = 0; p < vertices_.size(); ++p) {
      std::vector<std::int64_t> weights;
      for (std::size_t i = 0; i < crossings_[p].all.size(); ++i) {
        random = random * 1664525u + 1013904223u;
        const std::int64_t r = random >> 24;
        weights.push_back(1 + r * r / 64);
      }
      put(p, weighted(crossings_[p].all, weights));
    }
  }

 private:
  struct Crossings {
    std::vector<std::uint32_t> all, of_chords;
  };
  const ExactPlace& place(std::uint32_t id) const { return drawing_.places()[id]; }
  static bool same(Triangle a, Triangle b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  }
  ExactPlace weighted(const std::vector<std::uint32_t>& ids, const std::vector<std::int64_t>& weights) const {
    const ExactPlace start = drawing_.cell_start(vertices_[0]);
    ExactPlace sum(0);
    std::int64_t all = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::int64_t weight = weights.empty() ? 1 : weights[i];
      sum += (place(ids[i]) - start) * weight;
      all += weight;
    }
    return start + sum / all;
  }
  void put(std::size_t p, const ExactPlace& at) {
    const ExactPlace low = drawing_.cell_start(vertices_[p]) + std::int64_t{1};
    drawing_.places()[vertices_[p]] = glm::clamp(at, low, low + kExactSteps - std::int64_t{2});
  }

  ConePlaces& drawing_;
  std::span<const std::uint32_t> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::size_t> first_;  ///< of each vertex, and behind the last
  std::vector<Crossings> crossings_;
};

bool find_places(Cones& cones) {
  for (const std::int64_t share : {16, 10, 6, 3, 1}) {
    cones.put_at_means(share);
    if (!cones.touch()) return true;
  }
  std::uint32_t random = 1;
  for (int i = 0; i < kMostDrawn; ++i) {
    cones.put_drawn(random);
    if (!cones.touch()) return true;
  }
  return false;
}

}  // namespace

ConeResult place_cones(ConePlaces& drawing, std::span<const std::uint32_t> vertices) {
  Cones cones(drawing, vertices);
  if (!cones.touch()) return ConeResult::kAsWanted;
  if (find_places(cones)) return ConeResult::kMoved;
  drawing.put_crossings_in_the_middle(vertices);
  return find_places(cones) ? ConeResult::kLastResort : ConeResult::kNone;
}

}  // namespace dubsar
