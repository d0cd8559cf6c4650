#include "core/contact/recentre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numeric>

#include "core/base/system/parallel_gather.h"
#include "core/contact/clay_sides.h"
#include "core/contact/dips.h"
#include "core/filter/resample.h"
#include "core/parts/air_space.h"

namespace dubsar {
namespace {

constexpr float kReach = 12.0f;    ///< on both sides of the patch, grid steps
constexpr float kCubeSide = 8.0f;  ///< of the places whose heights are taken together: wider than a wedge
constexpr float kFar = 3.0f;       ///< grid steps that a sample has to come in a look for another
constexpr float kThinned = 1.0f;   ///< cubes of which one sample is looked from at half of the resolution, its steps
constexpr std::size_t kLeastCrossings = 24;
constexpr float kAcross = 0.6f;  ///< cosine from which on a face lies along the contact
/// Quantiles of heights whose mean is the ground: below lie wedges, above what noise lifted.
constexpr float kGroundFrom = 0.5f, kGroundTo = 0.85f;
constexpr float kAverage = 10.0f;  ///< deviation of the average over cubes, grid steps
/// Mean strength of dips above that of mere clay from which a cube begins to be believed, and is believed in full.
constexpr float kLeastBelief = 0.7f, kFullBelief = 1.0f;
constexpr float kAirBelief = 2.0f;  ///< the same of air between tablet and envelope
/// Faces that show nothing and are added to those around a place: a few cubes alone are chance.
constexpr float kDoubt = kCubeSide * kCubeSide;
constexpr float kUnknownWeight = 0.25f;  ///< weight of cubes that show no film: there the patch is right

glm::vec3 halved(const glm::vec3& p) { return 0.5f * (p - 1.0f); }  // resample.h

BitVolume halved_signs(const BitVolume& inside, const Dims& dims) {
  BitVolume half(dims);
  parallel_for(dims.z, 1, [&](std::int64_t z) {
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x)
        if (inside.get(2 * x + 1, 2 * y + 1, 2 * z + 1)) half.set(x, y, z, true);
  });
  return half;
}

/// What divides the clay over a piece of the patches.
struct Cube {
  std::vector<float> heights;
  double strength = 0.0;
  glm::dvec3 middle{0.0};
};
/// The height of the ground over the patch there, and how much of it is believed, 0..1.
struct Ground {
  glm::vec3 middle{0.0f};
  float height = 0.0f, strength = 0.0f, faces = 0.0f, belief = 0.0f;
};

/// Calls visit(ground, weight) for those within three deviations of a place.
template <class Visit>
void each_near(const std::vector<Ground>& grounds, const glm::vec3& p, const Visit& visit) {
  for (const Ground& ground : grounds) {
    const glm::vec3 off = ground.middle - p;
    const float far2 = glm::dot(off, off) / (kAverage * kAverage);
    if (far2 < 9.0f) visit(ground, ground.faces * std::exp(-0.5f * far2));
  }
}

/// Clear films cost the cut nothing in all of their width: of the nodes beside it the one with the strongest dip.
std::uint32_t darkest_near(const ContactBand& band, const Dips& dips, std::uint32_t node, int axis) {
  constexpr int kAround = 2;
  std::uint32_t darkest = node;
  for (int step = -kAround; step <= 1 + kAround; ++step)
    if (const std::uint32_t n = band.at(band.point(node) + step * unit_step(axis));
        n != ContactBand::kNone && dips.strength[n] > dips.strength[darkest])
      darkest = n;
  return darkest;
}

/// The next point of clay of the band along an axis, beyond air if there is some: kNone where the grid ends first.
std::uint32_t next_clay(const ContactBand& band, const BitVolume& inside, std::uint32_t node, int axis) {
  constexpr int kMostAir = 12;
  const Dims d = inside.dims();
  const glm::ivec3 end(d.x, d.y, d.z);
  glm::ivec3 p = band.point(node) + unit_step(axis);
  for (int step = 0; step < kMostAir && p[axis] < end[axis] && !inside.get(p.x, p.y, p.z); ++step) p += unit_step(axis);
  return p[axis] < end[axis] ? band.at(p) : ContactBand::kNone;
}

std::vector<Ground> grounds_of(const ContactBand& band, const BitVolume& inside, const Dips& dips,
                               const std::vector<ClaySide>& side) {
  const glm::vec3 middle = middle_of(band.samples);
  struct Crossing {
    glm::vec3 place;
    float height, strength;
  };
  const std::vector<Crossing> crossings = parallel_gather<Crossing>(
      static_cast<std::int64_t>(band.nodes.size()), 1 << 14,
      [&](std::int64_t begin, std::int64_t end, std::vector<Crossing>& crossed) {
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n)
          for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(band.normal(n)[axis]) < kAcross) continue;
            const std::uint32_t m = next_clay(band, inside, n, axis);
            if (m == ContactBand::kNone || side[n] == side[m]) continue;
            const bool air = m != band.at(band.point(n) + unit_step(axis));
            crossed.push_back({band.samples[band.nodes[n].sample].position,
                               air ? 0.5f * (band.nodes[n].height + band.nodes[m].height)
                                   : band.nodes[darkest_near(band, dips, n, axis)].height,
                               air ? dips.plain.strength + kAirBelief : 0.5f * (dips.strength[n] + dips.strength[m])});
          }
      });
  std::map<std::array<int, 3>, Cube> cubes;  // in order: sums do not depend on threads
  for (const Crossing& crossing : crossings) {
    const glm::ivec3 at(glm::round((crossing.place - middle) / kCubeSide));
    Cube& cube = cubes[{at.x, at.y, at.z}];
    cube.heights.push_back(crossing.height);
    cube.strength += static_cast<double>(crossing.strength);
    cube.middle += glm::dvec3(crossing.place);
  }
  std::vector<Ground> found;
  for (auto& entry : cubes) {
    Cube& cube = entry.second;
    const std::size_t faces = cube.heights.size();
    if (faces < kLeastCrossings) continue;
    std::sort(cube.heights.begin(), cube.heights.end());
    const auto share = [&](float q) {
      return cube.heights.begin() + static_cast<std::ptrdiff_t>(q * static_cast<float>(faces));
    };
    const auto from = share(kGroundFrom), to = share(kGroundTo);
    const float ground = std::accumulate(from, to, 0.0f) / static_cast<float>(to - from);
    const auto count = static_cast<double>(faces);
    found.push_back(
        {glm::vec3(cube.middle / count), ground, static_cast<float>(cube.strength / count), static_cast<float>(faces)});
  }
  for (Ground& ground : found) {
    float sum = 0.0f, weights = kDoubt;
    each_near(found, ground.middle, [&](const Ground& other, float weight) {
      sum += weight * (other.strength - dips.plain.strength);
      weights += weight;
    });
    const float above = sum / weights;
    ground.belief = std::clamp((above - kLeastBelief) / (kFullBelief - kLeastBelief), 0.0f, 1.0f);
  }
  return found;
}

