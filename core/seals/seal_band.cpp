#include "core/seals/seal_band.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

#include "core/base/system/parallel.h"
#include "core/mesh/surface_measure.h"
#include "core/seals/smooth_base.h"

namespace dubsar {
namespace {

constexpr double kNodeMm = 1.0;    // of the sheet: some twelfth of the radius of a rounded edge
constexpr double kReachMm = 2.5;   // of relief: seals are cut half of that
constexpr double kMostMm = 400.0;  // of a strip: twice round the largest envelopes
constexpr double kLeastMm = 2.0;
constexpr double kNamedOffMm = 5.0;  // of a place that a person names: a thick fragment's half is more
constexpr float kUnmeasured = std::numeric_limits<float>::quiet_NaN();

double cubic(double a, double b, double c, double d, double t) {  // Catmull, Rom, 1974
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// A value of the sheet's points between them; s, t in points.
template <class T>
T between(const FlatSheet& sheet, const std::vector<T>& values, double s, double t) {
  const int i = std::clamp(static_cast<int>(std::floor(s)), 0, sheet.columns - 2),
            j = std::clamp(static_cast<int>(std::floor(t)), 0, sheet.rows - 2);
  const double fs = s - i, ft = t - j;
  const auto at = [&](int a, int b) -> const T& {
    return values[sheet.index(std::clamp(a, 0, sheet.columns - 1), std::clamp(b, 0, sheet.rows - 1))];
  };
  const bool edge = fs < 0 || fs > 1 || ft < 0 || ft > 1;
  T out(0.0);
  for (int k = 0; k < T::length(); ++k) {
    if (edge) {
      out[k] = (1 - ft) * ((1 - fs) * at(i, j)[k] + fs * at(i + 1, j)[k]) +
               ft * ((1 - fs) * at(i, j + 1)[k] + fs * at(i + 1, j + 1)[k]);
      continue;
    }
    double row[4];
    for (int b = 0; b < 4; ++b)
      row[b] =
          cubic(at(i - 1, j - 1 + b)[k], at(i, j - 1 + b)[k], at(i + 1, j - 1 + b)[k], at(i + 2, j - 1 + b)[k], fs);
    out[k] = cubic(row[0], row[1], row[2], row[3], ft);
  }
  return out;
}

/// The middle line, a point a node.
Result<std::vector<BasePlace>> middle_line(const SmoothBase& base, const SealStrip& strip,
                                           const glm::dvec3& from_normal, const glm::dvec3& to_normal) {
  const auto start = base.under(strip.from_mm, from_normal), end = base.under(strip.to_mm, to_normal);
  if (!start || !end)
    return fail(ErrorKind::kUsage,
                "too little measured surface around the ends of a strip, ({:.1f}, {:.1f}, {:.1f}) and ({:.1f}, {:.1f}, "
                "{:.1f}) mm, to lay a band on; expected ends with measured surface for some millimetres on all sides",
                strip.from_mm.x, strip.from_mm.y, strip.from_mm.z, strip.to_mm.x, strip.to_mm.y, strip.to_mm.z);
  const glm::dvec3 chord = end->at_mm - start->at_mm;
  glm::dvec3 stands = glm::cross(chord, start->normal + end->normal);
  if (glm::length(stands) < 1e-6 * glm::length(chord)) stands = glm::cross(chord, start->normal);
  stands = glm::normalize(stands);  // of the plane
  std::vector<BasePlace> line{*start};
  double nearest = glm::length(chord);
  glm::dvec3 ahead = glm::normalize(chord - start->normal * glm::dot(chord, start->normal));
  while (static_cast<double>(line.size()) * kNodeMm < kMostMm) {
    const BasePlace& last = line.back();
    glm::dvec3 along = glm::cross(stands, last.normal);
    along = glm::normalize(glm::dot(along, ahead) < 0 ? -along : along);
    glm::dvec3 next = last.at_mm + kNodeMm * along;
    next -= stands * glm::dot(next - start->at_mm, stands);
    const auto place = base.under(next, last.normal);
    if (!place) break;
    const double left = glm::distance(place->at_mm, end->at_mm);
    if (left > nearest && nearest < 2.0 * kNodeMm) break;
    ahead = along;
    nearest = std::min(nearest, left);
    line.push_back(*place);
  }
  if (nearest >= 2.0 * kNodeMm)
    return fail(ErrorKind::kUsage,
                "the surface does not lead from one end of the strip to the other; {:.1f} mm are left", nearest);
  return line;
}

/// Where sheets of different radius meet there are steps.
void even_out(FlatSheet& sheet) {
  constexpr int kEvenRounds = 3;
  for (int round = 0; round < kEvenRounds; ++round) {
    const std::vector<glm::dvec3> before = sheet.base_mm;
    for (int j = 0; j < sheet.rows; ++j)
      for (int i = 0; i < sheet.columns; ++i) {
        glm::dvec3 mean(0.0);
        for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          const bool inside = i + a >= 0 && j + b >= 0 && i + a < sheet.columns && j + b < sheet.rows && i - a >= 0 &&
                              j - b >= 0 && i - a < sheet.columns && j - b < sheet.rows;
          mean += 0.25 * (inside ? before[sheet.index(i + a, j + b)] : before[sheet.index(i, j)]);
        }
        const std::size_t at = sheet.index(i, j);
        sheet.base_mm[at] += 0.5 * sheet.normal[at] * glm::dot(mean - before[at], sheet.normal[at]);
      }
  }
}

/// Lines to both sides of the middle line, straight on the surface.
FlatSheet sheet_of(const SmoothBase& base, const std::vector<BasePlace>& line, double height_mm) {
  FlatSheet sheet;
  sheet.columns = static_cast<int>(line.size());
  const int half = std::max(1, static_cast<int>(std::ceil(0.5 * height_mm / kNodeMm)));
  sheet.rows = 2 * half + 1;
  const std::size_t count = static_cast<std::size_t>(sheet.columns) * static_cast<std::size_t>(sheet.rows);
  sheet.base_mm.resize(count);
  sheet.normal.resize(count);
  sheet.flat_mm.resize(count);
  parallel_for(sheet.columns, 1, [&](std::int64_t column) {
    const auto i = static_cast<int>(column);
    const glm::dvec3 before = line[static_cast<std::size_t>(std::max(i - 1, 0))].at_mm,
                     after = line[static_cast<std::size_t>(std::min(i + 1, sheet.columns - 1))].at_mm;
    for (const int side : {1, -1}) {
      BasePlace place = line[static_cast<std::size_t>(i)];
      glm::dvec3 away = static_cast<double>(side) * glm::cross(place.normal, after - before);
      for (int j = 0; j <= half; ++j) {
        const std::size_t at = sheet.index(i, half + side * j);
        sheet.base_mm[at] = place.at_mm;
        sheet.normal[at] = place.normal;
        sheet.flat_mm[at] = {i * kNodeMm, (half + side * j) * kNodeMm};
        away = glm::normalize(away - place.normal * glm::dot(away, place.normal));
        const glm::dvec3 next = place.at_mm + kNodeMm * away;
        place = base.under(next, place.normal).value_or(BasePlace{next, place.normal});
      }
    }
  });
  even_out(sheet);
  return sheet;
}

struct OnSheet {
  double s = 0.0, t = 0.0, height = 0.0;
  bool there = false;
};

/// The place of the sheet on whose normal a point lies.
OnSheet on_sheet(const FlatSheet& sheet, const glm::dvec3& p) {
  OnSheet out;
  double best = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < sheet.base_mm.size(); ++k) {
    const glm::dvec3 d = p - sheet.base_mm[k];
    if (const double d2 = glm::dot(d, d); d2 < best) {
      best = d2;
      out.s = static_cast<double>(k % static_cast<std::size_t>(sheet.columns));
      out.t = static_cast<double>(k / static_cast<std::size_t>(sheet.columns));
    }
  }
  if (best > (kReachMm + kNodeMm) * (kReachMm + kNodeMm)) return out;
  for (int round = 0; round < 4; ++round) {
    constexpr double kStep = 0.25;
    const glm::dvec3 d = p - between(sheet, sheet.base_mm, out.s, out.t),
                     n = glm::normalize(between(sheet, sheet.normal, out.s, out.t));
    glm::dvec3 ds = (between(sheet, sheet.base_mm, out.s + kStep, out.t) -
                     between(sheet, sheet.base_mm, out.s - kStep, out.t)) /
                    (2 * kStep),
               dt = (between(sheet, sheet.base_mm, out.s, out.t + kStep) -
                     between(sheet, sheet.base_mm, out.s, out.t - kStep)) /
                    (2 * kStep);
    ds -= n * glm::dot(ds, n);
    dt -= n * glm::dot(dt, n);
    const double a = glm::dot(ds, ds), b = glm::dot(ds, dt), c = glm::dot(dt, dt), x = glm::dot(d, ds),
                 y = glm::dot(d, dt), det = a * c - b * b;
    if (!(det > 1e-9)) return out;
    out.s += std::clamp((c * x - b * y) / det, -2.0, 2.0);
    out.t += std::clamp((a * y - b * x) / det, -2.0, 2.0);
    out.height = glm::dot(d, n);
  }
  constexpr double kBeside = 0.75;  // points: triangles over the rim
  out.there = out.s > -kBeside && out.t > -kBeside && out.s < sheet.columns - 1 + kBeside &&
              out.t < sheet.rows - 1 + kBeside && std::abs(out.height) < kReachMm;
  return out;
}

double usual_edge(const std::vector<glm::dvec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<double> edges;
  const std::size_t stride = triangles.size() / 4096 + 1;
  for (std::size_t t = 0; t < triangles.size(); t += stride)
    edges.push_back(glm::distance(points[triangles[t][0]], points[triangles[t][1]]));
  if (edges.empty()) return 0.1;
  std::nth_element(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2), edges.end());
  return edges[edges.size() / 2];
}

