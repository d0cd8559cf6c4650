#include "core/phantom/phantom.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar::phantom {
namespace {

constexpr float kFar = 1e4f;
constexpr float kProjectionReach = 8.0f;  ///< kReach times the steepest slope

float length(Float4 v) { return std::sqrt(dot(v, v)); }
Dual far_away() { return {kFar, Float4{}}; }
float metric(const Dual& d) { return d.v / std::max(length(d.g), 0.2f); }

}  // namespace

Phantom::Phantom(const PhantomOptions& options) : options_(options), grid_(options.dims) {}

Dual Phantom::impressions(const std::vector<Impression>& all, std::span<const std::uint32_t> ids, const Point& point,
                          const Dual& depth) const {
  Dual hollow = far_away();
  for (const std::uint32_t id : ids) {
    const Impression& impression = all[id];
    const Float4 d = point.p - impression.middle;
    if (dot(d, d) >= impression.radius2) continue;
    const Dual later = impression.field.evaluate(point, depth);
    const float reach = impression.field.nominal();
    if (options_.writing.pushed > 0.0 && hollow.v < kFar && later.v < reach) {  // it pushes clay into those before it
      const float t = 1.0f - std::max(later.v, 0.0f) / reach,
                  most = static_cast<float>(options_.writing.pushed) * reach;
      hollow = hollow + Dual{most * t * t, later.v > 0.0f ? later.g * (-2.0f * most * t / reach) : Float4{}};
    }
    hollow = smooth_min(hollow, later, edges_.rim_rounding);
  }
  return hollow;
}

Dual Phantom::carve(const Dual& body, const Dual& decor, const Dual& hollow) const {
  Dual surface = body + decor;
  if (hollow.v < edges_.lip_width) {  // the stylus pushes up a low lip around the impression
    const float t = 1.0f - std::max(hollow.v, 0.0f) / edges_.lip_width;
    surface =
        surface - Dual{edges_.lip_height * t * t,
                       hollow.v > 0.0f ? hollow.g * (-2.0f * edges_.lip_height * t / edges_.lip_width) : Float4{}};
  }
  return smooth_max(surface, -hollow, edges_.rim_rounding);
}

Dual ClayGap::width(const Point& point) const {
  const Dual q = (glue.evaluate(point) - threshold) * (-1.0f / ramp);  // < 0: glued
  Dual gap;
  if (q.v >= 1.0f) {
    gap = {open, Float4{}};
  } else if (q.v >= 0.0f) {
    const float t = 1.0f - q.v;
    gap = {open * (1.0f - t * t * t), q.g * (3.0f * open * t * t)};
  } else {
    const float t = std::max(1.0f + q.v, 0.0f);
    gap = {-overlap * (1.0f - t * t * t), q.g * (3.0f * overlap * t * t)};
  }
  if (gap.v > 0.0f) {
    gap = gap * (variation.evaluate(point) + 1.0f);
    for (const auto& touch : touches)
      gap = gap * (Dual{1.0f, Float4{}} - bump(point.distance2(touch.centre), touch.radius2) * touch.depth);
  }
  return film > 0.0f ? max(gap, Dual{film, Float4{}}) : gap;
}

/// Of the gap over or under a point: it belongs to the place on the tablet before it was written on. If it differed
/// with the depth, clay of the envelope would lie loose in the wedges.
Dual Phantom::gap_at(const Point& point, const Dual& base) const {
  const float slope2 = dot(base.g, base.g);
  Point foot = point;
  foot.p -= base.g * (base.v / slope2);
  Dual width = gap_.width(foot);
  width.g -= base.g * (dot(width.g, base.g) / slope2);
  return width;
}