/// Of the plane through the grounds around a place (least squares; they lie in a sheet, so that slopes are held). It is
/// level where less than half of them is believed: the slope of a few would lead far away.
float height_at(const std::vector<Ground>& grounds, const glm::vec3& p) {
  constexpr float kHeldSlope = 0.03f;  ///< variance of places across the sheet that is made up
  float weights = 0.0f, heights = 0.0f, believed = 0.0f, all = 0.0f;
  glm::vec3 ways(0.0f), rising(0.0f);
  glm::mat3 squares(0.0f);
  each_near(grounds, p, [&](const Ground& ground, float near) {
    const float weight = near * (ground.belief + kUnknownWeight * (1.0f - ground.belief)),
                height = near * ground.belief * ground.height;
    const glm::vec3 way = (ground.middle - p) / kAverage;
    believed += near * ground.belief;
    all += near;
    weights += weight;
    heights += height;
    ways += weight * way;
    rising += height * way;
    squares += glm::outerProduct(weight * way, way);
  });
  if (!(weights > 0.0f)) return 0.0f;
  const float mean = heights / weights;
  const glm::vec3 middle = ways / weights;
  const glm::mat3 spread = squares / weights - glm::outerProduct(middle, middle) + glm::mat3(kHeldSlope);
  const glm::vec3 slope = glm::inverse(spread) * (rising / weights - mean * middle);
  return mean - std::max(2.0f * believed / all - 1.0f, 0.0f) * glm::dot(slope, middle);
}

