#include "core/phantom/builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <numbers>

namespace dubsar::phantom {
namespace {

Float4 float4(const glm::dvec3& v) {
  return Float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f};
}

// Half extents of the envelope in mm: AO 8295 measures 5.9 x 6.1 x 2.1 cm (paper, section 4).
constexpr double kEnvelopeHalfMm[3] = {29.5, 10.5, 30.5};

}  // namespace

Result<std::unique_ptr<const Phantom>> Phantom::create(const PhantomOptions& options) {
  DUBSAR_ASSIGN(const PhantomOptions completed, complete(options));
  return PhantomBuilder::build(completed);
}

std::unique_ptr<const Phantom> PhantomBuilder::build(const PhantomOptions& options) {
  std::unique_ptr<Phantom> phantom(new Phantom(options));
  PhantomBuilder builder(*phantom);
  builder.place_in_grid();
  builder.shape_bodies();
  builder.shape_gap();
  builder.measure_glue();
  if (phantom->options_.writing.written) builder.write_tablet();
  builder.write_envelope();
  if (phantom->options_.writing.seals_lost > 0.0) builder.wear_sealings();
  builder.index_wedges();
  builder.crack_envelope();
  builder.fill_clay();
  builder.measure_wedges();
  return phantom;
}

void PhantomBuilder::place_in_grid() {
  const Dims d = p_.options_.dims;
  p_.place_.voxels_per_mm = static_cast<float>(1.0 / p_.options_.voxel_mm);
  Random random(seed(), 1);
  // Nobody can put a tablet quite straight into a scanner.
  const auto turn = [&](double degrees) { return random.uniform(-degrees, degrees) * std::numbers::pi / 180.0; };
  glm::dmat4 rotation(1.0);
  rotation = glm::rotate(rotation, turn(4.0), glm::dvec3(1, 0, 0));
  rotation = glm::rotate(rotation, turn(1.5), glm::dvec3(0, 1, 0));
  rotation = glm::rotate(rotation, turn(3.0), glm::dvec3(0, 0, 1));
  const glm::dvec3 centre =
      0.5 * glm::dvec3(static_cast<double>(d.x - 1), static_cast<double>(d.y - 1), static_cast<double>(d.z - 1)) +
      glm::dvec3(turn(30.0), turn(30.0), turn(30.0));
  p_.place_.axis_x = float4(glm::dvec3(rotation[0]));
  p_.place_.axis_y = float4(glm::dvec3(rotation[1]));
  p_.place_.axis_z = float4(glm::dvec3(rotation[2]));
  p_.place_.origin =
      -(p_.place_.axis_x * static_cast<float>(centre.x) + p_.place_.axis_y * static_cast<float>(centre.y) +
        p_.place_.axis_z * static_cast<float>(centre.z));
}

