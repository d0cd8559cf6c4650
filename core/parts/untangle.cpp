#include "core/parts/untangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tuple>
#include <unordered_set>

#include "core/base/system/log.h"
#include "core/base/system/parallel_gather.h"
#include "core/mesh/evidence.h"
#include "core/mesh/intersections.h"
#include "core/parts/crossing_pairs.h"
#include "core/parts/leash.h"
#include "core/parts/patch_moves.h"
#include "core/parts/triangle_grid.h"

namespace dubsar {
namespace {

constexpr int kMostSplits = 2;
constexpr std::uint32_t kNone = TangleOwner::kNoPatch;
constexpr std::int64_t kTangleGrain = 1 << 14;
constexpr float kBeside = 6.0f;  ///< steps that moves reach
constexpr float kAside = 8.0f;   ///< around a place where a patch is another one now
using Pairs = CrossingPairs;

/// The places as multiples of `step`, no two at one: rounding, and smoothing of tiny islands, bring some together.
std::vector<glm::vec3> apart_in_steps(std::span<const glm::vec3> places, double step) {
  std::unordered_set<std::uint64_t> taken;
  taken.reserve(places.size());
  const auto key = [step](const glm::vec3& place) {
    std::uint64_t bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto steps = std::llround(static_cast<double>(place[axis]) / step);
      bits = bits << 21 | (static_cast<std::uint64_t>(steps) & 0x1fffff);
    }
    return bits;
  };
  std::vector<glm::vec3> apart(places.begin(), places.end());
  for (glm::vec3& place : apart) {
    place = in_steps(place, step);
    while (!taken.insert(key(place)).second) place.x += static_cast<float>(step);
  }
  return apart;
}

/// Patches and the surface beside them as one list of triangles.
class Tangle {
 public:
  Tangle(SurfaceModel& model, const Triangulation& surface, std::span<const glm::vec3> home, double step)
      : model_(model), step_(step), dual_(model.mesh.positions.size()), home_(home.begin(), home.end()) {
    positions_ = model.mesh.positions;
    positions_.insert(positions_.end(), surface.steiner.begin(), surface.steiner.end());
    first_extra_ = static_cast<std::uint32_t>(positions_.size());
    for (std::size_t p = 0; p < model.patches.size(); ++p)
      if (!inside_body(model.patches[p])) add_patch(p);
    add_surface(surface);
    if (!home_.empty()) home_.insert(home_.end(), positions_.begin() + first_extra_ + home.size(), positions_.end());
  }

  /// Pairs of crossing triangles that matter, rising.
  Pairs crossings() const {
    std::vector<std::uint8_t> of_patch(triangles_.size());
    for (std::size_t t = 0; t < of_patch.size(); ++t) of_patch[t] = owner_[t].patch != kNone;
    return crossing_pairs(positions_, triangles_, of_patch, [this](auto a, auto b) { return matters(a, b); });
  }

  /// Those among them of which a triangle is not settled (UntangleHelp).
  Pairs unsettled_crossings(std::span<const std::uint8_t> settled, std::span<const glm::vec3> aside) const {
    std::vector<TriangleBox> boxes;
    for (const glm::vec3& place : aside) boxes.push_back(TriangleBox{place, place}.grown(kAside));
    const BrickSet near(boxes);
    std::vector<std::uint8_t> loose(triangles_.size());
    for (std::size_t t = 0; t < loose.size(); ++t) {
      const auto is_loose = [&](std::uint32_t v) {
        return v >= first_extra_ && (v - first_extra_ >= settled.size() || settled[v - first_extra_] == 0);
      };
      loose[t] = std::any_of(triangles_[t].begin(), triangles_[t].end(), is_loose) ||
                 near.meets(box_of(positions_, triangles_[t]));
    }
    return crossing_pairs_after({}, positions_, triangles_, loose, [this](auto a, auto b) { return matters(a, b); });
  }

  /// The same where they were `before` all that has changed since the last call.
  Pairs crossings_after(Pairs before) {
    std::vector<std::uint8_t> changed(triangles_.size(), 0);
    changed_.resize(changed.size(), 0);
    changed.swap(changed_);
    return crossing_pairs_after(std::move(before), positions_, triangles_, changed,
                                [this](auto a, auto b) { return matters(a, b); });
  }

