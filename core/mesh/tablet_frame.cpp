#include "core/mesh/tablet_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/mesh/writing/body_axes.h"
#include "core/mesh/writing/side_rise.h"
#include "core/mesh/writing/tail_directions.h"

namespace dubsar {
namespace {

constexpr std::int64_t kFrameGrain = 1 << 16;
constexpr std::uint32_t kUnused = 0xffffffffu;
constexpr double kSteps = 800.0;      // of the finest map over the root of a broad side's area: wedges of a hundredth
constexpr int kSizes = 4;             // of wedges, each twice the one before: up to an eighth
constexpr double kMirrored = 0.02;    // of surfaces: programs that exchange axes, or read the wrong handedness
constexpr double kLevel = 0.002;      // of that root: what makes no side flat or curved
constexpr double kSparse = 0.5;       // of the writing elsewhere: less is room left
constexpr double kLeastMarks = 20.0;  // of a broad side, to say where there are none
constexpr double kNoWord = 0.3;       // of the way up: not more than chance, and a little
constexpr double kFewestEdges = 0.7;  // over a wedge: triangles that are larger show no wedges of that size

// What the shape says of the obverse, as logarithms of likelihood ratios. Phantoms are shaped as tablets are said to
// be, so it is never believed more than 19 to 1.
constexpr double kFlatter = 14.0, kRoomLeft = 2.5;
const double kMostOfShape = std::log(19.0);

/// The six sides: two for each axis of the body, the one that it looks along first.
struct SideId {
  std::size_t axis = 0, sign = 0;
};

/// One side as it is seen with the next axis of the body to the right; of each size of wedges.
struct SideFinds {
  std::array<TextTurns, kSizes> turns;
  std::array<std::vector<FoundWedge>, kSizes> impressions;
  double rise = 0.0;  // of the root of a broad side's area
};

/// How texts stand on a side, as shares of tablets: as the scribe turned it, upside down, and a quarter either way.
using Ways = std::array<double, 4>;               // by quarters of a turn from what is expected
constexpr Ways kObverse{1.0, 0.0, 0.0, 0.0};      // what is meant by it
constexpr Ways kReverse{0.90, 0.01, 0.08, 0.01};  // some are turned as the leaf of a book
constexpr Ways kAcross{0.85, 0.04, 0.07, 0.04};   // lower and upper edge
constexpr Ways kRightEdge{0.60, 0.10, 0.20, 0.10};
constexpr Ways kLeftEdge{0.45, 0.10, 0.35, 0.10};

double log_of_sum(std::span<const double> logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  if (most == -std::numeric_limits<double>::infinity()) return most;
  double sum = 0.0;
  for (const double l : logs) sum += std::exp(l - most);
  return most + std::log(sum);
}

double mean_edge(std::span<const glm::dvec3> points, std::span<const Triangle> triangles) {
  const double sum = parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), kFrameGrain, 0.0,
      [&](std::int64_t begin, std::int64_t end) {
        double part = 0.0;
        for (std::int64_t i = begin; i < end; ++i) {
          const Triangle& t = triangles[static_cast<std::size_t>(i)];
          part += glm::distance(points[t[0]], points[t[1]]) + glm::distance(points[t[1]], points[t[2]]) +
                  glm::distance(points[t[2]], points[t[0]]);
        }
        return part;
      },
      std::plus<>());
  return triangles.empty() ? 0.0 : sum / (3.0 * static_cast<double>(triangles.size()));
}

