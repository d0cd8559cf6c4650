// Extraction against a construction that shares no code with it: marching cubes curves held in maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <set>

#include "core/extract/cell_table.h"
#include "core/extract/row_kernels.h"
#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

using Point = std::array<int, 3>;
using Edge = std::pair<Point, Point>;  // rising

/// The marching cubes polygon complex of a closed volume: crossings, segments on cell faces, curves in cells.
struct NaiveSurface {
  struct Component {
    long crossings = 0, segments = 0, curves = 0;
    auto operator<=>(const Component&) const = default;
  };
  std::map<Edge, double> crossings;               // with t
  std::multiset<std::array<long, 2>> components;  // {crossings = x-quads, Euler number}
  long curves = 0, pinches = 0;

  NaiveSurface(const Volume<float>& volume, float tau) {
    const auto inside_grid = [&](const Point& p) {
      return p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] < volume.dims.x && p[1] < volume.dims.y &&
             p[2] < volume.dims.z;
    };
    const auto value = [&](const Point& p) { return static_cast<long double>(volume.at(p[0], p[1], p[2])) - tau; };
    const auto inside = [&](const Point& p) { return inside_grid(p) && volume.at(p[0], p[1], p[2]) >= tau; };
    const auto plus = [](Point p, int axis) { return ++p[static_cast<std::size_t>(axis)], p; };
    const auto edge = [](const Point& p, const Point& q) { return p < q ? Edge{p, q} : Edge{q, p}; };

    // Segments of every face of every cell, also between virtual points; faces are looked at once.
    std::map<std::pair<Point, int>, std::vector<std::pair<Edge, Edge>>> faces;
    std::map<Edge, Edge> parent;
    std::function<Edge(Edge)> root = [&](Edge e) {
      while (parent.at(e) != e) e = parent.at(e);
      return e;
    };
    const auto each_point = [&](const std::function<void(const Point&)>& visit) {
      Point p;
      for (p[2] = -1; p[2] <= volume.dims.z; ++p[2]) {
        for (p[1] = -1; p[1] <= volume.dims.y; ++p[1]) {
          for (p[0] = -1; p[0] <= volume.dims.x; ++p[0]) visit(p);
        }
      }
    };
    each_point([&](const Point& p) {
      for (int a = 0; a < 3; ++a) {
        const Point q = plus(p, a);
        if (inside(p) == inside(q)) continue;
        long double t = 0.5L;
        if (!inside_grid(p) || !inside_grid(q)) {
          t = inside_grid(p) ? 0 : 1;
        } else if (std::isfinite(value(p) / (value(p) - value(q)))) {
          t = value(p) / (value(p) - value(q));
        }
        crossings[{p, q}] = static_cast<double>(t);
        parent[{p, q}] = {p, q};
      }
    });
    each_point([&](const Point& p) {
      for (int a = 0; a < 3; ++a) {
        const int u = (a + 1) % 3, v = (a + 2) % 3;
        const std::array<Point, 4> ring = {p, plus(p, u), plus(plus(p, u), v), plus(p, v)};
        std::vector<Edge> active;
        for (std::size_t i = 0; i < 4; ++i) {
          const Point &r = ring[i], &s = ring[(i + 1) % 4];
          if (inside(r) != inside(s)) active.push_back(edge(r, s));
        }
        auto& segments = faces[{p, a}];
        if (active.size() == 2) segments = {{active[0], active[1]}};
        if (active.size() == 4) {
          // Bilinear saddle value above the isovalue: the inside corners are joined, the outside ones cut off.
          const std::size_t even = inside(ring[0]) ? 0 : 1;
          const long double in = value(ring[even]) * value(ring[even + 2]);
          const long double out = value(ring[1 - even]) * value(ring[3 - even]);
          // active[i] lies between ring[i] and ring[i + 1]: cut off ring[k] by active[k - 1], active[k].
          const std::size_t k = in > out ? 1 - even : even;
          segments = {{active[(k + 3) % 4], active[k]}, {active[(k + 1) % 4], active[(k + 2) % 4]}};
        }
        for (const auto& [e, f] : segments) parent[root(e)] = root(f);
      }
    });
    std::map<Edge, Component> parts;
    for (const auto& [e, t] : crossings) ++parts[root(e)].crossings;
    for (const auto& [face, segments] : faces) {
      for (const auto& segment : segments) ++parts[root(segment.first)].segments;
    }
    each_point([&](const Point& p) {  // the cell above p: join its crossings to curves
      std::map<Edge, std::vector<std::pair<Edge, int>>> next;
      int face_number = 0;
      for (int a = 0; a < 3; ++a) {
        for (const Point& q : {p, plus(p, a)}) {
          ++face_number;
          const auto found = faces.find({q, a});
          if (found == faces.end()) continue;
          for (const auto& [e, f] : found->second) {
            next[e].push_back({f, face_number});
            next[f].push_back({e, face_number});
          }
        }
      }
      std::set<Edge> seen;
      for (const auto& [start, unused] : next) {
        if (seen.contains(start)) continue;
        ++curves;
        ++parts[root(start)].curves;
        std::map<int, int> face_segments;
        std::vector<Edge> todo = {start};
        while (!todo.empty()) {
          const Edge e = todo.back();
          todo.pop_back();
          if (!seen.insert(e).second) continue;
          for (const auto& [f, number] : next.at(e)) {
            ++face_segments[number];
            todo.push_back(f);
          }
        }
        for (const auto& [number, ends] : face_segments) pinches += ends == 4;
      }
    });
    for (const auto& [e, part] : parts) {
      components.insert({part.crossings, part.crossings - part.segments + part.curves});
    }
  }
};

