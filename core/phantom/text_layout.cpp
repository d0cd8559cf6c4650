// Text and seals: which side carries what, and every wedge pressed into its place.

#include "core/phantom/builder.h"

namespace dubsar::phantom {
namespace {

constexpr float kSignHeight = 0.84f;  ///< of the line pitch
constexpr float kBaseLine = 0.08f;

Float4 cross(Float4 a, Float4 b) {
  return Float4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0.0f};
}
Float4 unit(Float4 v) { return v * (1.0f / std::sqrt(dot(v, v))); }

}  // namespace

void PhantomBuilder::write_tablet() {
  ClayBody& body = p_.tablet_.body;
  const float inset = 0.42f * body.edge_radius;
  for (const Side side : {Side::kObverse, Side::kReverse, Side::kLower, Side::kUpper, Side::kLeft, Side::kRight}) {
    const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
    const float length = body.half[static_cast<std::size_t>(frame.right.axis)] - inset;
    const float height = body.half[static_cast<std::size_t>(frame.up.axis)] - inset;
    const int lines = std::max(1, static_cast<int>(std::floor(2.0f * height / line_pitch_)));
    const float top = 0.5f * line_pitch_ * static_cast<float>(lines);
    // On the right edge the lines of the obverse run on, so not every line is used.
    const double fill = side == Side::kRight ? 0.55 : 1.0;
    write_block(Owner::kTablet, {side, top, length, lines, fill});
  }
}

void PhantomBuilder::write_envelope() {
  ClayBody& body = p_.outer_.body;
  Random random(seed(), 7);
  const float inset = 0.36f * body.edge_radius;
  const float seal_height = SealRelief::kHeightMm * p_.place_.voxels_per_mm;
  const auto roll = [&](Side side, float bottom) {
    body.bands[static_cast<std::size_t>(side)].push_back(
        {bottom, static_cast<float>(random.uniform(0.0, static_cast<double>(SealRelief::kTurnMm)))});
  };
  std::array<int, kSides> lines_before{};
  const auto text = [&](Side side, float bottom, float top) {
    const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
    const int lines = static_cast<int>(std::floor((top - bottom) / line_pitch_));
    const float slack = 0.5f * (top - bottom - static_cast<float>(lines) * line_pitch_);
    if (lines > 0)
      write_block(Owner::kEnvelope, {side, top - slack, body.half[static_cast<std::size_t>(frame.right.axis)] - inset,
                                     lines, 1.0, lines_before[static_cast<std::size_t>(side)] + 1});
    lines_before[static_cast<std::size_t>(side)] += std::max(0, lines);
  };
  const float margin = 0.8f * p_.place_.voxels_per_mm;
  const float reach = body.half[2] - inset;
  roll(Side::kObverse, reach - seal_height);
  roll(Side::kObverse, -reach);
  text(Side::kObverse, -reach + seal_height + margin, reach - seal_height - margin);
  roll(Side::kReverse, -0.5f * seal_height);
  text(Side::kReverse, 0.5f * seal_height + margin, reach);
  text(Side::kReverse, -reach, -0.5f * seal_height - margin);
  const float edge = body.half[1] - inset;
  roll(Side::kUpper, -0.5f * seal_height);
  roll(Side::kLeft, -0.5f * seal_height);
  text(Side::kLower, -edge, edge);
  text(Side::kRight, -body.half[2] + 2.0f * inset, body.half[2] - 2.0f * inset);
}

void PhantomBuilder::write_block(Owner owner, const TextBlock& block) {
  ClayBody& body = owner == Owner::kTablet ? p_.tablet_.body : p_.outer_.body;
  Random random(seed(), 0x100 + 16 * static_cast<std::uint64_t>(owner) + static_cast<std::uint64_t>(block.side) +
                            1000 * static_cast<std::uint64_t>(signs_));
  const float pitch = line_pitch_, sign_height = kSignHeight * pitch;
  if (p_.options_.writing.ruled)
    body.rulings[static_cast<std::size_t>(block.side)].push_back(
        {block.top - static_cast<float>(block.lines) * pitch, pitch, block.lines + 1, block.half_length});
  for (int line = 0; line < block.lines; ++line) {
    if (random.uniform() >= block.fill) continue;
    const float base = block.top - static_cast<float>(line + 1) * pitch + kBaseLine * pitch;
    const float length = 2.0f * block.half_length;
    for (const PlacedSign& sign : write_line(length / sign_height, random)) {
      for (const Stroke& stroke : sign.strokes)
        press(owner, block.side, stroke.x * sign_height - block.half_length, base + stroke.y * sign_height, stroke,
              {signs_, block.first_line + line, sign_height});
      ++signs_;
    }
  }
}