/// What the sides of a body say.
class Writing {
 public:
  Writing(std::span<const glm::dvec3> points, std::span<const Triangle> triangles, const BodyAxes& body) : body_(body) {
    const double root = std::sqrt(body.extent[1] * body.extent[2]), edge = mean_edge(points, triangles);
    const double longest = std::max({body.extent[0], body.extent[1], body.extent[2]});
    const double step = std::max(root, 0.25 * longest) / kSteps;  // a spike makes no map of a million steps
    parallel_for(6, 1, [&](std::int64_t side) {
      const SideId id{static_cast<std::size_t>(side / 2), static_cast<std::size_t>(side % 2)};
      const SideAxes seen = axes_of(id);
      SideFinds& finds = sides_[id.axis][id.sign];
      HeightMap map = height_map(points, triangles, seen, step);
      if (id.axis == 0 && root > 0.0) finds.rise = side_rise_mm(map) / root;
      for (std::size_t size = 0; size < kSizes; ++size) {
        if (size > 0) map = halved(map);
        if (map.step_mm * kStepsPerWedge < kFewestEdges * edge) continue;
        finds.impressions[size] = find_impressions(map);
        finds.turns[size] = text_turns(finds.impressions[size]);
      }
    });
  }

  /// Log likelihood ratio against chance of a tablet that lies as in `f`, by the size of its wedges.
  std::array<double, kSizes> ratios(const TabletFrame& f, bool mirrored) const {
    struct Expected {
      glm::dvec3 front, up;
      const Ways& ways;
    };
    const glm::dvec3 written_on_right = mirrored ? -f.right : f.right;
    const std::array<Expected, 6> sides{{{f.front, f.up, kObverse},
                                         {-f.front, -f.up, kReverse},
                                         {-f.up, f.front, kAcross},
                                         {f.up, -f.front, kAcross},
                                         {written_on_right, f.up, kRightEdge},
                                         {-written_on_right, f.front, kLeftEdge}}};
    std::array<double, kSizes> out{};
    for (const Expected& side : sides) {
      const SideId id = nearest(side.front);
      const int expected = quarters(id, glm::cross(side.up, side.front));
      for (std::size_t size = 0; size < kSizes; ++size) {
        const TextTurns& turns = sides_[id.axis][id.sign].turns[size];
        std::array<double, 4> logs{};
        for (std::size_t way = 0; way < 4; ++way)
          logs[way] = std::log(side.ways[way]) +
                      (mirrored ? turns.mirrored : turns.written)[(static_cast<std::size_t>(expected) + way) % 4];
        out[size] += log_of_sum(logs);
      }
    }
    return out;
  }

  /// Log of the odds that `f.front` is the obverse and not the other broad side, by their shape: wet clay is laid on
  /// the obverse when the reverse is written (J. Taylor: Tablets as artefacts, scribes as artisans, 2011), so it is the
  /// flatter one; and the text begins on it, so that the side with room left at its end is the reverse.
  double obverse_by_shape(const TabletFrame& f, std::size_t size) const {
    const SideFinds &front = of(f.front), &back = of(-f.front);
    const double flatter = (back.rise - front.rise) / (std::abs(back.rise) + std::abs(front.rise) + kLevel);
    const double most = std::max(written(f.front, f.up, 0.1, 0.9, size), written(-f.front, -f.up, 0.1, 0.9, size));
    double room = 0.0;
    if (most >= kLeastMarks) {
      const double usual = kSparse * most * 0.25;  // as much as a quarter of the other side has
      const auto room_left = [&](const glm::dvec3& side, const glm::dvec3& up) {
        return std::max(0.0, 1.0 - written(side, up, 0.1, 0.3, size) / usual);
      };
      room = room_left(-f.front, -f.up) - room_left(f.front, f.up);
    }
    return std::clamp(kFlatter * flatter + kRoomLeft * room, -kMostOfShape, kMostOfShape);
  }

