#include "core/extract/labelled/safe_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <unordered_map>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/extract/labelled/cell_cones.h"
#include "core/extract/labelled/near_pairs.h"
#include "core/extract/quad_envelope.h"

namespace dubsar {
namespace {

constexpr int kMostDrawings = 12;  ///< one is enough in all runs that were made
constexpr std::int64_t kDrawGrain = 1 << 13;

enum class Cut : std::uint8_t { kFirstDiagonal, kSecondDiagonal, kFan };

std::uint64_t side_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

class Drawer final : public ConePlaces {
 public:
  Drawer(const LabelledMesh& labelled, std::span<const glm::vec3> wanted, std::span<const glm::vec3> crossings)
      : labelled_(labelled), mesh_(labelled.mesh), cut_(mesh_.quads.size()), crossing_(exact_places(crossings)) {
    drawing_.places = exact_places(wanted);
    parallel_for(mesh_.vertex_count(), kDrawGrain, [&](std::int64_t i) {
      const auto v = static_cast<std::size_t>(i);
      const ExactPlace low = cell_start(static_cast<std::uint32_t>(v)) + kWallSteps;
      drawing_.places[v] = glm::clamp(drawing_.places[v], low, low + kExactSteps - 2 * kWallSteps);
    });
    parallel_for(mesh_.quad_count(), kDrawGrain, [&](std::int64_t q) {
      const GridEdge& e = labelled_.edges[static_cast<std::size_t>(q)];
      std::int64_t& along = crossing_[static_cast<std::size_t>(q)][e.axis];
      const std::int64_t start = edge_start(static_cast<std::uint32_t>(q))[e.axis];
      along = std::clamp(along, start + 1, start + kExactSteps - 1);
    });
  }

  SafeDrawing run(const Triangulation& preferred) {
    parallel_for(mesh_.quad_count(), kDrawGrain, [&](std::int64_t i) {
      const auto q = static_cast<std::uint32_t>(i);
      cut_[q] = choose_cut(q, preferred);
    });
    for (std::uint32_t q = 0; q < cut_.size(); ++q) {
      drawing_.fans_of_four += cut_[q] == Cut::kFan && !mesh_.has_doubled(q);
      if (cut_[q] == Cut::kFan) make_fan(q);
    }
    draw();
    std::vector<std::uint8_t> wanted = triangles_of([&](std::uint32_t v) { return shares_cell(v); });
    for (int round = 0; round < kMostDrawings; ++round) {
      const TrianglePairs pairs = touching_pairs_near(drawing_.places, drawing_.triangles, wanted);
      drawing_.crossing_pairs = static_cast<std::int64_t>(pairs.size());
      if (pairs.empty()) break;
      std::vector<std::uint32_t> cells;  // first vertices
      for (const auto& pair : pairs)
        for (const std::uint32_t t : pair)
          each_vertex_of(quad_of(t), [&](std::uint32_t v) {
            if (shares_cell(v)) cells.push_back(first_of_cell(v));
          });
      std::sort(cells.begin(), cells.end());
      cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
      std::erase_if(cells, [&](std::uint32_t first) { return secured_[first]; });
      if (cells.empty()) break;
      for (const std::uint32_t first : cells) secure(first);
      std::vector<std::uint8_t> moved(mesh_.positions.size());
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const ConeResult result = place_cones(*this, first_to_vertices(cells[i]));
        drawing_.hard_cells += result != ConeResult::kAsWanted;
        drawing_.last_resorts += result == ConeResult::kLastResort;
        for (const std::uint32_t v : first_to_vertices(cells[i])) moved[v] = 1;
        // Its neighbours' crossings have moved: those that are secured are looked at once more.
        if (result == ConeResult::kLastResort)
          for (const std::uint32_t other : secured_beside(cells[i]))
            if (std::find(cells.begin() + static_cast<std::ptrdiff_t>(i), cells.end(), other) == cells.end())
              cells.push_back(other);
        if (cells.size() > secured_count_ * 4) break;
      }
      draw();
      wanted = triangles_of([&](std::uint32_t v) { return moved[v] != 0; });
    }
    return std::move(drawing_);
  }