void PhantomBuilder::shape_bodies() {
  Random random(seed(), 2);
  // Sizes that a coarse grid could not show are kept at some voxels: a small phantom is coarser, not empty.
  const float half_y = mm(kEnvelopeHalfMm[1]);
  constexpr float kLeastGap = 2.4f;  // narrower ones close at half of the resolution, and nothing is separate
  p_.gap_.open = p_.options_.gap_vox > 0.0 ? static_cast<float>(p_.options_.gap_vox)
                                           : std::max({mm(0.30), std::min(5.5f, 0.075f * half_y), kLeastGap});
  const float wall = std::max(mm(3.0), 4.5f);

  ClayBody& outer = p_.outer_.body;
  outer.half = {mm(kEnvelopeHalfMm[0]), half_y, mm(kEnvelopeHalfMm[2])};
  outer.bulge = {mm(2.0), mm(2.8), mm(1.7), mm(1.7), mm(1.5), mm(1.5)};
  outer.edge_radius = mm(6.0);
  outer.undulation = Waves(random, 6, mm(9.0), mm(28.0), mm(0.16));
  p_.seal_ = SealRelief(seed());
  outer.seal = &p_.seal_;
  outer.band_depth = mm(0.22);

  ClayBody& tablet = p_.tablet_.body;
  for (std::size_t a = 0; a < 3; ++a) tablet.half[a] = outer.half[a] - wall - p_.gap_.open;
  tablet.bulge = {mm(1.6), mm(2.4), mm(1.3), mm(1.3), mm(1.2), mm(1.2)};
  tablet.edge_radius = std::min(mm(4.4), 0.6f * tablet.half[1]);
  tablet.undulation = Waves(random, 6, mm(8.0), mm(24.0), mm(0.13));

  for (ClayBody* body : {&outer, &tablet}) {
    body->voxels_per_mm = p_.place_.voxels_per_mm;
    body->ruling_depth = std::max(mm(0.13), 0.6f);
    body->ruling_half_width = std::max(mm(0.30), 1.6f);
    for (int i = 0; i < 6; ++i) {
      const Side side = i % 2 ? Side::kReverse : Side::kObverse;
      const Float4 place = body->surface_point(side, static_cast<float>(random.uniform(-0.75, 0.75)) * body->half[0],
                                               static_cast<float>(random.uniform(-0.75, 0.75)) * body->half[2]);
      const float radius = mm(random.uniform(4.5, 8.0));
      body->finger_marks.push_back({place, radius * radius, mm(random.uniform(0.2, 0.4))});
    }
  }
  p_.outer_.relief = mm(0.8);  // band and ruling below, figures above
  p_.tablet_.relief = std::max(1.5f * p_.gap_.open, mm(0.6));
  // Wedges shallower than some 7 voxels do not survive: PSF, resampling and denoising take 1.2 voxels from a tip.
  constexpr float kPitchOfDepth = 8.0f;  // a line of 56 voxels has wedges of about 7
  const float pitch = p_.options_.wedge_depth_vox > 0.0
                          ? kPitchOfDepth * static_cast<float>(p_.options_.wedge_depth_vox)
                          : std::max(mm(3.6), 56.0f);
  line_pitch_ = std::min(pitch, 0.6f * tablet.half[2]);
  tip_rounding_ = std::min(std::max(mm(0.08), 4.0f), 0.07f * line_pitch_);
  p_.edges_.rim_rounding = std::max(mm(0.05), 1.0f);
  p_.edges_.join_rounding = std::max(mm(0.04), 1.0f);
}

void PhantomBuilder::shape_gap() {
  Random random(seed(), 3);
  p_.gap_.variation = Waves(random, 4, mm(6.0), mm(15.0), 0.16f);
  p_.gap_.glue = Waves(random, 8, mm(12.0), mm(32.0), 1.0f);
  p_.gap_.ramp = 0.5f;
  const int touches = 6 + random.index(5);
  for (int i = 0; i < touches; ++i) {
    const auto side = static_cast<Side>(random.index(kSides));
    const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
    const auto somewhere = [&](int axis) {
      return static_cast<float>(random.uniform(-0.85, 0.85)) * p_.tablet_.body.half[static_cast<std::size_t>(axis)];
    };
    const float right = somewhere(frame.right.axis), up = somewhere(frame.up.axis),
                radius = mm(random.uniform(1.2, 2.4));
    p_.gap_.touches.push_back({p_.tablet_.body.surface_point(side, right, up), radius * radius, 1.06f});
  }
}