 private:
  SideAxes axes_of(const SideId& id) const {
    const glm::dvec3 front = (id.sign == 0 ? 1.0 : -1.0) * body_.axes[static_cast<int>(id.axis)];
    const glm::dvec3 right = body_.axes[static_cast<int>((id.axis + 1) % 3)];
    return {right, glm::cross(front, right), front};
  }
  SideId nearest(const glm::dvec3& v) const {
    std::size_t best = 0;
    const auto along = [&](std::size_t axis) { return glm::dot(v, body_.axes[static_cast<int>(axis)]); };
    for (std::size_t k = 1; k < 3; ++k)
      if (std::abs(along(k)) > std::abs(along(best))) best = k;
    return {best, along(best) < 0 ? std::size_t{1} : std::size_t{0}};
  }
  const SideFinds& of(const glm::dvec3& front) const {
    const SideId id = nearest(front);
    return sides_[id.axis][id.sign];
  }
  /// How many quarters of a turn a direction lies counterclockwise from the right of a side's map.
  int quarters(const SideId& id, const glm::dvec3& direction) const {
    const SideAxes seen = axes_of(id);
    const double right = glm::dot(direction, seen.right), up = glm::dot(direction, seen.up);
    if (std::abs(right) > std::abs(up)) return right > 0 ? 0 : 2;
    return up > 0 ? 1 : 3;
  }
  /// How many impressions a side has between two shares of its height.
  double written(const glm::dvec3& front, const glm::dvec3& up, double from, double to, std::size_t size) const {
    const SideId id = nearest(front);
    const int right_at = quarters(id, glm::cross(up, front));
    double count = 0.0;
    for (const FoundWedge& i : sides_[id.axis][id.sign].impressions[size]) {
      const std::array<float, 4> height{i.y, 1.f - i.x, 1.f - i.y, i.x};  // along the up of text that is turned so far
      const auto h = static_cast<double>(height[static_cast<std::size_t>(right_at)]);
      count += h >= from && h <= to ? 1.0 : 0.0;
    }
    return count;
  }

  BodyAxes body_;
  std::array<std::array<SideFinds, 2>, 3> sides_;
};

/// Those of the tablet where the mesh says which they are, else all; without those that fill holes: nobody wrote there,
/// and their rims are steps.
std::vector<Triangle> written_triangles(const TriMesh& mesh) {
  const Partition* const tablet =
      mesh.triangle_partition.empty() ? nullptr : mesh.partitions.find(PartitionKind::kTablet);
  if (tablet == nullptr && mesh.triangle_inferred.empty()) return mesh.triangles;
  const auto is_written = [&](std::size_t t) {
    return (mesh.triangle_inferred.empty() || !mesh.triangle_inferred[t]) &&
           (tablet == nullptr || mesh.triangle_partition[t] == tablet->id);
  };
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) count += is_written(t) ? 1 : 0;
  std::vector<Triangle> out;
  out.reserve(count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_written(t)) out.push_back(mesh.triangles[t]);
  return out;
}

/// Vertices in mm: those of `triangles`, which get their numbers among these, or all where there are none.
std::vector<glm::dvec3> points_of(const TriMesh& mesh, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> number(triangles.empty() ? 0 : mesh.positions.size(), 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) number[v] = 1;
  std::uint32_t count = 0;
  for (std::uint32_t& used : number) used = used != 0 ? count++ : kUnused;
  std::vector<glm::dvec3> points(number.empty() ? mesh.positions.size() : count);
  parallel_for(static_cast<std::int64_t>(mesh.positions.size()), kFrameGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    const std::size_t to = number.empty() ? v : number[v];
    if (to < points.size()) points[to] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
  });
  parallel_for(static_cast<std::int64_t>(triangles.size()), kFrameGrain, [&](std::int64_t t) {
    for (std::uint32_t& v : triangles[static_cast<std::size_t>(t)]) v = number[v];
  });
  return points;
}

/// One of the ways that a tablet may lie, with what speaks for it.
struct Lie {
  TabletFrame frame;
  bool mirrored = false;
  double log = 0.0;
};

std::vector<Lie> all_lies(const Writing& writing, const BodyAxes& body) {
  std::vector<Lie> out;
  for (const bool mirrored : {false, true})
    for (const double side : {1.0, -1.0})
      for (const glm::dvec3& right : {body.axes[1], -body.axes[1], body.axes[2], -body.axes[2]}) {
        const glm::dvec3 front = side * body.axes[0];
        Lie lie{{right, glm::cross(front, right), front}, mirrored};
        std::array<double, kSizes> sizes = writing.ratios(lie.frame, mirrored);
        for (std::size_t size = 0; size < kSizes; ++size) {
          const double by_shape = writing.obverse_by_shape(lie.frame, size);
          sizes[size] -= std::log1p(std::exp(-by_shape));
        }
        lie.log = std::log(mirrored ? kMirrored : 1.0 - kMirrored) + log_of_sum(sizes);
        out.push_back(lie);
      }
  return out;
}

}  // namespace