/// The raster from 0, 0 to the sheet's far corner.
HeightMap relief_of(const FlatSheet& sheet, const std::vector<glm::dvec3>& points,
                    const std::vector<Triangle>& triangles, double step_mm) {
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const glm::dvec3& p : sheet.base_mm) {
    low = glm::min(low, p - (kReachMm + kNodeMm));
    high = glm::max(high, p + (kReachMm + kNodeMm));
  }
  std::vector<OnSheet> places(points.size());
  parallel_for(static_cast<std::int64_t>(points.size()), 256, [&](std::int64_t v) {
    const glm::dvec3& p = points[static_cast<std::size_t>(v)];
    if (glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high)))
      places[static_cast<std::size_t>(v)] = on_sheet(sheet, p);
  });
  glm::dvec2 far(0.0);
  for (const glm::dvec2& p : sheet.flat_mm) far = glm::max(far, p);
  std::vector<glm::dvec3> laid(points.size(), glm::dvec3(0.0));
  std::vector<Triangle> kept;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (places[v].there)
      laid[v] = glm::dvec3(between(sheet, sheet.flat_mm, places[v].s, places[v].t), places[v].height);
  for (const Triangle& t : triangles) {
    if (!places[t[0]].there || !places[t[1]].there || !places[t[2]].there) continue;
    const std::size_t at = sheet.index(std::clamp(static_cast<int>(std::lround(places[t[0]].s)), 0, sheet.columns - 1),
                                       std::clamp(static_cast<int>(std::lround(places[t[0]].t)), 0, sheet.rows - 1));
    if (glm::dot(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]), sheet.normal[at]) > 0.0)
      kept.push_back(t);
  }
  // A triangle of no area pins the first place of the map some whole steps before the sheet's corner.
  const int margin = static_cast<int>(std::ceil(2.0 / step_mm));
  const auto pin = static_cast<std::uint32_t>(laid.size());
  laid.emplace_back(-margin * step_mm, -margin * step_mm, 0.0);
  laid.emplace_back(far + 2.0, 0.0);
  kept.push_back({pin, pin, pin + 1});
  const HeightMap all = height_map(laid, kept, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, step_mm);
  HeightMap out;
  out.step_mm = step_mm;
  out.width = static_cast<int>(far.x / step_mm) + 1;
  out.height = static_cast<int>(far.y / step_mm) + 1;
  out.mm.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), kUnmeasured);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      if (x + margin < all.width && y + margin < all.height) out.mm[out.index(x, y)] = all.at(x + margin, y + margin);
  return out;
}

}  // namespace

