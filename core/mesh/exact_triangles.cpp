#include "core/mesh/exact_triangles.h"

#include <algorithm>
#include <cstdlib>
#include <glm/common.hpp>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

__extension__ using Wide = __int128;
constexpr std::int64_t kNarrow = std::int64_t{1} << 20;  // six products of three such differences stay below 2^63
constexpr std::int64_t kPlacesGrain = 1 << 15;

template <class T>
int sign_of(T value) noexcept {
  return (value > 0) - (value < 0);
}

bool is_narrow(const ExactPlace& d) noexcept {
  return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < kNarrow;
}

template <class T>
int sign_of_volume(const ExactPlace& u, const ExactPlace& v, const ExactPlace& w) noexcept {
  const auto minor = [](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
    return T(a) * T(d) - T(b) * T(c);
  };
  return sign_of(minor(u.y, u.z, v.y, v.z) * T(w.x) + minor(u.z, u.x, v.z, v.x) * T(w.y) +
                 minor(u.x, u.y, v.x, v.y) * T(w.z));
}

/// Signs of the vector product.
glm::ivec3 across(const ExactPlace& u, const ExactPlace& v) noexcept {
  const auto sign = [](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
    return sign_of(Wide(a) * Wide(d) - Wide(b) * Wide(c));
  };
  return {sign(u.y, u.z, v.y, v.z), sign(u.z, u.x, v.z, v.x), sign(u.x, u.y, v.x, v.y)};
}

/// The same things seen along an axis: the two others are left, in their order.
class Shadow {
 public:
  explicit Shadow(int axis) : u_((axis + 1) % 3), v_((axis + 2) % 3) {}

  int turn(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c) const noexcept {
    return sign_of(Wide(b[u_] - a[u_]) * Wide(c[v_] - a[v_]) - Wide(b[v_] - a[v_]) * Wide(c[u_] - a[u_]));
  }
  /// c, which lies on the line ab, lies between its ends.
  bool between(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c) const noexcept {
    const auto within = [&](int i) { return std::min(a[i], b[i]) <= c[i] && c[i] <= std::max(a[i], b[i]); };
    return within(u_) && within(v_);
  }
  bool segments_meet(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c,
                     const ExactPlace& d) const noexcept {
    const int abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
  }
  bool inside(const std::array<ExactPlace, 3>& t, const ExactPlace& p) const noexcept {
    const int a = turn(t[0], t[1], p), b = turn(t[1], t[2], p), c = turn(t[2], t[0], p);
    return std::min({a, b, c}) >= 0 || std::max({a, b, c}) <= 0;
  }

 private:
  int u_, v_;
};

int axis_of(const glm::ivec3& normal) noexcept { return normal.x != 0 ? 0 : normal.y != 0 ? 1 : 2; }

/// Segments in space, either maybe a point.
bool segments_meet(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c, const ExactPlace& d) noexcept {
  if (orientation(a, b, c, d) != 0) return false;
  for (const glm::ivec3& normal :
       {across(b - a, c - a), across(b - a, d - a), across(d - c, a - c), across(d - c, b - c)})
    if (normal != glm::ivec3(0)) return Shadow(axis_of(normal)).segments_meet(a, b, c, d);
  for (int i = 0; i < 3; ++i)  // all on one line: they meet where they do along every axis
    if (std::max(a[i], b[i]) < std::min(c[i], d[i]) || std::max(c[i], d[i]) < std::min(a[i], b[i])) return false;
  return true;
}

bool boxes_meet(const std::array<ExactPlace, 3>& a, const std::array<ExactPlace, 3>& b) noexcept {
  for (int i = 0; i < 3; ++i)
    if (std::max({a[0][i], a[1][i], a[2][i]}) < std::min({b[0][i], b[1][i], b[2][i]}) ||
        std::max({b[0][i], b[1][i], b[2][i]}) < std::min({a[0][i], a[1][i], a[2][i]}))
      return false;
  return true;
}

/// All corners of b are strictly on one side of the plane of a.
bool on_one_side(const std::array<ExactPlace, 3>& a, const std::array<ExactPlace, 3>& b) noexcept {
  const int side = orientation(a[0], a[1], a[2], b[0]);
  return side != 0 && orientation(a[0], a[1], a[2], b[1]) == side && orientation(a[0], a[1], a[2], b[2]) == side;
}

/// A side of one meets the other.
bool any_side_meets(const std::array<ExactPlace, 3>& a, const std::array<ExactPlace, 3>& b) noexcept {
  for (std::size_t i = 0; i < 3; ++i)
    if (segment_meets_triangle(a[i], a[(i + 1) % 3], b) || segment_meets_triangle(b[i], b[(i + 1) % 3], a)) return true;
  return false;
}