Fields Phantom::fields(float x, float y, float z, float reach) const {
  const Point point = place_.point(x, y, z);
  const std::int64_t cell = grid_.index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  Fields f;
  f.pore = f.organic = f.grain = f.crack = far_away();

  const float outer_range = outer_.relief + reach;
  Dual decor;
  const Dual outer_base = outer_.body.evaluate(point, &decor, outer_range);
  if (outer_base.v > outer_range) {
    f.outer = f.clay = outer_base - outer_.relief;
    f.tablet = far_away();
    f.wall = -f.tablet;
    f.tablet_base = kFar;
    return f;
  }
  if (outer_base.v < -outer_range)
    f.outer = outer_base + outer_.relief;
  else
    f.outer = carve(outer_base, decor, impressions(outer_.wedges, outer_.cells[cell], point, -outer_base));

  const float range = tablet_.relief + reach;
  Dual joint = far_away();
  const Dual base = tablet_.body.evaluate(point, &decor, range);
  f.tablet_base = base.v;
  if (base.v > range) {  // in the shell
    f.tablet = base - tablet_.relief;
    f.wall = -f.tablet;
  } else if (base.v < -range) {
    f.tablet = base + tablet_.relief;
    f.wall = -f.tablet;
  } else {
    const Dual hollow = impressions(tablet_.wedges, tablet_.cells[cell], point, -base);
    f.tablet = carve(base, decor, hollow);
    // The envelope was pressed on: its inner wall follows the tablet at the gap's width and sinks into the wedges.
    const Dual followed = options_.contact == Contact::kPressed
                              ? smooth_max(base, -(hollow + edges_.hint), 2.0f * edges_.rim_rounding)
                          : options_.contact == Contact::kPockets ? base
                                                                  : f.tablet;
    const Dual width = gap_at(point, base);
    f.wall = width - followed;
    // Where both are one, neither's surface exists: the way out leads along the joint to where the gap opens.
    joint = max(width, smooth_abs(base + 0.5f * gap_.overlap, 1.0f) - 2.0f * gap_.overlap);
  }
  Dual envelope = max(f.outer, f.wall);
  if (crack_.radius2 > 0.0f) {
    const Dual d2 = point.distance2(crack_.centre);
    if (d2.v < crack_.radius2) {
      const Dual sheet = point.along(crack_.centre, crack_.normal) + crack_.bend.evaluate(point);
      f.crack = smooth_abs(sheet, 0.3f) - bump(d2, crack_.radius2) * crack_.half_width;
      envelope = max(envelope, -f.crack);
    }
  }
  f.clay = options_.contact == Contact::kFilm ? min(f.tablet, envelope)
                                              : min(smooth_min(f.tablet, envelope, edges_.join_rounding), joint);
  for (const std::uint32_t id : pores_.cells[cell]) {
    const Pore& pore = pores_.all[id];
    Dual r2;
    for (const Float4 axis : pore.axis) {
      const Dual c = point.along(pore.centre, axis);
      r2 = r2 + c * c;
    }
    f.pore = min(f.pore, (sqrt(r2) - 1.0f) * pore.smallest);
  }
  for (const std::uint32_t id : straws_.cells[cell]) {
    const Straw& straw = straws_.all[id];
    const Float4 d = straw.b - straw.a;
    const float t = std::clamp(dot(point.p - straw.a, d) / dot(d, d), 0.0f, 1.0f);
    f.organic = min(f.organic, sqrt(point.distance2(straw.a + d * t)) - straw.radius);
  }
  for (const std::uint32_t id : grains_.cells[cell])
    f.grain = min(f.grain, sqrt(point.distance2(grains_.all[id].centre)) - grains_.all[id].radius);
  f.clay = max(max(f.clay, -f.pore), -f.organic);
  return f;
}