// Points of the tablet's surface on a raster over each side, weighted by the area they stand for; the threshold of the
// glue field is the quantile that gives this seed its share of glued surface.
void PhantomBuilder::measure_glue() {
  struct Spot {
    float glue, area;
    Point point;
  };
  std::vector<Spot> spots;
  constexpr int kRaster = 96;
  for (int s = 0; s < kSides; ++s) {
    const SideFrame& frame = kSideFrames[static_cast<std::size_t>(s)];
    for (int j = 0; j < kRaster; ++j)
      for (int i = 0; i < kRaster; ++i) {
        const auto at = [&](int k, int axis) {
          return (2.0f * (static_cast<float>(k) + 0.5f) / kRaster - 1.0f) *
                 p_.tablet_.body.half[static_cast<std::size_t>(axis)];
        };
        Point point;
        point.p = p_.tablet_.body.surface_point(static_cast<Side>(s), at(i, frame.right.axis), at(j, frame.up.axis));
        const Dual surface = p_.tablet_.body.smooth(point);
        if (std::abs(surface.v) > 0.5f) continue;  // beside the tablet
        const Float4 g = surface.g;
        const float slope = std::sqrt(dot(g, g)), facing = frame.normal.sign * g[frame.normal.axis] / slope;
        if (facing < std::max(std::abs(g[frame.right.axis]), std::abs(g[frame.up.axis])) / slope) continue;
        const float cell = 4.0f * p_.tablet_.body.half[static_cast<std::size_t>(frame.right.axis)] *
                           p_.tablet_.body.half[static_cast<std::size_t>(frame.up.axis)] / (kRaster * kRaster);
        spots.push_back({p_.gap_.glue.evaluate(point).v, cell / facing, point});
      }
  }
  std::sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.glue > b.glue; });
  double total = 0.0;
  for (const Spot& spot : spots) total += static_cast<double>(spot.area);
  const double share =
      p_.options_.contact_share > 0.0 ? p_.options_.contact_share : Random(seed(), 4).uniform(0.08, 0.26);
  const double wanted = total * share;
  double sum = 0.0;
  for (const Spot& spot : spots) {
    sum += static_cast<double>(spot.area);
    p_.gap_.threshold = spot.glue;
    if (sum >= wanted) break;
  }
  // Where the envelope only lies on the tablet, half a voxel makes sure that no air is left.
  p_.gap_.overlap = p_.options_.contact == Contact::kPockets ? 0.5f : std::max(mm(0.5), 3.0f);
  if (p_.options_.contact == Contact::kFilm) p_.gap_.film = static_cast<float>(p_.options_.film_vox);
  double glued = 0.0;
  for (const Spot& spot : spots)
    if (p_.touches(p_.gap_.width(spot.point).v)) glued += static_cast<double>(spot.area);
  p_.glued_fraction_ = glued / total;
}

void PhantomBuilder::index_wedges() {
  p_.tablet_.cells = CellLists(p_.options_.dims, tablet_balls_);
  p_.outer_.cells = CellLists(p_.options_.dims, outer_balls_);
}

void PhantomBuilder::crack_envelope() {
  Random random(seed(), 5);
  const bool cracked = random.uniform() < 0.4;
  if (!cracked) return;
  // From the rim of the envelope inwards through its wall; at most 2.6 voxels wide, closing towards its end.
  const float sign = random.uniform() < 0.5 ? -1.0f : 1.0f;
  Crack& crack = p_.crack_;
  crack.centre = p_.outer_.body.surface_point(Side::kReverse, sign * 0.93f * p_.outer_.body.half[0],
                                              static_cast<float>(random.uniform(-0.5, 0.5)) * p_.outer_.body.half[2]);
  const auto tilt = static_cast<float>(random.uniform(-0.3, 0.3));
  crack.normal = Float4{tilt, 0.0f, 1.0f, 0.0f} * (1.0f / std::sqrt(1.0f + tilt * tilt));
  crack.bend = Waves(random, 5, mm(2.0), mm(8.0), mm(0.25));
  crack.half_width = 1.3f;
  crack.radius2 = mm(9.0) * mm(9.0);
}