/// height_at() on a lattice around the middle of the samples, and between its points.
class HeightField {
 public:
  HeightField(const std::vector<PatchPoint>& samples, const std::vector<Ground>& grounds)
      : first_(first_point(samples)), heights_(size_of(samples, first_), kNotAsked) {
    std::vector<glm::ivec3> points;
    for (const PatchPoint& sample : samples)
      each_corner(sample.position, [&](const glm::ivec3& q, float) {
        if (heights_.get(q.x, q.y, q.z) != kNotAsked) return;
        heights_.at(q.x, q.y, q.z) = 0.0f;
        points.push_back(q);
      });
    parallel_for(static_cast<std::int64_t>(points.size()), 64, [&](std::int64_t i) {
      const glm::ivec3 q = points[static_cast<std::size_t>(i)];
      heights_.at(q.x, q.y, q.z) = height_at(grounds, first_ + kSpacing * glm::vec3(q));
    });
  }
  float at(const glm::vec3& p) const {
    float sum = 0.0f;
    each_corner(p, [&](const glm::ivec3& q, float weight) { sum += weight * heights_.get(q.x, q.y, q.z); });
    return sum;
  }

 private:
  static constexpr float kSpacing = 4.0f, kNotAsked = 1e30f;
  static glm::vec3 first_point(const std::vector<PatchPoint>& samples) {
    const glm::vec3 middle = middle_of(samples);
    glm::vec3 half(0.0f);
    for (const PatchPoint& sample : samples) half = glm::max(half, glm::abs(sample.position - middle));
    return middle - kSpacing * (glm::ceil(half / kSpacing) + 1.0f);
  }
  static Dims size_of(const std::vector<PatchPoint>& samples, const glm::vec3& first) {
    const glm::ivec3 points(2.0f * glm::round((middle_of(samples) - first) / kSpacing) + 1.0f);
    return {points.x, points.y, points.z};
  }
  template <class Visit>
  void each_corner(const glm::vec3& p, const Visit& visit) const {
    const Dims d = heights_.dims();
    const glm::vec3 at = glm::clamp((p - first_) / kSpacing, glm::vec3(0.0f), glm::vec3(d.x - 2, d.y - 2, d.z - 2));
    const glm::vec3 low = glm::floor(at), t = at - low;
    for (int k = 0; k < 8; ++k) {
      const glm::ivec3 step(k & 1, k >> 1 & 1, k >> 2);
      const glm::vec3 share = glm::mix(1.0f - t, t, glm::vec3(step));
      visit(glm::ivec3(low) + step, share.x * share.y * share.z);
    }
  }
  glm::vec3 first_;  ///< place of point 0, 0, 0
  BrickMap<float> heights_;
};

/// Bricks that looks keep around what they look at: most samples move less than the reach, and are looked around as far
/// the next time. Where two are there, what is traced afterwards (6 steps away at most, and one brick more) is mostly
/// there as well.
constexpr BandDensity::Room kKeptRoom{2, 3}, kKeptRoomAtHalf{1, 3};

/// The way of each sample along its normal, grid steps. `looked_from`: those whose surroundings are looked at.
/// `values`: what is kept of `density` between looks.
Result<std::vector<float>> ways_to_films(const std::vector<PatchPoint>& samples, std::vector<PatchPoint> looked_from,
                                         const BitVolume& inside, SlabSource& density, BandDensity& values,
                                         BandDensity::Room kept, Progress& progress) {
  DUBSAR_ASSIGN(const ContactBand band, ContactBand::make(inside, std::move(looked_from), kReach, progress));
  DUBSAR_TRY(values.follow(band, density, progress, kept));
  DUBSAR_ASSIGN(const Dips dips, find_dips(band, inside, values, progress));
  DUBSAR_ASSIGN(const std::vector<ClaySide> side, ClayDivision({band, dips, {}, {}, {}}).sides(progress));
  const HeightField heights(samples, grounds_of(band, inside, dips, side));
  std::vector<float> ways(samples.size());
  parallel_for(static_cast<std::int64_t>(ways.size()), 256, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    ways[i] = heights.at(samples[i].position);
  });
  return ways;
}