void PhantomBuilder::press(Owner owner, Side side, float right, float up, const Stroke& stroke, const PressedAs& as) {
  const float sign_height = as.sign_height;
  ClayBody& body = owner == Owner::kTablet ? p_.tablet_.body : p_.outer_.body;
  const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
  Point point;
  point.p = body.surface_point(side, right, up);
  const Dual surface = body.smooth(point);
  if (std::abs(surface.v) > 0.05f) return;  // past the edge of the clay
  const Float4 normal = unit(surface.g);
  if (frame.normal.sign * normal[frame.normal.axis] < 0.72f) return;  // too far round the edge for this side
  Float4 along{};
  along[frame.right.axis] += frame.right.sign * stroke.tail_x;
  along[frame.up.axis] += frame.up.sign * stroke.tail_y;
  along = unit(along - normal * dot(along, normal));
  const WedgeSize size = stylus_wedge(stroke.head * sign_height, stroke.length * sign_height, tip_rounding_);

  auto& impressions = owner == Owner::kTablet ? p_.tablet_.wedges : p_.outer_.wedges;
  auto& balls = owner == Owner::kTablet ? tablet_balls_ : outer_balls_;
  const float back = size.head_back, front = std::max(size.tail_length, size.head_front);
  const Float4 middle = point.p + along * (0.5f * (front - back));
  // The lip, the wall that follows through the gap, and the rasteriser's distance band.
  const float radius = std::hypot(0.5f * (front + back), std::max(size.head_half_width, size.depth)) * 1.05f +
                       0.5f * size.head_half_width + 0.5f * p_.gap_.open + 5.0f;
  impressions.push_back({WedgeField(size, point.p, along, cross(normal, along)), middle, radius * radius});
  balls.push_back({p_.place_.grid_point(middle), static_cast<double>(radius)});
  float& relief = owner == Owner::kTablet ? p_.tablet_.relief : p_.outer_.relief;
  relief = std::max(relief, 1.1f * size.depth + 1.0f);

  // Of the undisturbed surface, above the deepest place.
  const auto on_surface = [&](float along_it) {
    Point at;
    at.p = point.p + along * along_it;
    Dual there = body.smooth(at);
    for (int i = 0; i < 4; ++i) {
      at.p = at.p - there.g * (there.v / dot(there.g, there.g));
      there = body.smooth(at);
    }
    return std::pair{at, there};
  };
  const auto [above, there] = on_surface(impressions.back().field.deepest_along());

  const Float4 outward = unit(there.g);

  Wedge wedge;
  wedge.position = p_.place_.grid_point(above.p);
  wedge.outward = p_.place_.grid_vector(outward);
  wedge.tail = p_.place_.grid_vector(unit(along - outward * dot(along, outward)));
  wedge.depth = static_cast<double>(size.depth);
  wedge.length = static_cast<double>(size.tail_length);
  wedge.head_half_width = static_cast<double>(size.head_half_width);
  wedge.side = side;
  wedge.owner = owner;
  wedge.place.head = p_.place_.grid_point(on_surface(-size.head_back).first.p);
  wedge.place.end = p_.place_.grid_point(on_surface(std::max(size.head_front, size.tail_length)).first.p);
  Float4 of_lines{};
  of_lines[frame.right.axis] = frame.right.sign;
  wedge.place.right = p_.place_.grid_vector(unit(of_lines - outward * dot(of_lines, outward)));
  wedge.kind = stroke.kind;
  wedge.sign = as.sign;
  wedge.line = as.line;
  p_.wedges_.push_back(wedge);
  p_.edges_.lip_width = 0.5f * size.head_half_width;
  p_.edges_.lip_height = 0.06f * size.depth;
  p_.edges_.hint = 0.45f * size.depth;
}

// The depth of each impression as it is now, after neighbours, rounding and lips: the first clay below its place.
void PhantomBuilder::measure_wedges() {
  for (Wedge& wedge : p_.wedges_) {
    const auto field = [&](double depth) {
      const glm::dvec3 p = wedge.position - depth * wedge.outward;
      const Fields f = p_.fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
      return wedge.owner == Owner::kTablet ? std::array{f.tablet.v, f.clay.v} : std::array{f.outer.v, f.clay.v};
    };
    constexpr double kStep = 0.05;  // of the nominal depth
    int steps = 0, air = 0;
    double lo = 0.0, hi = 0.0;
    wedge.open = field(0.0)[1] > 0.0f;
    const double nominal = wedge.depth;
    for (hi = kStep * nominal; hi < 2.5 * nominal && field(hi)[0] > 0.0f; hi += kStep * nominal) {
      const bool in_air = field(hi)[1] > 0.0f;
      wedge.open = wedge.open && in_air;
      ++steps;
      air += in_air;
      lo = hi;
    }
    const bool film = p_.options_.contact == Contact::kFilm;  // as wide as the gap, away from the contact
    if (wedge.owner == Owner::kTablet && !wedge.open && (!film || p_.in_contact(wedge.position)))
      wedge.state = film ? WedgeCase::kFilm : 2 * air >= steps ? WedgeCase::kPocket : WedgeCase::kFilled;
    for (int i = 0; i < 30; ++i) {
      const double middle = 0.5 * (lo + hi);
      (field(middle)[0] > 0.0f ? lo : hi) = middle;
    }
    wedge.depth = 0.5 * (lo + hi);
  }
}

}  // namespace dubsar::phantom