  /// The middles of the pairs.
  std::vector<glm::vec3> places(const Pairs& pairs) const {
    std::vector<glm::vec3> middles;
    for (const auto& pair : pairs) {
      glm::vec3 sum(0.0f);
      for (const std::uint32_t t : pair)
        for (const std::uint32_t v : triangles_[t]) sum += positions_[v];
      middles.push_back(sum / 6.0f);
    }
    return middles;
  }

  /// Moves vertices of the pairs and of those that they come to cross.
  void move(const Pairs& pairs) {
    changed_.resize(triangles_.size(), 0);
    moved_.resize(positions_.size() - first_extra_, 0);
    PatchMoves(mesh_, step_, beside(pairs)).run(pairs, moved_, changed_);
  }

  bool has_home() const { return !home_.empty(); }

  /// Vertices near the pairs go back to where they have come from.
  void retreat(const Pairs& pairs) {
    changed_.resize(triangles_.size(), 0);
    moved_.resize(positions_.size() - first_extra_, 0);
    const std::vector<float> free = leashes(std::span(positions_).subspan(first_extra_), places(pairs));
    for (std::size_t i = 0; i < free.size(); ++i) {
      glm::vec3& p = positions_[first_extra_ + i];
      const glm::vec3 back = in_steps(glm::mix(home_[i], p, free[i]), step_);
      if (back == p) continue;
      p = back;
      moved_[i] = 1;
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (const std::uint32_t v : triangles_[t])
        if (v >= first_extra_ && free[v - first_extra_] < 1.0f) changed_[t] = 1;
  }

  /// Puts a vertex on the longest edge inside a patch of each triangle in a pair. Returns how many.
  std::int64_t split(const Pairs& pairs) {
    std::int64_t splits = 0;
    std::vector<bool> touched(triangles_.size(), false);
    index_sides(pairs);
    for (const auto& pair : pairs)
      for (const std::uint32_t t : pair)
        if (owner_[t].patch != kNone && !touched[t]) splits += split_triangle(t, touched);
    return splits;
  }

  /// Of the first patch, by ids of the model and of what the patch added.
  std::vector<PatchSplit> splits() const {
    std::vector<PatchSplit> out = splits_;
    const std::vector<std::uint32_t> place = places_in_patches();
    const auto of_model = [&](std::uint32_t v) {
      return v < first_extra_ ? v : static_cast<std::uint32_t>(dual_ + place[v - first_extra_]);
    };
    for (PatchSplit& split : out) split = {of_model(split.a), of_model(split.b)};
    return out;
  }

  std::int64_t moved() const { return std::count(moved_.begin(), moved_.end(), 1); }

  /// Back into the model.
  void store() const {
    const std::vector<std::uint32_t> place = places_in_patches();
    std::vector<std::vector<std::uint32_t>> extras(model_.patches.size()), own(model_.patches.size());
    for (std::size_t i = 0; i < place.size(); ++i)
      extras[patch_of_vertex_[i]].push_back(first_extra_ + static_cast<std::uint32_t>(i));
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (owner_[t].patch != kNone) own[owner_[t].patch].push_back(t);
    for (std::size_t p = 0; p < model_.patches.size(); ++p) {
      FillPatch& patch = model_.patches[p];
      if (inside_body(patch)) continue;
      patch.extra_positions.resize(extras[p].size());
      if (!patch.evidence.empty()) patch.evidence.resize(extras[p].size(), evidence_byte(Evidence::kInferred));
      for (std::size_t i = 0; i < extras[p].size(); ++i) patch.extra_positions[i] = positions_[extras[p][i]];
      patch.triangles.clear();
      for (const std::uint32_t t : own[p]) {
        Triangle out = triangles_[t];
        for (std::uint32_t& v : out)
          if (v >= first_extra_) v = static_cast<std::uint32_t>(dual_ + place[v - first_extra_]);
        patch.triangles.push_back(out);
      }
    }
  }

 private:
  PartitionId body_of(PartitionId id) const {
    return id == PartitionTable::kNone || model_.partitions.empty() ? id : model_.partitions.body_of(id);
  }

  /// Of each added vertex among those of its patch.
  std::vector<std::uint32_t> places_in_patches() const {
    std::vector<std::uint32_t> place(patch_of_vertex_.size()), count(model_.patches.size(), 0);
    for (std::size_t i = 0; i < place.size(); ++i) place[i] = count[patch_of_vertex_[i]]++;
    return place;
  }

  /// A membrane across a crack: bodies are shown without it.
  bool inside_body(const FillPatch& patch) const {
    return body_of(patch.partition) == body_of(patch.reverse_partition);
  }

  void add_patch(std::size_t p) {
    const FillPatch& patch = model_.patches[p];
    const auto base = static_cast<std::uint32_t>(positions_.size());
    for (const glm::vec3& place : apart_in_steps(patch.extra_positions, step_)) positions_.push_back(place);
    patch_of_vertex_.resize(positions_.size() - first_extra_, static_cast<std::uint32_t>(p));
    for (Triangle t : patch.triangles) {
      for (std::uint32_t& v : t)
        if (v >= dual_) v = static_cast<std::uint32_t>(v - dual_ + base);
      triangles_.push_back(t);
      owner_.push_back({static_cast<std::uint32_t>(p), body_of(patch.partition), body_of(patch.reverse_partition)});
    }
  }

  /// The triangles of the surface beside those of patches, in their order.
  void add_surface(const Triangulation& surface) {
    std::vector<TriangleBox> boxes;
    for (const Triangle& t : triangles_) boxes.push_back(box_of(positions_, t).grown(1.0f));
    const BrickSet near(boxes);
    const Pairs found = parallel_gather<Pairs::value_type>(  // a triangle and its x-quad
        model_.mesh.quad_count(), kTangleGrain, [&](std::int64_t begin, std::int64_t end, Pairs& part) {
          for (auto q = static_cast<std::uint32_t>(begin); q < static_cast<std::uint64_t>(end); ++q)
            for (std::uint32_t t = surface.first_triangle[q]; t < surface.first_triangle[q + 1]; ++t)
              if (near.meets(box_of(positions_, surface.triangles[t]))) part.push_back({t, q});
        });
    for (const auto& [t, q] : found) {
      triangles_.push_back(surface.triangles[t]);
      const PartitionId body = body_of(model_.quad_partition.empty() ? PartitionId{0} : model_.quad_partition[q]);
      owner_.push_back({kNone, body, PartitionTable::kNone});
    }
  }

  bool matters(std::uint32_t a, std::uint32_t b) const { return owner_[a].matters_to(owner_[b]); }

  std::vector<std::uint32_t> beside(const Pairs& pairs) const {
    std::vector<TriangleBox> boxes;
    for (const auto& pair : pairs)
      for (const std::uint32_t t : pair) boxes.push_back(box_of(positions_, triangles_[t]).grown(kBeside));
    return triangles_in(BrickSet(boxes), positions_, triangles_);
  }

  std::int64_t split_triangle(std::uint32_t t, std::vector<bool>& touched) {
    float longest = 0.0f;
    std::uint32_t a = 0, b = 0, beyond = kNone;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles_[t][i], to = triangles_[t][(i + 1) % 3];
      const std::uint32_t other = across(t, from, to);
      const float length = glm::distance(positions_[from], positions_[to]);
      if (other == kNone || touched[other] || length <= longest) continue;
      std::tie(longest, a, b, beyond) = std::tuple(length, from, to, other);
    }
    if (beyond == kNone) return 0;
    touched[t] = touched[beyond] = true;
    const auto middle = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(in_steps(0.5f * (positions_[a] + positions_[b]), step_));
    if (!home_.empty()) {
      const auto home = [&](std::uint32_t v) { return v < first_extra_ ? positions_[v] : home_[v - first_extra_]; };
      home_.push_back(0.5f * (home(a) + home(b)));
    }
    patch_of_vertex_.push_back(owner_[t].patch);
    if (owner_[t].patch == 0) splits_.push_back({a, b});
    changed_.resize(triangles_.size() + 2, 1);
    for (const std::uint32_t side : {t, beyond}) {
      changed_[side] = 1;
      triangles_.push_back(halve(triangles_[side], a, b, middle));
      owner_.push_back(owner_[side]);
      touched.push_back(true);
    }
    return 1;
  }

