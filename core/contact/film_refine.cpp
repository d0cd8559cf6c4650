#include "core/contact/film_refine.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel.h"
#include "core/contact/dents.h"
#include "core/contact/ring_average.h"

namespace dubsar {
namespace {

constexpr int kReach = 5;             ///< samples of a profile, each way
constexpr float kStep = 0.5f;         ///< between them, grid steps
constexpr int kRounds = 6;            ///< of search and move
constexpr float kLeap = 0.75f;        ///< most that a round moves a vertex
constexpr int kProfileRings = 2;      ///< over which profiles are averaged, and moves
constexpr int kStepRings = 4;         ///< and moves to where one clay becomes the other
constexpr int kBendRings = 3;         ///< over which the curvature is
constexpr float kSpread = 0.5f;       ///< of the way to the middle of its neighbours, along the contact
constexpr float kLeastCosine = 0.3f;  ///< between a triangle before and after
/// Depth of a dip, in deviations of the noise, that is trusted by half; and how much of a move nobody is sure of.
constexpr float kDoubt = 4.0f, kFloor = 0.1f;
constexpr float kSettle = 0.5f;  ///< of the way to the middle of the neighbours, where nothing is trusted
constexpr int kSettleRounds = 2;
constexpr float kMostHollow = 1.5f;  ///< steps out of the hollow
constexpr float kLowPass = 0.5f;     ///< variance of that of BandDensity
/// Squared steps more in dents deeper than kDeep steps, all of it a step deeper: the disks of the cut and the averages
/// along the contact round their tips, too. Elsewhere what is bent is noise, or follows two clays.
constexpr float kRounding = 2.0f, kDeep = 2.0f;
constexpr float kQuiet = 6.0f;  ///< steps from the contact to the sheets in clay that show the noise

using Profile = std::array<float, 2 * kReach + 1>;

float trilinear(const BandDensity& density, const glm::vec3& p) {
  constexpr std::int64_t kSide = BrickMap<float>::kEdge;
  const glm::vec3 f = glm::floor(p), t = p - f;
  const auto x = static_cast<std::int64_t>(f.x), y = static_cast<std::int64_t>(f.y), z = static_cast<std::int64_t>(f.z);
  const auto sum = [&](const auto& value) {
    float values = 0.0f;
    for (int k = 0; k < 8; ++k) {
      const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
      const float w = (dx ? t.x : 1.0f - t.x) * (dy ? t.y : 1.0f - t.y) * (dz ? t.z : 1.0f - t.z);
      values += w * value(dx, dy, dz);
    }
    return values;
  };
  const auto in_one_brick = [](std::int64_t at) { return at >= 0 && at % kSide != kSide - 1; };
  if (in_one_brick(x) && in_one_brick(y) && in_one_brick(z))
    if (const float* const brick = density.brick(x / kSide, y / kSide, z / kSide)) {
      const float* const first = brick + (z % kSide * kSide + y % kSide) * kSide + x % kSide;
      return sum([&](int dx, int dy, int dz) { return first[(dz * kSide + dy) * kSide + dx]; });
    }
  return sum([&](int dx, int dy, int dz) { return density.get(x + dx, y + dy, z + dz); });
}

struct Dip {
  float way = 0.0f;    ///< steps from the middle of the profile
  float depth = 0.0f;  ///< below its ends
};

float depth_at(const Profile& profile, std::size_t at) {
  return 0.5f * (profile.front() + profile.back()) - profile[at];
}

/// The nearest dip of a profile: downhill from its middle, the vertex of a parabola.
Dip nearest_dip(const Profile& profile) {
  std::size_t at = kReach;
  while (at > 0 && profile[at - 1] < profile[at]) --at;
  if (at == kReach)
    while (at + 1 < profile.size() && profile[at + 1] < profile[at]) ++at;
  float steps = static_cast<float>(static_cast<int>(at) - kReach);
  if (at > 0 && at + 1 < profile.size()) {
    const float a = profile[at - 1], b = profile[at], c = profile[at + 1], bend = a - 2.0f * b + c;
    if (bend > 0.0f) steps += std::clamp(0.5f * (a - c) / bend, -0.5f, 0.5f);
  }
  return {kStep * steps, depth_at(profile, at)};
}

/// Where the density of one clay becomes that of the other: both have as much of the profile as this divides it.
float step_of(const Profile& profile, const ClayContrast& clays) {
  const float most = 0.5f * std::abs(clays.step()) + 2.0f * clays.deviation;  // beyond it are pores, grains and straw
  float sum = 0.0f;
  for (const float v : profile) sum += std::clamp(v - clays.middle(), -most, most);
  return -kStep * sum / clays.step();
}

class Follower {
 public:
  Follower(InterfaceMesh& mesh, const InterfaceRings& rings, const std::vector<glm::vec3>& dual_positions,
           const Following& follows, const BandDensity& density, const FollowOptions& options)
      : mesh_(mesh),
        rings_(rings),
        dual_(dual_positions),
        density_(density),
        options_(options),
        start_(mesh.added),
        moves_(follows.moves),
        step_(follows.step),
        trust_(mesh.added.size(), 0.0f) {
    find_near();
  }