glm::dmat3 TabletFrame::tablet_from_model() const { return glm::transpose(glm::dmat3(right, up, front)); }

std::string TabletFrame::doubt() const {
  if (mirrored_probability >= 0.5)
    return fmt::format("it looks like a mirror image (probability {:.2f})", mirrored_probability);
  if (up_probability < kNoWord) return "no writing was found that says which way is up";
  if (up_probability < kSureOfTheWay)
    return fmt::format("not sure which way is up (probability {:.2f})", up_probability);
  if (obverse_probability < kSureOfTheWay)
    return fmt::format("not sure which side is the obverse (probability {:.2f})", obverse_probability);
  return {};
}

Result<TabletFrame> find_tablet_frame(const TriMesh& mesh) {
  std::vector<Triangle> written = written_triangles(mesh);
  const std::vector<glm::dvec3> points = points_of(mesh, written);
  DUBSAR_ASSIGN(const BodyAxes body, body_axes(points, written.empty() ? mesh.triangles : written));
  std::vector<Lie> lies = all_lies(Writing(points, written, body), body);
  double most = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (const Lie& lie : lies) most = std::max(most, lie.log);
  for (Lie& lie : lies) sum += lie.log = std::exp(lie.log - most);
  for (Lie& lie : lies) lie.log /= sum;  // a probability from here on

  const auto along = [](const Lie& lie, const glm::dvec3& right) {
    return !lie.mirrored && glm::dot(lie.frame.right, right) > 0.5;
  };
  double up = -1.0, front = -1.0;
  TabletFrame best;
  for (const Lie& lie : lies) {
    if (lie.mirrored) continue;
    double both = 0.0;
    for (const Lie& other : lies) both += along(other, lie.frame.right) ? other.log : 0.0;
    if (both > up * (1.0 + 1e-9)) {
      up = both;
      front = -1.0;
    }
    if (both >= up * (1.0 - 1e-9) && lie.log > front * (1.0 + 1e-9)) {
      front = lie.log;
      best = lie.frame;
    }
  }
  best.up_probability = up;
  best.obverse_probability = up > 0.0 ? front / up : 0.5;
  best.mirrored_probability = 0.0;
  for (const Lie& lie : lies) best.mirrored_probability += lie.mirrored ? lie.log : 0.0;
  return best;
}

TabletFrame turned(const TabletFrame& f, FrameTurn turn) {
  TabletFrame out = f;
  switch (turn) {
    case FrameTurn::kNone:
      break;
    case FrameTurn::kHalf:
      out.right = -f.right, out.up = -f.up;
      break;
    case FrameTurn::kLeft:  // the picture turns to the left: what was up points left
      out.right = -f.up, out.up = f.right;
      break;
    case FrameTurn::kRight:
      out.right = f.up, out.up = -f.right;
      break;
    case FrameTurn::kOver:
      out.up = -f.up, out.front = -f.front;
      break;
  }
  return out;
}

TriMesh in_tablet_frame(TriMesh out, const TabletFrame& frame) {
  const GridFrame scanned = out.frame;
  const glm::dmat3 turn = frame.tablet_from_model();
  const glm::dvec3 step = scanned.grid_voxel_mm();
  for (glm::vec3& p : out.positions) p = glm::vec3(turn * scanned.mm_from_grid(glm::dvec3(p)));
  for (glm::vec3& n : out.normals)  // of an uneven grid: normals go with the inverse steps
    n = glm::vec3(glm::normalize(turn * (glm::dvec3(n) / step)));
  out.frame = GridFrame{};
  out.frame.input_voxel.mm = glm::dvec3(1.0);
  out.frame.input_voxel.provenance = scanned.input_voxel.provenance;
  return out;
}

}  // namespace dubsar