/// Moves some samples. Returns those that came farther than `far`. Samples at a rim leave others behind, from where
/// they were on: there the surface's parts meet, wherever the film is.
std::vector<std::uint32_t> move_along_normals(std::vector<PatchPoint>& samples, const std::vector<std::uint32_t>& moved,
                                              const std::vector<float>& ways, float far,
                                              std::vector<PatchPoint>& left_behind) {
  constexpr float kApart = 4.0f;
  std::vector<std::uint32_t> came_far;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    PatchPoint& sample = samples[moved[i]];
    for (float at = 0.0f; sample.at_rim && at + 0.5f * kApart < std::abs(ways[i]); at += kApart)
      left_behind.push_back({sample.position + std::copysign(at, ways[i]) * sample.normal, sample.normal, true});
    sample.position += ways[i] * sample.normal;
    if (std::abs(ways[i]) > far) came_far.push_back(moved[i]);
  }
  return came_far;
}

/// Samples in cubes of that side of which one came far, or that are within three of such: nearly all whose grounds have
/// a say in where those that came far are.
std::vector<std::uint32_t> around(const std::vector<std::uint32_t>& far, const std::vector<PatchPoint>& samples,
                                  float side) {
  constexpr int kAround = 3;
  if (far.empty()) return {};
  const SampleCubes cubes(samples, side);
  BitVolume with_far(cubes.dims());
  for (const std::uint32_t i : far) {
    const glm::ivec3 c = cubes.cube(samples[i]);
    with_far.set(c.x, c.y, c.z, true);
  }
  const BitVolume near = dilate(with_far, kAround);
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    if (const glm::ivec3 c = cubes.cube(samples[i]); near.get(c.x, c.y, c.z)) found.push_back(i);
  return found;
}

/// Looks anew from where samples have come to, and around them, while some come far: a corner of the tablet that a
/// patch cuts off is farther away than can be seen from it, and its film leads there. `look`: the ways of samples on a
/// grid of `scale` steps.
template <class Look>
Result<Recentred> follow_films(std::vector<PatchPoint>& samples, float scale, ContactRules rules, const Look& look) {
  const int most_looks = rules.has(ContactRule::kLooks) ? 4 : 1;
  const float far = scale * kFar;
  const std::vector<PatchPoint> before = samples;
  std::vector<PatchPoint> left_behind;
  std::vector<std::uint32_t> asked(samples.size());
  std::iota(asked.begin(), asked.end(), 0u);
  for (int k = 0; k < most_looks && !asked.empty(); ++k) {
    std::vector<PatchPoint> from;
    from.reserve(asked.size());
    for (const std::uint32_t i : asked) from.push_back(samples[i]);
    DUBSAR_ASSIGN(std::vector<float> ways, look(std::move(from)));
    for (float& way : ways) way *= scale;
    asked = around(move_along_normals(samples, asked, ways, far, left_behind), samples, scale * kCubeSide);
  }
  Recentred recentred;
  for (std::size_t i = 0; i < before.size(); ++i)
    recentred.longest = std::max(recentred.longest, glm::distance(before[i].position, samples[i].position));
  samples.insert(samples.end(), left_behind.begin(), left_behind.end());
  return recentred;
}

}  // namespace

Result<Recentred> recentre_samples(std::vector<PatchPoint>& samples, const BitVolume& inside, SlabSource& density,
                                   Progress& progress, ContactRules rules) {
  BandDensity values;
  DUBSAR_ASSIGN(Recentred recentred, follow_films(samples, 1.0f, rules, [&](const std::vector<PatchPoint>& from) {
                  return ways_to_films(from, from, inside, density, values, kKeptRoom, progress);
                }));
  recentred.density = std::move(values);
  return recentred;
}

Result<Recentred> recentre_samples_at_half(std::vector<PatchPoint>& samples, const BitVolume& inside,
                                           SlabSource& density, Progress& progress, ContactRules rules) {
  HalfResolutionSource half(density);
  const BitVolume inside_half = halved_signs(inside, half.dims());
  BandDensity values;
  return follow_films(samples, 2.0f, rules, [&](std::vector<PatchPoint> from) {
    for (PatchPoint& sample : from) sample.position = halved(sample.position);
    return ways_to_films(from, thinned(from, kThinned), inside_half, half, values, kKeptRoomAtHalf, progress);
  });
}

}  // namespace dubsar
