#include "core/contact/interface_mesh.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

enum Corner : std::uint8_t { kAir, kTablet, kEnvelope };

glm::ivec3 offset(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2}; }

/// Edge of a cell between two of its corners (cell_table.h).
int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  return 4 * axis + (a >> u & 1) + 2 * (a >> v & 1);
}

/// The corners of a face, around it.
std::array<int, 4> face_corners(int face) {
  const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, base = (face & 1) << axis;
  return {base, base | 1 << u, base | 1 << u | 1 << v, base | 1 << v};
}

/// By edge and face of a cell: the dual vertex at the face's air.
using AtAir = std::array<std::array<std::uint32_t, 6>, 12>;

/// How the contact meets one cell.
struct Cell {
  std::array<std::uint8_t, 12> root;     ///< edges whose polygons share a vertex here
  std::array<std::uint32_t, 12> vertex;  ///< by root
  std::uint32_t at_air = kNone;          ///< of the few cells that have air
};

class Maker {
 public:
  Maker(const SurfaceModel& model, const EdgeIndex& index, const ContactBand& band, const std::vector<ClaySide>& side,
        const Dips& dips)
      : model_(model), index_(index), band_(band), side_(side), dips_(dips), cell_place_(band.node_at.dims(), kNone) {}

  InterfaceMesh run() {
    for (std::uint32_t n = 0; n < band_.nodes.size(); ++n)
      for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t m = band_.at(band_.point(n) + unit_step(axis));
        if (m != ContactBand::kNone && side_[m] != side_[n]) add_polygon(n, m, axis);
      }
    for (std::size_t i = 0; i < mesh_.added.size(); ++i) {
      mesh_.added[i] /= weight_[i];
      mesh_.strength[i] /= weight_[i];
    }
    return std::move(mesh_);
  }

 private:
  Corner kind(const glm::ivec3& p) const {
    if (!model_.samples.signs.get(p.x, p.y, p.z)) return kAir;
    const std::uint32_t n = band_.at(p);
    return n == ContactBand::kNone || side_[n] == ClaySide::kTablet ? kTablet : kEnvelope;
  }

  /// Vertices in `cell` of the x-quad around the active edge between two corners.
  std::array<std::uint32_t, 2> dual_vertices(const glm::ivec3& cell, int a, int b) const {
    if (a > b) std::swap(a, b);
    const int axis = edge_between(a, b) / 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const glm::ivec3 start = cell + offset(a);
    const bool low_u = cell[u] == start[u], low_v = cell[v] == start[v];  // the cell at +u, +v of the edge
    const bool inside_low = model_.samples.signs.get(start.x, start.y, start.z);
    const int corner = low_u && low_v ? 0 : !low_u && !low_v ? 2 : (low_v == inside_low) ? 1 : 3;
    const std::uint32_t quad = index_.quad_of(axis, start.x, start.y, start.z);
    std::array<std::uint32_t, 2> found{kNone, kNone};
    if (!model_.mesh.has_doubled(quad)) {
      found[0] = model_.mesh.quads[quad][static_cast<std::size_t>(corner)];
      return found;
    }
    const Polygon polygon = model_.mesh.polygon(quad);
    for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i)
      if (polygon.corner[i] == corner) (found[0] == kNone ? found[0] : found[1]) = polygon.vertex[i];
    return found;
  }

  /// The vertex on whose curve both active edges (a, b) and (c, d) of a face lie.
  std::uint32_t common(const glm::ivec3& cell, int a, int b, int c, int d) const {
    const auto first = dual_vertices(cell, a, b), second = dual_vertices(cell, c, d);
    for (const std::uint32_t v : first)
      if (v != kNone && (v == second[0] || v == second[1])) return v;
    return first[0];
  }

  Cell& cell_at(const glm::ivec3& p) {
    std::uint32_t& place = cell_place_.at(p.x, p.y, p.z);
    if (place == kNone) {
      place = static_cast<std::uint32_t>(cells_.size());
      fill(p, cells_.emplace_back());
    }
    return cells_[place];
  }

  void fill(const glm::ivec3& p, Cell& cell) {
    for (std::uint8_t e = 0; e < 12; ++e) cell.root[e] = e;
    cell.vertex.fill(kNone);
    std::array<Corner, 8> kinds;
    for (int c = 0; c < 8; ++c) kinds[static_cast<std::size_t>(c)] = kind(p + offset(c));
    const auto is = [&](int c) { return kinds[static_cast<std::size_t>(c)]; };
    const auto root = [&](int e) {
      while (cell.root[static_cast<std::size_t>(e)] != e) e = cell.root[static_cast<std::size_t>(e)];
      return e;
    };
    const auto join = [&](int e, int f) {
      const int a = root(e), b = root(f);
      cell.root[static_cast<std::size_t>(std::max(a, b))] = static_cast<std::uint8_t>(std::min(a, b));
    };
    for (int face = 0; face < 6; ++face) {
      const std::array<int, 4> c = face_corners(face);
      const auto corner = [&](int i) { return c[static_cast<std::size_t>(i & 3)]; };
      int airs = 0;
      for (const int k : c) airs += is(k) == kAir;
      const auto attach = [&](int e, std::uint32_t v) {
        if (cell.at_air == kNone) {
          cell.at_air = static_cast<std::uint32_t>(at_air_.size());
          for (auto& faces : at_air_.emplace_back()) faces.fill(kNone);
        }
        at_air_[cell.at_air][static_cast<std::size_t>(e)][static_cast<std::size_t>(face)] = v;
      };
      for (int i = 0; i < 4; ++i) {
        const int before = corner(i + 3), here = corner(i), next = corner(i + 1), beyond = corner(i + 2);
        if (airs == 0 && is(here) == kEnvelope && is(before) == kTablet && is(next) == kTablet)
          join(edge_between(before, here), edge_between(here, next));
        if (airs == 0 && is(here) == kTablet && is(before) == kEnvelope && is(next) == kEnvelope &&
            is(beyond) == kEnvelope)
          join(edge_between(before, here), edge_between(here, next));
        if (airs == 0 && is(before) == kTablet && is(here) == kTablet && is(next) == kEnvelope &&
            is(beyond) == kEnvelope)
          join(edge_between(here, next), edge_between(beyond, before));
        if (airs == 0 && is(before) == kEnvelope && is(here) == kEnvelope && is(next) == kTablet &&
            is(beyond) == kTablet)
          join(edge_between(here, next), edge_between(beyond, before));
        if (airs == 1 && is(here) == kAir && is(before) == is(next) && is(beyond) != is(next))
          join(edge_between(before, beyond), edge_between(beyond, next));
        if (airs == 1 && is(here) == kAir && is(before) != is(next))
          attach(is(beyond) != is(next) ? edge_between(beyond, next) : edge_between(beyond, before),
                 common(p, here, next, here, before));
        if (airs == 2 && is(here) != kAir && is(next) != kAir && is(here) != is(next))
          attach(edge_between(here, next), common(p, here, before, next, beyond));
      }
    }
    for (int e = 0; e < 12; ++e) cell.root[static_cast<std::size_t>(e)] = static_cast<std::uint8_t>(root(e));
    if (cell.at_air == kNone) return;
    for (std::size_t e = 0; e < 12; ++e)
      for (const std::uint32_t v : at_air_[cell.at_air][e]) {
        std::uint32_t& shared = cell.vertex[cell.root[e]];
        if (v != kNone && shared == kNone) shared = v;
      }
  }

  /// The vertex in a cell of the polygon around edge `e`, where the polygon crosses the cell's `face`.
  std::uint32_t vertex(Cell& cell, int e, int face, const glm::vec3& crossing, float strength) {
    if (cell.at_air != kNone) {
      const std::uint32_t at_air = at_air_[cell.at_air][static_cast<std::size_t>(e)][static_cast<std::size_t>(face)];
      if (at_air != kNone) return at_air;
    }
    std::uint32_t& shared = cell.vertex[cell.root[static_cast<std::size_t>(e)]];
    if (shared == kNone) shared = add_vertex();
    const auto dual = static_cast<std::uint32_t>(model_.mesh.positions.size());
    if (shared >= dual) {
      mesh_.added[shared - dual] += crossing;
      mesh_.strength[shared - dual] += strength;
      weight_[shared - dual] += 1.0f;
    }
    return shared;
  }

  std::uint32_t add_vertex() {
    mesh_.added.emplace_back(0.0f);
    mesh_.strength.push_back(0.0f);
    weight_.push_back(0.0f);
    return static_cast<std::uint32_t>(model_.mesh.positions.size() + mesh_.added.size() - 1);
  }

  /// Where along the edge the density is least, 0..1: the vertex of a parabola.
  float dip_between(std::uint32_t n, std::uint32_t m, int axis) const {
    if (dips_.density.empty()) return 0.5f;
    const bool first = dips_.density[n] <= dips_.density[m];
    const std::uint32_t middle = first ? n : m;
    const std::uint32_t below = band_.at(band_.point(middle) - unit_step(axis)),
                        above = band_.at(band_.point(middle) + unit_step(axis));
    if (below == ContactBand::kNone || above == ContactBand::kNone) return 0.5f;
    const float a = dips_.density[below], b = dips_.density[middle], c = dips_.density[above];
    const float bend = a - 2.0f * b + c;
    if (!(bend > 0.0f)) return 0.5f;
    return std::clamp((first ? 0.0f : 1.0f) + 0.5f * (a - c) / bend, 0.0f, 1.0f);
  }

  void add_polygon(std::uint32_t n, std::uint32_t m, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const glm::ivec3 start = band_.point(n);
    const glm::vec3 crossing = glm::vec3(start) + dip_between(n, m, axis) * glm::vec3(unit_step(axis));
    const float strength = std::max(dips_.strength[n], dips_.strength[m]);
    // Counter-clockwise seen from the upper end: cells at (+u +v), (-u +v), (-u -v), (+u -v).
    struct Step {
      int du, dv, in, out;
    };
    const std::array<Step, 4> steps{Step{0, 0, 2 * v, 2 * u}, Step{-1, 0, 2 * u + 1, 2 * v},
                                    Step{-1, -1, 2 * v + 1, 2 * u + 1}, Step{0, -1, 2 * u, 2 * v + 1}};
    std::array<std::uint32_t, 9> polygon{};
    std::size_t size = 0;
    for (const Step& step : steps) {
      Cell& cell = cell_at(start + step.du * unit_step(u) + step.dv * unit_step(v));
      const int e = 4 * axis + (step.du < 0 ? 1 : 0) + (step.dv < 0 ? 2 : 0);
      const std::uint32_t in = vertex(cell, e, step.in, crossing, strength);
      const std::uint32_t out = vertex(cell, e, step.out, crossing, strength);
      polygon[size++] = in;
      if (out != in) {
        polygon[size++] = out;
        ++mesh_.doubled_corners;
      }
    }
    if (side_[n] == ClaySide::kEnvelope)
      std::reverse(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(size));
    triangulate(polygon, size, crossing, strength);
  }

  /// A quadrilateral by a diagonal, which no other polygon has; more corners by a star.
  void triangulate(const std::array<std::uint32_t, 9>& p, std::size_t size, const glm::vec3& crossing, float strength) {
    if (size == 4) {
      mesh_.quads.push_back(static_cast<std::uint32_t>(mesh_.triangles.size()));
      mesh_.triangles.push_back({p[0], p[1], p[2]});
      mesh_.triangles.push_back({p[0], p[2], p[3]});
      return;
    }
    const std::uint32_t centre = add_vertex();
    mesh_.added.back() = crossing;
    mesh_.strength.back() = strength;
    weight_.back() = 1.0f;
    for (std::size_t i = 0; i < size; ++i) mesh_.triangles.push_back({centre, p[i], p[(i + 1) % size]});
  }

  const SurfaceModel& model_;
  const EdgeIndex& index_;
  const ContactBand& band_;
  const std::vector<ClaySide>& side_;
  const Dips& dips_;
  BrickMap<std::uint32_t> cell_place_;  ///< kNone: not yet in `cells_`
  std::vector<Cell> cells_;
  std::vector<AtAir> at_air_;
  std::vector<float> weight_;
  InterfaceMesh mesh_;
};

}  // namespace

InterfaceMesh make_interface(const SurfaceModel& model, const EdgeIndex& index, const ContactBand& band,
                             const std::vector<ClaySide>& side, const Dips& dips) {
  return Maker(model, index, band, side, dips).run();
}

}  // namespace dubsar