std::optional<glm::dvec3> UnrolledBand::surface_mm(const glm::dvec2& flat_mm) const {
  double s = flat_mm.x / kNodeMm, t = flat_mm.y / kNodeMm;
  for (int round = 0; round < 8; ++round) {
    constexpr double kStep = 0.25;
    const glm::dvec2 off = flat_mm - between(sheet, sheet.flat_mm, s, t),
                     ds = (between(sheet, sheet.flat_mm, s + kStep, t) - between(sheet, sheet.flat_mm, s - kStep, t)) /
                          (2 * kStep),
                     dt = (between(sheet, sheet.flat_mm, s, t + kStep) - between(sheet, sheet.flat_mm, s, t - kStep)) /
                          (2 * kStep);
    const double det = ds.x * dt.y - ds.y * dt.x;
    if (!(std::abs(det) > 1e-9)) return {};
    s += (off.x * dt.y - off.y * dt.x) / det;
    t += (ds.x * off.y - ds.y * off.x) / det;
  }
  if (!(s >= 0.0 && t >= 0.0 && s <= sheet.columns - 1 && t <= sheet.rows - 1)) return {};
  return between(sheet, sheet.base_mm, s, t);
}

Result<UnrolledBand> unroll(const TriMesh& mesh, const SealStrip& strip, const UnrollOptions& options) {
  if (!(glm::distance(strip.from_mm, strip.to_mm) >= kLeastMm) || !(strip.height_mm >= kLeastMm) ||
      strip.height_mm > kMostMm)
    return fail(ErrorKind::kUsage,
                "a strip from ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}) mm, {:.1f} mm high, found; expected "
                "ends at least {:g} mm apart and a height of {:g} to {:g} mm",
                strip.from_mm.x, strip.from_mm.y, strip.from_mm.z, strip.to_mm.x, strip.to_mm.y, strip.to_mm.z,
                strip.height_mm, kLeastMm, kLeastMm, kMostMm);
  std::vector<glm::dvec3> points(mesh.positions.size());
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
  std::vector<Triangle> measured;
  measured.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.triangle_inferred.empty() || mesh.triangle_inferred[t] == 0) measured.push_back(mesh.triangles[t]);
  DUBSAR_ASSIGN(const SurfacePlace from, nearest_place(mesh, strip.from_mm));
  DUBSAR_ASSIGN(const SurfacePlace to, nearest_place(mesh, strip.to_mm));
  for (const auto& [named, on] : {std::pair{strip.from_mm, from.at_mm}, {strip.to_mm, to.at_mm}})
    if (const double off = glm::distance(named, on); !(off <= kNamedOffMm))
      return fail(
          ErrorKind::kUsage,
          "an end of a strip at ({:.1f}, {:.1f}, {:.1f}) mm found, {:.1f} mm from the surface; expected a place "
          "on it, at most {:g} mm off, in mm of the scan, as the window shows it",
          named.x, named.y, named.z, off, kNamedOffMm);
  const SmoothBase base(points, measured, options.base_radius_mm);
  DUBSAR_ASSIGN(const std::vector<BasePlace> line,
                middle_line(base, {from.at_mm, to.at_mm, strip.height_mm}, from.normal, to.normal));
  UnrolledBand out;
  out.sheet = sheet_of(base, line, strip.height_mm);
  lay_flat(out.sheet);
  out.distortion = distortion_of(out.sheet);
  constexpr double kFinestMm = 0.05, kCoarsestMm = 0.25;  // limbs of figures are some .4 mm broad and more
  const double step =
      options.step_mm > 0.0 ? options.step_mm : std::clamp(0.5 * usual_edge(points, measured), kFinestMm, kCoarsestMm);
  out.relief = relief_of(out.sheet, points, measured, step);
  return out;
}

}  // namespace dubsar