  /// The sides of triangles of patches in pairs, as all are now. Splitting leaves those of triangles that it does not
  /// touch.
  void index_sides(const Pairs& pairs) {
    sides_ = {};
    for (const auto& pair : pairs)
      for (const std::uint32_t t : pair)
        for (std::size_t i = 0; i < 3; ++i) sides_.want(triangles_[t][i], triangles_[t][(i + 1) % 3]);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (owner_[t].patch != kNone) sides_.add(t, triangles_[t]);
  }

  /// The one other triangle of the patch on the edge that runs from `to` to `from`.
  std::uint32_t across(std::uint32_t t, std::uint32_t from, std::uint32_t to) const {
    std::uint32_t found = kNone;
    for (const std::uint32_t other : sides_.triangles(from, to)) {
      if (other == t || owner_[other].patch != owner_[t].patch) continue;
      if (found != kNone) return kNone;
      found = other;
    }
    return found;
  }

  SurfaceModel& model_;
  double step_;
  std::size_t dual_;
  TangleMesh mesh_;  ///< triangles: those of patches, of the surface, then what splitting added
  std::vector<glm::vec3>& positions_ = mesh_.positions;
  std::vector<Triangle>& triangles_ = mesh_.triangles;
  std::vector<TangleOwner>& owner_ = mesh_.owner;
  std::uint32_t& first_extra_ = mesh_.first_extra;
  std::vector<std::uint32_t> patch_of_vertex_;  ///< of positions from first_extra_ on
  std::vector<glm::vec3> home_;                 ///< the same, if there are any
  SideTable sides_;                             ///< see index_sides()
  std::vector<PatchSplit> splits_;              ///< of the first patch
  std::vector<std::uint8_t> moved_;             ///< of positions from first_extra_ on, as far as moves have come
  std::vector<std::uint8_t> changed_;           ///< triangles, see crossings_after()
};

}  // namespace