  bool nothing_moves() const { return near_.empty(); }

  void find_normals() { normal_ = unit_normals(mesh_, rings_, dual_, 1); }

  /// The depth that a dip has by chance: that of sheets in the clay on both sides.
  void measure_noise() {
    std::vector<float> depths;
    for (const float away : {-kQuiet, kQuiet}) {
      const std::vector<Profile> profiles = mean_profiles(away);
      for (std::size_t i = 0; i < profiles.size(); ++i)
        if (moves_[i]) depths.push_back(std::abs(depth_at(profiles[i], kReach)));
    }
    noise_ = 1.4826f * median(std::move(depths));
  }

  std::vector<float> ways_to_dips() {
    const std::vector<Profile> profiles = mean_profiles(0.0f);
    const float doubt = kDoubt * noise_;
    std::vector<float> ways(profiles.size(), 0.0f);
    each([&](std::size_t i) {
      trust_[i] = 0.0f;
      if (!moves_[i]) return;
      const bool step = step_[i] && options_.clays;
      const Dip dip = step ? Dip{step_of(profiles[i], *options_.clays), std::abs(options_.clays->step())}
                           : nearest_dip(profiles[i]);
      const float depth = std::max(dip.depth, 0.0f);
      trust_[i] = depth * depth / std::max(depth * depth + doubt * doubt, 1e-30f);
      ways[i] = trust_[i] * std::clamp(dip.way, -kLeap, kLeap);
    });
    std::vector<float> weights = trust_;
    const int rings = options_.clays ? kStepRings : kProfileRings;
    average_rings(rings_, rings, near_, ways);
    average_rings(rings_, rings, near_, weights);
    each([&](std::size_t i) { ways[i] /= weights[i] + kFloor; });
    return ways;
  }

  /// Where dips say little, the contact becomes smooth.
  void settle() {
    if (!options_.rules.has(ContactRule::kSettle)) return;
    for (int round = 0; round < kSettleRounds; ++round) {
      std::vector<float> ways(mesh_.added.size(), 0.0f);
      each([&](std::size_t i) {
        if (!moves_[i] || rings_.all[i].empty()) return;
        const glm::vec3 off = mean_around(i) - mesh_.added[i];
        ways[i] = kSettle * (1.0f - trust_[i]) * glm::dot(off, normal_[i]);
      });
      move(ways, options_.most);
    }
  }

  /// A blurred sheet is darkest on the hollow side of where it is, by the variance of the blur times its mean
  /// curvature; one that was averaged along itself lies there, too.
  std::vector<float> ways_out_of_the_hollow() const {
    std::vector<float> ways(mesh_.added.size(), 0.0f);
    const std::vector<float> depths = dent_depths(mesh_, rings_, dual_);
    each([&](std::size_t i) {
      float bend = 0.0f, squares = 0.0f;
      rings_.all.each(i, [&](std::uint32_t w, float weight) {
        const glm::vec3 off = position(w, mesh_.added) - mesh_.added[i];
        bend += weight * glm::dot(off, normal_[i]);
        squares += weight * glm::dot(off, off);
      });
      const float in_dent = options_.clays || !options_.rules.has(ContactRule::kRounding)
                                ? 0.0f
                                : std::clamp(depths[i] - kDeep, 0.0f, 1.0f);
      const float variance = options_.blur_variance + kLowPass + kRounding * in_dent;
      if (squares > 0.0f) ways[i] = -2.0f * variance * bend / squares;
    });
    average_rings(rings_, kBendRings, near_, ways);
    each([&](std::size_t i) { ways[i] = std::clamp(ways[i], -kMostHollow, kMostHollow); });
    return ways;
  }

  void move(const std::vector<float>& ways, float most) {
    each([&](std::size_t i) {
      if (!moves_[i]) return;
      const glm::vec3 way = mesh_.added[i] + ways[i] * normal_[i] - start_[i];
      const float length = glm::length(way);
      mesh_.added[i] = start_[i] + (length > most ? most / length : 1.0f) * way;
    });
  }

  /// Corners stay evenly apart, so that triangles do not fold.
  void spread() {
    std::vector<glm::vec3> moved = mesh_.added;
    each([&](std::size_t i) {
      if (!moves_[i] || rings_.all[i].empty()) return;
      const glm::vec3 off = mean_around(i) - mesh_.added[i];
      moved[i] += kSpread * (off - glm::dot(off, normal_[i]) * normal_[i]);
    });
    mesh_.added.swap(moved);
  }