/// The same of the dual mesh: {x-quads, Euler number} of every component.
std::multiset<std::array<long, 2>> dual_components(const QuadMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const std::function<std::uint32_t(std::uint32_t)> root = [&](std::uint32_t v) {
    return parent[v] == v ? v : parent[v] = root(parent[v]);
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
    const Polygon polygon = mesh.polygon(q);
    for (int i = 0; i < polygon.size; ++i) {
      const std::uint32_t v = polygon.vertex[static_cast<std::size_t>(i)];
      const std::uint32_t w = polygon.vertex[static_cast<std::size_t>((i + 1) % polygon.size)];
      edges.insert({std::min(v, w), std::max(v, w)});
      parent[root(v)] = root(w);
    }
  }
  std::map<std::uint32_t, std::array<long, 2>> parts;
  for (std::uint32_t v = 0; v < parent.size(); ++v) ++parts[root(v)][1];
  for (const auto& [v, w] : edges) --parts[root(v)][1];
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
    auto& part = parts[root(mesh.quads[q][0])];
    ++part[0];
    ++part[1];
  }
  std::multiset<std::array<long, 2>> components;
  for (const auto& [v, part] : parts) components.insert(part);
  return components;
}

TEST(ExtractOracle, ComponentsAndEulerNumbersAreThoseOfMarchingCubesInMaps) {
  long pinches = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Volume<float> volume =
        random_volume({3 + seed % 9, 9 - seed % 7, 4 + seed % 5}, seed, static_cast<int>(seed % 5));
    const NaiveSurface naive(volume, 0.0f);
    const QuadMesh mesh = build(sample(volume, 0.0f));
    EXPECT_EQ(mesh.quad_count(), static_cast<std::int64_t>(naive.crossings.size())) << seed;
    EXPECT_EQ(mesh.vertex_count(), naive.curves + static_cast<long>(mesh.doubled.size()) / 2) << seed;
    EXPECT_EQ(dual_components(mesh), naive.components) << seed;
    EXPECT_EQ(mesh.doubled.empty(), naive.pinches == 0) << seed;
    pinches += naive.pinches;
  }
  EXPECT_GT(pinches, 100);
}

