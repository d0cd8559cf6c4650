#include "core/phantom/clay_body.h"

namespace dubsar::phantom {
namespace {

// sin(2 pi u) for u in [-1/2, 1/2], odd quintic through the zeros and extrema (error 0.2 %): the waves need to be
// smooth and the same on every machine, not sines.
constexpr float kSine[3] = {6.2832f, -40.33f, 60.79f};

// Edges of lost patches are half a millimetre wide where patches are some 5 mm large; SealLoss says what is rough.
constexpr float kLossRamp = 0.25f, kRoughFloor = 1.0f / 7.0f;

Dual coordinate(const Point& point, SignedAxis axis) { return point[axis.axis] * axis.sign; }

}  // namespace

Waves::Waves(Random& random, int count, float shortest, float longest, float deviation)
    : amplitude_(deviation * std::sqrt(2.0f / static_cast<float>(count))) {
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 direction = random.direction();
    const double length = shortest * std::pow(longest / shortest, random.uniform());
    waves_.push_back({Float4{static_cast<float>(direction.x / length), static_cast<float>(direction.y / length),
                             static_cast<float>(direction.z / length), 0.0f},
                      static_cast<float>(random.uniform())});
  }
}

Dual Waves::evaluate(const Point& point) const {
  Dual sum;
  for (const Wave& wave : waves_) {
    const float t = dot(point.p, wave.turns_per_voxel) + wave.phase;
    const float u = t - std::floor(t + 0.5f), u2 = u * u;
    sum.v += u * (kSine[0] + u2 * (kSine[1] + u2 * kSine[2]));
    sum.g += wave.turns_per_voxel * (kSine[0] + u2 * (3.0f * kSine[1] + u2 * 5.0f * kSine[2]));
  }
  return sum * amplitude_;
}

Dual ClayBody::pillow(const Point& point, Faces& faces) const {
  static constexpr Side kNegative[3] = {Side::kLeft, Side::kObverse, Side::kLower};
  static constexpr Side kPositive[3] = {Side::kRight, Side::kReverse, Side::kUpper};
  Dual largest{-1e30f, Float4{}}, squares;
  for (int axis = 0; axis < 3; ++axis) {
    const float sign = point.p[axis] < 0.0f ? -1.0f : 1.0f;
    const Side side = sign < 0.0f ? kNegative[axis] : kPositive[axis];
    // A sphere cap that rises by `bulge` over the larger of the two other half extents.
    const float reach =
        std::max(half[static_cast<std::size_t>((axis + 1) % 3)], half[static_cast<std::size_t>((axis + 2) % 3)]);
    const float rise = bulge[static_cast<std::size_t>(side)];
    const float radius = (reach * reach + rise * rise) / (2.0f * rise);
    Float4 centre{};
    centre[axis] = sign * (half[static_cast<std::size_t>(axis)] - radius);
    const Dual d = sqrt(point.distance2(centre)) - radius;
    faces.distance[static_cast<std::size_t>(axis)] = d;
    faces.side[static_cast<std::size_t>(axis)] = side;
    largest = max(largest, d);
    const Dual over = max(d + edge_radius, Dual{});
    squares = squares + over * over;
  }
  // Rounded intersection (exact for perpendicular planes).
  return min(largest, Dual{-edge_radius, Float4{}}) + sqrt(squares);
}

Dual ClayBody::evaluate(const Point& point, Dual* decor, float range) const {
  Faces faces;
  const Dual slab = pillow(point, faces);
  Dual body = slab + undulation.evaluate(point);
  for (const FingerMark& mark : finger_marks)
    body = body + bump(point.distance2(mark.centre), mark.radius2) * mark.depth;
  if (decor && std::abs(body.v) <= range) *decor = decorate(point, slab, faces);
  return body;
}

Dual ClayBody::owned(const Dual& slab, const Faces& faces, std::size_t& axis) const {
  axis = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (faces.distance[a].v > faces.distance[axis].v) axis = a;
  return smooth_step(faces.distance[axis] - slab, -0.27f * edge_radius, -0.03f * edge_radius);
}

float ClayBody::decor_share(Side side, const Point& point) const {
  Faces faces;
  const Dual slab = pillow(point, faces);
  std::size_t axis = 0;
  const Dual mask = owned(slab, faces, axis);
  return faces.side[axis] == side ? mask.v : 0.0f;
}

Dual ClayBody::decorate(const Point& point, const Dual& slab, const Faces& faces) const {
  std::size_t axis = 0;
  const Dual mask = owned(slab, faces, axis);
  if (mask.v <= 0.0f) return {};
  const auto side = static_cast<std::size_t>(faces.side[axis]);
  const SideFrame& frame = kSideFrames[side];
  const Dual right = coordinate(point, frame.right), up = coordinate(point, frame.up);
  Dual decor;
  for (const Ruling& ruling : rulings[side]) {
    if (std::abs(right.v) >= ruling.half_length) continue;
    const float line = std::round((up.v - ruling.first) / ruling.pitch);
    const float k = std::clamp(line, 0.0f, static_cast<float>(ruling.count - 1));
    // No hand rules a straight line: each bends a little, differently.
    const float bend = 0.0004f * (1.0f + 0.5f * std::cos(2.1f * k)) / voxels_per_mm;
    const float off = right.v + 0.3f * ruling.half_length * std::cos(1.7f * k);
    Dual d = up - (ruling.first + k * ruling.pitch);
    d = d + Dual{bend * off * off, right.g * (2.0f * bend * off)};
    const Dual fade = smooth_step(-smooth_abs(right, 1.0f), -ruling.half_length, 1.0f - ruling.half_length * 0.93f);
    decor = decor + bump(d * d, ruling_half_width * ruling_half_width) * fade * ruling_depth;
  }
  if (seal)
    for (const SealBand& band : bands[side]) {
      const float mm = 1.0f / voxels_per_mm;
      const Dual x = right * mm + band.phase_mm, y = (up - band.bottom) * mm;
      if (y.v <= -0.8f || y.v >= SealRelief::kHeightMm + 0.8f) continue;
      const Dual inside =
          smooth_step(y, -0.8f, 0.4f) * smooth_step(-y, -SealRelief::kHeightMm - 0.8f, -SealRelief::kHeightMm + 0.4f);
      Dual raised = seal->height(x, y) * voxels_per_mm;
      if (band.lost_above < 1e30f) {
        const Dual lost = smooth_step(loss.where.evaluate(point) - band.lost_above, 0.0f, kLossRamp);
        const Dual broken = smooth_step(loss.kind.evaluate(point), 0.0f, kLossRamp) * loss.depth *
                            (loss.floor.evaluate(point) * kRoughFloor + 1.0f);
        raised = raised - lost * (raised + broken * inside);
      }
      decor = decor + inside * band_depth - raised;
    }
  return decor * mask;
}

Float4 ClayBody::surface_point(Side side, float right, float up) const {
  const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
  Point point;
  point.p[frame.right.axis] = frame.right.sign * right;
  point.p[frame.up.axis] = frame.up.sign * up;
  const int axis = frame.normal.axis;
  // Sphere tracing from outside: safe where the surface bends away at the rim.
  point.p[axis] = frame.normal.sign * (half[static_cast<std::size_t>(axis)] + 2.0f * voxels_per_mm);
  for (int i = 0; i < 200; ++i) {
    const float d = smooth(point).v;
    point.p[axis] -= frame.normal.sign * 0.9f * d;
    if (std::abs(d) < 1e-3f || point.p[axis] * frame.normal.sign < 0.0f) break;
  }
  return point.p;
}

}  // namespace dubsar::phantom