  // --- what place_cones() asks for

  ExactPlace cell_start(std::uint32_t v) const override { return ExactPlace(labelled_.vertex_cells[v]) * kExactSteps; }
  std::vector<ExactPlace>& places() override { return drawing_.places; }
  void cone_of(std::uint32_t v, std::vector<ConePart>& parts) const override {
    parts.clear();
    for (const std::uint32_t q : mesh_.quads_of(v)) {
      const Polygon polygon = mesh_.polygon(q);
      const auto n = static_cast<std::size_t>(polygon.size);
      const std::size_t i = static_cast<std::size_t>(
          std::find(polygon.vertex.begin(), polygon.vertex.begin() + polygon.size, v) - polygon.vertex.begin());
      ConePart part;
      part.edge_point = edge_point_.at(q);
      const auto side = [&](std::size_t k) {
        const std::uint32_t w = polygon.vertex[k % n];
        if (polygon.corner[k % n] == polygon.corner[i]) return w;
        return face_point_.at(side_key(v, w));
      };
      part.next = side(i + 1);
      part.previous = side(i + n - 1);
      part.next_is_chord = polygon.corner[(i + 1) % n] == polygon.corner[i];
      part.previous_is_chord = polygon.corner[(i + n - 1) % n] == polygon.corner[i];
      parts.push_back(part);
    }
  }
  void put_crossings_in_the_middle(std::span<const std::uint32_t> vertices) override {
    for (const std::uint32_t v : vertices)
      for (const std::uint32_t q : mesh_.quads_of(v)) {
        crossing_[q][labelled_.edges[q].axis] = edge_start(q)[labelled_.edges[q].axis] + kExactSteps / 2;
        drawing_.places[edge_point_.at(q)] = crossing_[q];
      }
    for (const std::uint32_t v : vertices)  // all dual edges that go through those crossings' faces
      for (const std::uint32_t q : mesh_.quads_of(v)) {
        const Polygon polygon = mesh_.polygon(q);
        for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size); ++k) {
          const auto point = face_point_.find(
              side_key(polygon.vertex[k], polygon.vertex[(k + 1) % static_cast<std::size_t>(polygon.size)]));
          if (point != face_point_.end())
            drawing_.places[point->second] =
                place_on_face(polygon.vertex[k], polygon.vertex[(k + 1) % static_cast<std::size_t>(polygon.size)]);
        }
      }
  }

 private:
  ExactPlace edge_start(std::uint32_t q) const {
    const GridEdge& e = labelled_.edges[q];
    return ExactPlace(e.x, e.y, e.z) * kExactSteps;
  }
  Cut choose_cut(std::uint32_t q, const Triangulation& preferred) const {
    if (mesh_.has_doubled(q)) return Cut::kFan;
    const auto& corners = mesh_.quads[q];
    const std::array<ExactPlace, 4> at{drawing_.places[corners[0]], drawing_.places[corners[1]],
                                       drawing_.places[corners[2]], drawing_.places[corners[3]]};
    const Triangle& t = preferred.triangles[preferred.first_triangle[q]];
    const bool first = std::find(t.begin(), t.end(), corners[0]) != t.end();  // 012 or 123
    const unsigned allowed = allowed_diagonals(at, {edge_start(q), labelled_.edges[q].axis, true, false});
    const auto fits = [&](bool diagonal) { return (allowed & (diagonal ? 1u : 2u)) != 0; };
    if (fits(first)) return first ? Cut::kFirstDiagonal : Cut::kSecondDiagonal;
    if (fits(!first)) return first ? Cut::kSecondDiagonal : Cut::kFirstDiagonal;
    return Cut::kFan;
  }
  std::uint32_t add_point(const ExactPlace& place) {
    drawing_.places.push_back(place);
    return static_cast<std::uint32_t>(drawing_.places.size() - 1);
  }
  void make_fan(std::uint32_t q) {
    cut_[q] = Cut::kFan;
    if (edge_point_.contains(q)) return;
    edge_point_[q] = add_point(crossing_[q]);
    ++drawing_.edge_points;
  }
  /// Where the dual edge between the vertices of two cells goes through their face: the mean of the crossings of its
  /// segment, or of its three.
  ExactPlace place_on_face(std::uint32_t v, std::uint32_t w) const {
    ExactPlace sum(0);
    std::int64_t count = 0;
    for (const std::uint32_t q : mesh_.quads_of(v)) {
      const Polygon polygon = mesh_.polygon(q);
      const auto n = static_cast<std::size_t>(polygon.size);
      for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t a = polygon.vertex[k], b = polygon.vertex[(k + 1) % n];
        if ((a != v || b != w) && (a != w || b != v)) continue;
        sum += crossing_[q];
        ++count;
      }
    }
    DUBSAR_CHECK(count > 0);
    for (int a = 0; a < 3; ++a)
      sum[a] = static_cast<std::int64_t>(std::floor(static_cast<double>(sum[a]) / static_cast<double>(count) + 0.5));
    return sum;
  }
  bool shares_cell(std::uint32_t v) const {
    const auto& cells = labelled_.vertex_cells;
    return (v > 0 && cells[v - 1] == cells[v]) || (v + 1 < cells.size() && cells[v + 1] == cells[v]);
  }
  std::uint32_t first_of_cell(std::uint32_t v) const {
    while (v > 0 && labelled_.vertex_cells[v - 1] == labelled_.vertex_cells[v]) --v;
    return v;
  }
  std::vector<std::uint32_t> first_to_vertices(std::uint32_t first) const {
    std::vector<std::uint32_t> vertices{first};
    while (vertices.back() + 1 < labelled_.vertex_cells.size() &&
           labelled_.vertex_cells[vertices.back() + 1] == labelled_.vertex_cells[first])
      vertices.push_back(vertices.back() + 1);
    return vertices;
  }
  template <class Visit>
  void each_vertex_of(std::uint32_t q, const Visit& visit) const {
    const Polygon polygon = mesh_.polygon(q);
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size); ++k) visit(polygon.vertex[k]);
  }
  /// Fans and face points all round a cell.
  void secure(std::uint32_t first) {
    secured_[first] = true;
    ++secured_count_;
    for (const std::uint32_t v : first_to_vertices(first))
      for (const std::uint32_t q : mesh_.quads_of(v)) {
        make_fan(q);
        const Polygon polygon = mesh_.polygon(q);
        const auto n = static_cast<std::size_t>(polygon.size);
        for (std::size_t k = 0; k < n; ++k) {
          const std::uint32_t a = polygon.vertex[k], b = polygon.vertex[(k + 1) % n];
          if ((a != v && b != v) || polygon.corner[k] == polygon.corner[(k + 1) % n]) continue;
          std::uint32_t& point = face_point_.try_emplace(side_key(a, b), 0).first->second;
          if (point != 0) continue;
          point = add_point(place_on_face(a, b));
          ++drawing_.face_points;
        }
      }
  }
  std::vector<std::uint32_t> secured_beside(std::uint32_t first) const {
    std::vector<std::uint32_t> beside;
    for (const std::uint32_t v : first_to_vertices(first))
      for (const std::uint32_t q : mesh_.quads_of(v))
        each_vertex_of(q, [&](std::uint32_t w) {
          const std::uint32_t other = first_of_cell(w);
          const auto found = secured_.find(other);
          if (other != first && found != secured_.end() && found->second) beside.push_back(other);
        });
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    return beside;
  }
  std::uint32_t quad_of(std::uint32_t triangle) const {
    const auto& first = drawing_.first_triangle;
    return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), triangle) - first.begin() - 1);
  }
  template <class Which>
  std::vector<std::uint8_t> triangles_of(const Which& which) const {
    std::vector<std::uint8_t> wanted(drawing_.triangles.size());
    parallel_for(mesh_.quad_count(), kDrawGrain, [&](std::int64_t i) {
      const auto q = static_cast<std::uint32_t>(i);
      bool any = false;
      each_vertex_of(q, [&](std::uint32_t v) { any = any || which(v); });
      for (std::uint32_t t = drawing_.first_triangle[q]; t < drawing_.first_triangle[q + 1]; ++t) wanted[t] = any;
    });
    return wanted;
  }
  /// All triangles anew.
  void draw() {
    drawing_.triangles.clear();
    drawing_.triangles.reserve(2 * cut_.size());
    drawing_.first_triangle.resize(cut_.size() + 1);
    for (std::uint32_t q = 0; q < cut_.size(); ++q) {
      drawing_.first_triangle[q] = static_cast<std::uint32_t>(drawing_.triangles.size());
      const auto& v = mesh_.quads[q];
      if (cut_[q] == Cut::kFirstDiagonal) {
        drawing_.triangles.push_back({v[0], v[1], v[2]});
        drawing_.triangles.push_back({v[0], v[2], v[3]});
      } else if (cut_[q] == Cut::kSecondDiagonal) {
        drawing_.triangles.push_back({v[1], v[2], v[3]});
        drawing_.triangles.push_back({v[1], v[3], v[0]});
      } else {
        draw_fan(q);
      }
    }
    drawing_.first_triangle.back() = static_cast<std::uint32_t>(drawing_.triangles.size());
  }
  void draw_fan(std::uint32_t q) {
    const Polygon polygon = mesh_.polygon(q);
    const auto n = static_cast<std::size_t>(polygon.size);
    const std::uint32_t middle = edge_point_.at(q);
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t a = polygon.vertex[k], b = polygon.vertex[(k + 1) % n];
      const auto point = face_point_.find(side_key(a, b));
      if (point == face_point_.end()) {
        drawing_.triangles.push_back({a, b, middle});
      } else {
        drawing_.triangles.push_back({a, point->second, middle});
        drawing_.triangles.push_back({point->second, b, middle});
      }
    }
  }

  const LabelledMesh& labelled_;
  const QuadMesh& mesh_;
  std::vector<Cut> cut_;
  std::vector<ExactPlace> crossing_;  ///< of each x-quad, strictly inside its edge
  std::unordered_map<std::uint32_t, std::uint32_t> edge_point_;
  std::unordered_map<std::uint64_t, std::uint32_t> face_point_;  ///< by the dual edge
  std::unordered_map<std::uint32_t, bool> secured_;              ///< by the first vertex of the cell
  std::size_t secured_count_ = 0;
  SafeDrawing drawing_;
};

}  // namespace