TEST(ExtractOracle, XQuadsComeInTheStatedOrderAroundTheirEdges) {
  for (const bool closed : {true, false}) {
    const Volume<float> volume = random_volume({67, 4, 4}, 5, 0);
    const Dims& dims = volume.dims;
    const NaiveSurface naive(volume, 0.0f);
    const QuadMesh mesh = build(sample(volume, 0.0f, closed, 16));
    std::vector<std::pair<Edge, double>> expected;
    for (const bool virtual_edges : {false, true}) {
      for (int z = -1; z < dims.z; ++z) {
        for (int y = -1; y < dims.y; ++y) {
          for (int a = 0; a < 3; ++a) {
            for (int x = -1; x < dims.x; ++x) {
              Point q = {x, y, z};
              ++q[static_cast<std::size_t>(a)];
              const bool is_virtual = x < 0 || y < 0 || z < 0 || q[0] == dims.x || q[1] == dims.y || q[2] == dims.z;
              const auto at_face = [&](int axis, int c, std::int64_t n) { return axis != a && (c == 0 || c == n - 1); };
              const bool dropped =
                  !closed && (is_virtual || at_face(0, x, dims.x) || at_face(1, y, dims.y) || at_face(2, z, dims.z));
              const auto found = naive.crossings.find({{x, y, z}, q});
              if (is_virtual == virtual_edges && !dropped && found != naive.crossings.end()) expected.push_back(*found);
            }
          }
        }
      }
    }
    ASSERT_EQ(mesh.quads.size(), expected.size());
    for (std::uint32_t i = 0; i < mesh.quads.size(); ++i) {
      const auto& [edge, t] = expected[i];
      const glm::dvec3 p(edge.first[0], edge.first[1], edge.first[2]),
          q(edge.second[0], edge.second[1], edge.second[2]);
      const int a = q.x > p.x ? 0 : q.y > p.y ? 1 : 2, u = (a + 1) % 3, v = (a + 2) % 3;
      const auto air = [&](const Point& at) {
        const bool in_grid = std::ranges::min(at) >= 0 && at[0] < dims.x && at[1] < dims.y && at[2] < dims.z;
        return !(in_grid && volume.at(at[0], at[1], at[2]) >= 0.0f);
      };
      const Polygon polygon = mesh.polygon(i);
      for (int k = 0; k < polygon.size; ++k) {
        // Corner 0 at (+u, +v), then counter-clockwise seen from the air.
        constexpr int kU[4] = {1, -1, -1, 1}, kV[4] = {1, 1, -1, -1};
        const int corner = polygon.corner[static_cast<std::size_t>(k)];
        const int turn = air(edge.second) ? corner : (4 - corner) % 4;
        const glm::vec3 at = mesh.positions[polygon.vertex[static_cast<std::size_t>(k)]];
        EXPECT_GE(kU[turn] * (at[u] - p[u]), 0.0) << "x-quad " << i;
        EXPECT_GE(kV[turn] * (at[v] - p[v]), 0.0) << "x-quad " << i;
        EXPECT_LE(kU[turn] * (at[u] - p[u]), 1.0) << "x-quad " << i;
        EXPECT_LE(kV[turn] * (at[v] - p[v]), 1.0) << "x-quad " << i;
        EXPECT_GE(at[a] - p[a], 0.0);
        EXPECT_LE(at[a] - p[a], 1.0);
      }
    }
  }
}

class ExtractOracleSize : public testing::TestWithParam<Dims> {};

TEST_P(ExtractOracleSize, VerticesAreTheMeansOfTheirCrossings) {
  const Volume<float> volume = random_volume(GetParam(), 8, 2);
  const NaiveSurface naive(volume, 0.0f);
  const SurfaceSamples samples = sample(volume, 0.0f, true, 16);
  const QuadMesh mesh = build(samples);
  // Crossings in order of the x-quads: the order is tested above.
  std::vector<glm::dvec3> crossing;
  for (const bool virtual_edges : {false, true}) {
    std::map<std::array<int, 5>, glm::dvec3> ordered;
    for (const auto& [edge, t] : naive.crossings) {
      const auto& [p, q] = edge;
      const int a = q[0] > p[0] ? 0 : q[1] > p[1] ? 1 : 2;
      const bool is_virtual =
          std::ranges::min(p) < 0 || q[0] == volume.dims.x || q[1] == volume.dims.y || q[2] == volume.dims.z;
      glm::dvec3 at(p[0], p[1], p[2]);
      at[a] += t;
      if (is_virtual == virtual_edges) ordered[{p[2], p[1], a, p[0], 0}] = at;
    }
    for (const auto& [key, at] : ordered) crossing.push_back(at);
  }
  ASSERT_EQ(crossing.size(), mesh.quads.size());
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    glm::dvec3 mean(0.0);
    for (const std::uint32_t q : mesh.quads_of(v)) mean += crossing[q];
    mean /= static_cast<double>(mesh.quads_of(v).size());
    const auto rounding = [](double at) { return 0x1p-24 * std::abs(at); };
    for (int a = 0; a < 3; ++a)
      EXPECT_NEAR(mesh.positions[v][a], mean[a], 1e-5 + 0x1p-17 + rounding(mean[a])) << "vertex " << v;
  }
}

// The long ones have rows of more words than are looked at together.
INSTANTIATE_TEST_SUITE_P(All, ExtractOracleSize, testing::Values(Dims{12, 9, 8}, Dims{2047, 2, 3}, Dims{2050, 3, 2}));

}  // namespace
}  // namespace dubsar