void PhantomBuilder::fill_clay() {
  const double volume_mm3 = 8.0 * kEnvelopeHalfMm[0] * kEnvelopeHalfMm[1] * kEnvelopeHalfMm[2];
  const auto count = [&](double per_cm3) { return static_cast<int>(volume_mm3 * per_cm3 * 1e-3); };
  // A feature must stay this many voxels below the surface: nothing may pierce it by chance.
  const auto buried = [&](const glm::dvec3& place, float radius) {
    const Fields f = p_.fields(static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z));
    const float joint = std::min(std::abs(f.tablet.v), std::abs(f.wall.v));
    return f.clay.v < -1.4f * (radius + 3.0f) && joint > 1.4f * (radius + 3.0f);
  };
  const auto somewhere = [&](Random& random) {
    const Float4 model{mm(random.uniform(-1, 1) * kEnvelopeHalfMm[0]), mm(random.uniform(-1, 1) * kEnvelopeHalfMm[1]),
                       mm(random.uniform(-1, 1) * kEnvelopeHalfMm[2]), 0.0f};
    return model;
  };
  std::vector<Ball> taken, pores, straws, grains;
  const auto free_place = [&](const glm::dvec3& place, double radius) {
    return std::none_of(taken.begin(), taken.end(),
                        [&](const Ball& b) { return glm::length(b.centre - place) < b.radius + radius + 4.0; });
  };
  Random random(seed(), 6);
  for (int i = count(18.0); i > 0; --i) {
    const Float4 centre = somewhere(random);
    const float radius = std::max(mm(0.12 * std::pow(6.0, random.uniform() * random.uniform())), 1.6f);
    const glm::dvec3 e0 = random.direction(), e1 = glm::normalize(glm::cross(e0, random.direction())),
                     e2 = glm::cross(e0, e1);
    const std::array<double, 3> stretch{random.uniform(1.0, 1.6), 1.0, random.uniform(0.7, 1.0)};
    const glm::dvec3 place = p_.place_.grid_point(centre);
    if (!buried(place, 1.6f * radius) || !free_place(place, 1.6 * static_cast<double>(radius))) continue;
    Pore pore{centre, {}, radius * static_cast<float>(stretch[2])};
    const std::array<glm::dvec3, 3> axes{e0, e1, e2};
    for (std::size_t a = 0; a < 3; ++a) pore.axis[a] = float4(axes[a] / (stretch[a] * static_cast<double>(radius)));
    p_.pores_.all.push_back(pore);
    taken.push_back({place, 1.6 * static_cast<double>(radius)});
    pores.push_back({place, 1.6 * static_cast<double>(radius) + 8.0});
  }
  for (int i = count(9.0); i > 0; --i) {  // chopped straw
    const Float4 centre = somewhere(random);
    const float radius = std::max(mm(random.uniform(0.10, 0.28)), 1.3f), half_length = mm(random.uniform(0.6, 2.4));
    const Float4 direction = float4(random.direction());
    const Float4 a = centre - direction * half_length, b = centre + direction * half_length;
    const glm::dvec3 place = p_.place_.grid_point(centre);
    bool fits = free_place(place, static_cast<double>(half_length + radius));
    for (int k = -4; k <= 4 && fits; ++k)
      fits = buried(p_.place_.grid_point(centre + direction * (half_length * 0.25f * static_cast<float>(k))), radius);
    if (!fits) continue;
    p_.straws_.all.push_back({a, b, radius});
    taken.push_back({place, static_cast<double>(half_length + radius)});
    straws.push_back({place, static_cast<double>(half_length + radius) + 8.0});
  }
  for (int i = count(2.0); i > 0; --i) {  // mineral grains
    const Float4 centre = somewhere(random);
    const float radius = std::max(mm(random.uniform(0.08, 0.3)), 0.9f);
    const glm::dvec3 place = p_.place_.grid_point(centre);
    if (!buried(place, radius) || !free_place(place, static_cast<double>(radius))) continue;
    p_.grains_.all.push_back({centre, radius});
    taken.push_back({place, static_cast<double>(radius)});
    grains.push_back({place, static_cast<double>(radius) + 8.0});
  }
  p_.pores_.cells = CellLists(p_.options_.dims, pores);
  p_.straws_.cells = CellLists(p_.options_.dims, straws);
  p_.grains_.cells = CellLists(p_.options_.dims, grains);
}

}  // namespace dubsar::phantom