SafeDrawing draw_safely(const LabelledMesh& labelled, std::span<const glm::vec3> wanted,
                        std::span<const glm::vec3> crossings, const Triangulation& preferred) {
  DUBSAR_CHECK(wanted.size() == labelled.mesh.positions.size() && crossings.size() == labelled.mesh.quads.size());
  return Drawer(labelled, wanted, crossings).run(preferred);
}

std::vector<glm::vec3> crossings_of(const LabelledMesh& labelled, const SurfaceSamples& samples,
                                    const std::vector<std::uint16_t>& contact) {
  std::vector<glm::vec3> crossings(labelled.edges.size());
  parallel_for(static_cast<std::int64_t>(crossings.size()), kDrawGrain, [&](std::int64_t i) {
    const auto q = static_cast<std::size_t>(i);
    const GridEdge& e = labelled.edges[q];
    const float quantum = 1.0f / static_cast<float>(2 << samples.offset_bits);
    float along = 0.5f;
    if (q >= labelled.first_contact) {
      if (!contact.empty()) along = static_cast<float>(2 * contact[q - labelled.first_contact] + 1) * quantum;
    } else if (q < samples.offsets.size()) {
      along = static_cast<float>(2 * samples.offsets[q] + 1) * quantum;
    } else {  // beyond the grid: at the point inside
      const bool inside = e.x >= 0 && e.y >= 0 && e.z >= 0 && samples.signs.get(e.x, e.y, e.z);
      along = inside ? 0.0f : 1.0f;
    }
    crossings[q] = glm::vec3(static_cast<float>(e.x), static_cast<float>(e.y), static_cast<float>(e.z));
    crossings[q][e.axis] += along;
  });
  return crossings;
}

}  // namespace dubsar