Result<UntangleReport> untangle_patches(SurfaceModel& model, double step, Progress& progress,
                                        const UntangleHelp& help) {
  UntangleReport report;
  if (model.patches.empty()) return report;
  progress.begin("untangle", kMostSplits + 1, "round");
  Triangulation own;
  if (help.surface == nullptr) own = triangulate(model.mesh, model.attributes.normals, 0, FacePoints::kNone);
  Tangle tangle(model, help.surface != nullptr ? *help.surface : own, help.home, step);
  const bool known = !help.settled.empty();
  auto pairs = known ? tangle.unsettled_crossings(help.settled, help.aside) : tangle.crossings();
  report.crossings = static_cast<std::int64_t>(pairs.size());
  const auto look_again = [&] { pairs = tangle.crossings_after(std::move(pairs)); };
  const auto move = [&] {
    tangle.move(pairs);
    look_again();
    progress.advance(1);
  };
  for (int round = 0; round <= kMostSplits && !pairs.empty(); ++round) {
    if (progress.cancelled()) return cancelled_error();
    if (round > 0) report.added += tangle.split(pairs);
    move();
  }
  if (!pairs.empty() && tangle.has_home()) {  // splits would make more of them now
    tangle.retreat(pairs);
    look_again();
    move();
  }
  if (known && pairs.empty()) {
    pairs = tangle.crossings();
    if (!pairs.empty()) move();
  }
  report.left = tangle.places(pairs);
  report.splits = tangle.splits();
  report.moved = tangle.moved();
  tangle.store();
  if (report.crossings > 0)
    log_debug("patches: {} pairs of triangles crossed, {} do after {} vertices were moved and {} added",
              report.crossings, report.left.size(), report.moved, report.added);
  progress.end();
  return report;
}

}  // namespace dubsar