  /// Corners of triangles that turned over go back to where they were.
  void unfold() {
    constexpr int kMostRounds = 10;  // what goes back may fold its neighbours
    std::vector<bool> back(mesh_.added.size(), false);
    std::vector<std::uint8_t> folded(mesh_.triangles.size());
    bool any = true;
    for (int round = 0; round < kMostRounds && any; ++round) {
      any = false;
      each_vertex(folded.size(), [&](std::size_t i) {
        const Triangle& t = mesh_.triangles[i];
        const glm::vec3 now = area_vector(t, mesh_.added), before = area_vector(t, start_);
        folded[i] = !(glm::dot(now, before) > kLeastCosine * glm::length(now) * glm::length(before));
      });
      for (std::size_t i = 0; i < folded.size(); ++i) {
        if (folded[i] == 0) continue;
        for (const std::uint32_t v : mesh_.triangles[i])
          if (v >= dual_.size() && !back[v - dual_.size()]) back[v - dual_.size()] = any = true;
      }
      for (std::size_t i = 0; i < back.size(); ++i)
        if (back[i]) mesh_.added[i] = start_[i];
    }
  }

 private:
  /// Those that move, and as many rings around them as anything is averaged over.
  void find_near() {
    constexpr int kMostRings = std::max({kProfileRings, kStepRings, kBendRings});
    std::vector<bool> seen(moves_.size(), false);
    for (std::uint32_t i = 0; i < moves_.size(); ++i)
      if (moves_[i]) {
        seen[i] = true;
        near_.push_back(i);
      }
    for (std::size_t ring = 0, begin = 0; ring < kMostRings; ++ring) {
      const std::size_t end = near_.size();
      for (; begin < end; ++begin)
        for (const std::uint32_t w : rings_.added[near_[begin]])
          if (!seen[w]) {
            seen[w] = true;
            near_.push_back(w);
          }
    }
    std::sort(near_.begin(), near_.end());
  }
  /// Density along lines across the contact, averaged along it; their middles are `away` from it.
  std::vector<Profile> mean_profiles(float away) const {
    std::vector<Profile> profiles(mesh_.added.size());
    each([&](std::size_t i) {
      for (std::size_t s = 0; s < profiles[i].size(); ++s)
        profiles[i][s] = trilinear(
            density_, mesh_.added[i] + (away + kStep * static_cast<float>(static_cast<int>(s) - kReach)) * normal_[i]);
    });
    average_rings(rings_, kProfileRings, near_, profiles);
    return profiles;
  }
  glm::vec3 mean_around(std::size_t i) const {
    glm::vec3 mean(0.0f);
    const float weights =
        rings_.all.each(i, [&](std::uint32_t w, float weight) { mean += weight * position(w, mesh_.added); });
    return mean / weights;
  }
  glm::vec3 position(std::uint32_t v, const std::vector<glm::vec3>& added) const {
    return v < dual_.size() ? dual_[v] : added[v - dual_.size()];
  }
  glm::vec3 area_vector(const Triangle& t, const std::vector<glm::vec3>& added) const {
    const glm::vec3 a = position(t[0], added);
    return glm::cross(position(t[1], added) - a, position(t[2], added) - a);
  }
  template <class Work>
  void each(const Work& work) const {
    parallel_for(static_cast<std::int64_t>(near_.size()), 256,
                 [&](std::int64_t k) { work(std::size_t{near_[static_cast<std::size_t>(k)]}); });
  }

  InterfaceMesh& mesh_;
  const InterfaceRings& rings_;
  const std::vector<glm::vec3>& dual_;
  const BandDensity& density_;
  const FollowOptions& options_;
  std::vector<glm::vec3> start_, normal_;
  const std::vector<bool>& moves_;
  const std::vector<bool>& step_;
  std::vector<std::uint32_t> near_;  ///< what is looked at
  std::vector<float> trust_;         ///< in the place of each dip, 0..1
  float noise_ = 0.0f;               ///< of the depth of a dip
};

}  // namespace

void follow_dips(InterfaceMesh& mesh, const InterfaceRings& rings, const std::vector<glm::vec3>& dual_positions,
                 const Following& follows, const BandDensity& density, const FollowOptions& options) {
  Follower follower(mesh, rings, dual_positions, follows, density, options);
  if (follower.nothing_moves()) return;
  follower.find_normals();
  follower.measure_noise();
  for (int round = 0; round < kRounds; ++round) {
    follower.find_normals();
    follower.move(follower.ways_to_dips(), options.most);
    follower.settle();
    follower.spread();
  }
  follower.find_normals();
  if (options.rules.has(ContactRule::kHollow))
    follower.move(follower.ways_out_of_the_hollow(), options.most + kMostHollow);
  for (int round = 0; round < 2; ++round) {
    follower.find_normals();
    follower.spread();
  }
  follower.unfold();
}

}  // namespace dubsar