/// Triangles uva and uvb have a point in common beside uv.
bool fold(const ExactPlace& u, const ExactPlace& v, const ExactPlace& a, const ExactPlace& b) noexcept {
  if (orientation(u, v, a, b) != 0) return false;
  const glm::ivec3 na = across(v - u, a - u), nb = across(v - u, b - u);
  if (na != glm::ivec3(0) && nb != glm::ivec3(0)) return na == nb;
  if (na != nb) return false;  // one is flat, so on the line of uv, where the other is uv alone
  if (u == v) return a != u && across(a - u, b - u) == glm::ivec3(0) && glm::sign(a - u) == glm::sign(b - u);
  // All on one line: both reach beyond the same end.
  const auto beyond = [&](const ExactPlace& end, const ExactPlace& other, const ExactPlace& p) {
    for (int i = 0; i < 3; ++i)
      if (end[i] != other[i]) return end[i] > other[i] ? p[i] > end[i] : p[i] < end[i];
    return false;
  };
  return (beyond(u, v, a) && beyond(u, v, b)) || (beyond(v, u, a) && beyond(v, u, b));
}

}  // namespace

std::vector<ExactPlace> exact_places(std::span<const glm::vec3> points) {
  std::vector<ExactPlace> places(points.size());
  parallel_for(static_cast<std::int64_t>(points.size()), kPlacesGrain, [&](std::int64_t i) {
    places[static_cast<std::size_t>(i)] = exact_place(points[static_cast<std::size_t>(i)]);
  });
  return places;
}

int orientation(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c, const ExactPlace& d) noexcept {
  const ExactPlace u = b - a, v = c - a, w = d - a;
  return is_narrow(u) && is_narrow(v) && is_narrow(w) ? sign_of_volume<std::int64_t>(u, v, w)
                                                      : sign_of_volume<Wide>(u, v, w);
}

bool has_zero_area(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c) noexcept {
  return across(b - a, c - a) == glm::ivec3(0);
}

bool segment_meets_triangle(const ExactPlace& from, const ExactPlace& to, const std::array<ExactPlace, 3>& t) noexcept {
  const int side_from = orientation(t[0], t[1], t[2], from), side_to = orientation(t[0], t[1], t[2], to);
  if (side_from * side_to > 0) return false;
  if (side_from == 0 && side_to == 0) {
    const glm::ivec3 normal = across(t[1] - t[0], t[2] - t[0]);
    if (normal == glm::ivec3(0)) {  // as thin as its sides
      return segments_meet(from, to, t[0], t[1]) || segments_meet(from, to, t[1], t[2]) ||
             segments_meet(from, to, t[2], t[0]);
    }
    const Shadow shadow(axis_of(normal));
    return shadow.inside(t, from) || shadow.segments_meet(from, to, t[0], t[1]) ||
           shadow.segments_meet(from, to, t[1], t[2]) || shadow.segments_meet(from, to, t[2], t[0]);
  }
  const int a = orientation(from, to, t[0], t[1]), b = orientation(from, to, t[1], t[2]),
            c = orientation(from, to, t[2], t[0]);
  return std::min({a, b, c}) >= 0 || std::max({a, b, c}) <= 0;
}

bool triangles_touch(std::span<const ExactPlace> places, const Triangle& a, const Triangle& b) noexcept {
  const auto triangle = [&](const Triangle& t) {
    return ExactTriangle{{places[t[0]], places[t[1]], places[t[2]]}, {t[0], t[1], t[2]}};
  };
  return triangles_touch(triangle(a), triangle(b));
}

bool triangles_touch(const ExactTriangle& a, const ExactTriangle& b) noexcept {
  const std::array<ExactPlace, 3>&pa = a.place, &pb = b.place;
  if (!boxes_meet(pa, pb)) return false;
  std::array<std::size_t, 3> of_a{}, of_b{};  // where the ids stand that they share
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3 && shared < 3; ++j)
      if (a.id[i] == b.id[j]) {
        of_a[shared] = i;
        of_b[shared++] = j;
        break;
      }
  if (shared == 3) return true;
  if (shared == 2) return fold(pa[of_a[0]], pa[of_a[1]], pa[3 - of_a[0] - of_a[1]], pb[3 - of_b[0] - of_b[1]]);
  if (shared == 0) return !on_one_side(pa, pb) && !on_one_side(pb, pa) && any_side_meets(pa, pb);
  // From the common corner a ray through another common point leaves one of them first, across its far side.
  const std::size_t i = of_a[0], j = of_b[0];
  const auto apart = [](const auto& t, const ExactPlace& p, const ExactPlace& q) {
    return orientation(t[0], t[1], t[2], p) * orientation(t[0], t[1], t[2], q) > 0;
  };
  if (apart(pa, pb[(j + 1) % 3], pb[(j + 2) % 3]) || apart(pb, pa[(i + 1) % 3], pa[(i + 2) % 3])) return false;
  return segment_meets_triangle(pa[(i + 1) % 3], pa[(i + 2) % 3], pb) ||
         segment_meets_triangle(pb[(j + 1) % 3], pb[(j + 2) % 3], pa);
}

}  // namespace dubsar