// Closest point on the zero of a field: Newton steps along the gradient bring the foot to the surface, tangential
// steps bring it under the point (Hartmann 1999, foot points on implicit surfaces).
template <class Field>
double Phantom::project(const glm::dvec3& point, const Field& field) const {
  const auto at = [&](Float4 p) { return field(p[0], p[1], p[2]); };
  const Float4 start{static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z), 0.0f};
  const auto to_grid = [&](Float4 g) {
    return Float4{dot(place_.axis_x, g), dot(place_.axis_y, g), dot(place_.axis_z, g), 0.0f};
  };
  Dual f = at(start);
  const float first_order = metric(f);
  if (std::abs(first_order) > 2.5f) return std::clamp(static_cast<double>(first_order), -kReach, kReach);
  Float4 foot = start, last_slide{};
  float relax = 0.8f, best = kFar;
  for (int i = 0; i < 24; ++i) {
    const float slope = std::max(length(f.g), 0.2f);
    const Float4 normal = to_grid(f.g) * (1.0f / slope);
    const Float4 aside = start - foot;
    const Float4 slide = aside - normal * dot(aside, normal);
    const float error = std::abs(f.v / slope), slid = length(slide);
    if (error < 0.02f) best = std::min(best, length(aside) + error);
    if (i > 0 && error < 2e-3f && slid < 2e-2f) break;
    // Across an edge the slide turns back: halving it ends on the edge.
    if (i > 1 && dot(slide, last_slide) < 0.0f) relax *= 0.5f;
    last_slide = slide;
    foot = foot - normal * (f.v / slope) + slide * std::min(relax, 1.0f / std::max(slid, 1e-6f));
    f = at(foot);
  }
  const float distance = best < kFar ? best : std::abs(first_order);
  return std::copysign(std::min(static_cast<double>(distance), kReach), first_order);
}

double Phantom::signed_distance(const glm::dvec3& point) const {
  return project(point, [this](float x, float y, float z) { return fields(x, y, z, kProjectionReach).clay; });
}
double Phantom::tablet_distance(const glm::dvec3& point) const {
  return project(point, [this](float x, float y, float z) { return fields(x, y, z, kProjectionReach).tablet; });
}

Label label_of(const Fields& f) {
  if (f.pore.v < 0.0f) return Label::kPore;
  if (f.organic.v < 0.0f) return Label::kOrganic;
  const bool tablet = f.tablet.v < 0.0f;
  const bool envelope = std::max({f.outer.v, f.wall.v, -f.crack.v}) < 0.0f;
  if (tablet) return envelope ? Label::kGlue : Label::kTablet;
  if (envelope) return Label::kEnvelope;
  if (f.clay.v < 0.0f) return Label::kGlue;
  return f.outer.v > 0.0f ? Label::kOutside : Label::kGap;
}

Label Phantom::label(const glm::dvec3& p) const {
  return label_of(fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)));
}

bool Phantom::overlap(std::size_t first, std::size_t second) const {
  if (wedges_[first].owner != wedges_[second].owner || glm::dot(wedges_[first].outward, wedges_[second].outward) < 0.7)
    return false;  // fields of imprints go on below their own surface
  const auto field_of = [&](std::size_t k) -> const Impression& {
    return wedges_[k].owner == Owner::kTablet ? tablet_.wedges[k] : outer_.wedges[k - tablet_.wedges.size()];
  };
  const Impression &a = field_of(first), &b = field_of(second);
  const Float4 d = a.middle - b.middle;
  if (dot(d, d) > 2.0f * (a.radius2 + b.radius2)) return false;
  return a.field.meets(b.field);
}

bool Phantom::on_tablet_side(const glm::dvec3& p) const {
  return tablet_.body.smooth(place_.point(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)))
             .v < 0.0f;
}

double Phantom::gap_width(const glm::dvec3& p) const {
  const Point point = place_.point(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
  return static_cast<double>(gap_at(point, tablet_.body.smooth(point)).v);
}

Part Phantom::nearest_part(const glm::dvec3& p) const {
  const Fields f = fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
  const std::array<std::pair<float, Part>, 6> candidates{{{std::abs(metric(f.tablet)), Part::kTablet},
                                                          {std::abs(metric(f.outer)), Part::kEnvelopeOutside},
                                                          {std::abs(metric(f.wall)), Part::kEnvelopeInside},
                                                          {std::abs(metric(f.pore)), Part::kPore},
                                                          {std::abs(metric(f.organic)), Part::kOrganic},
                                                          {std::abs(metric(f.crack)), Part::kCrack}}};
  return std::min_element(candidates.begin(), candidates.end())->second;
}

}  // namespace dubsar::phantom
