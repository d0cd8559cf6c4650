#pragma once
// The relief of a surface explained by imprints: as few of them as it takes, together, as neighbours dig into each
// other.

#include <array>
#include <functional>
#include <vector>

#include "core/script/surface_levels.h"
#include "core/script/wedge_sites.h"

namespace dubsar {

inline constexpr double kNoTurn = 1.0;

/// On the clay (docs/edition.md), usual widths: T to the tail's end, and between the corners.
struct WedgeOutline {
  double reach = 0.0, width = 0.0;
};

/// An imprint at its place, mm.
struct PlacedImprint {
  glm::dvec3 foot{0.0}, normal{0, 0, 1}, along{1, 0, 0};  ///< foot: on the writing surface, above T
  Imprint imprint;                                        ///< in units of the usual width
  glm::dvec3 head{0.0}, end{0.0};  ///< middle of the head's edge and end of the tail, on the writing surface
  double depth = 0.0;              ///< of the clay below the writing surface, usual widths
  std::size_t site = 0;
  double gain = 0.0;    ///< what it explains that nothing else does
  double margin = 0.0;  ///< by how much the best other direction explains less
  /// What it explains less turned by a third, counterclockwise and clockwise; kNoTurn where that fits nowhere.
  std::array<double, 2> thirds{};
  double misfit = 0.0;   ///< median of what is left in its footprint, either way, of its depth
  double seen = 1.0;     ///< of its window
  double covered = 0.0;  ///< share of its footprint that others explain
  WedgeOutline outline;
};

struct PressedPair {
  std::size_t later = 0, earlier = 0;
  double clear = 0.0;  ///< by how much more the earlier one is filled than the later one, of a usual depth
};

class ReliefExplanation {
 public:
  /// Fits each place alone, to begin with. `surface` must outlive it. Cost: some ms a place, all threads.
  ReliefExplanation(SurfaceLevels& surface, const WedgeScale& scale, const std::vector<DeepPlace>& places);

  /// Begins with what explains most, and goes on until nothing gains a fifth of what a usual one does any more, at most
  /// `most_cost`: each round fits all imprints anew beside the others, drops those that gain less, turns those that
  /// explain more otherwise, splits those that are two, and takes in others.
  void explain(int rounds, double most_cost);
  /// What a wedge of this surface explains in the median; 0 without any.
  double usual_gain() const;

  /// From the next round on: how surprising a direction is at a place, in nats. What fits as well two ways is told by
  /// it, what has a tail hardly is. Called by several threads at once.
  using Surprise = std::function<double(const glm::dvec3& along, const glm::dvec3& normal, const Imprint& imprint)>;
  void prefer(Surprise surprise) { surprise_ = std::move(surprise); }

  /// Depth, misfit, covered and outline are left at what they are to begin with.
  std::vector<PlacedImprint> placed() const;
  /// With them. Cost: some milliseconds each.
  std::vector<PlacedImprint> measured() const;
  /// Which of overlapping wedges was pressed after which: numbers in `placed`, of this explanation; what is not clear
  /// is left out. A later one is whole, and pushes clay into those before it: where they meet, these are shallower than
  /// their planes. Empty where wedges that meet are no shallower than that: no clay was pushed. Cost: a millisecond a
  /// pair.
  std::vector<PressedPair> pressing_order(const std::vector<PlacedImprint>& placed) const;

 private:
  struct Fit {
    std::vector<ImprintStart> ways;  ///< by rising energy
    Imprint imprint;
    bool active = false;
    bool hopeless = false;  ///< explained too little beside the others to be tried again
    double gain = 0.0, margin = 0.0;
    std::array<double, 2> thirds{kNoTurn, kNoTurn};
  };
  void drop_broad();
  void fit_alone(std::size_t k);
  void find_neighbours();
  void look_beside(std::size_t k, DepthSamples& samples) const;
  void add_other(const WedgeSite& site, const PlacedImprint& other, DepthSamples& samples) const;
  /// What the clay is shallower than planes are, on the side of each of two wedges where they meet.
  struct Meeting {
    double sums[2] = {0.0, 0.0}, weights[2] = {0.0, 0.0};
    int counts[2] = {0, 0};
  };
  void add_meeting(const PlacedImprint& one, const PlacedImprint& other, bool first, Meeting& meeting) const;
  void fit_beside(std::size_t k, Fit& out) const;
  /// Another imprint in the same window, and how the first one looks beside it; nothing where that gains too little.
  struct Second {
    Imprint first, second;
    double gain = 0.0, least = 0.0;  ///< that two have to explain more than one
  };
  /// `both`: the first one is looked for anew, too, in any direction.
  Second second_in(std::size_t k, bool both) const;
  void split(double cost);
  double gain_beside(std::size_t k, const Imprint& imprint, DepthSamples& samples) const;
  /// A place of the writing surface so many usual widths from T along the tail, mm.
  glm::dvec3 on_axis(std::size_t k, double along) const;
  PlacedImprint placed_at(std::size_t k) const;
  void measure(PlacedImprint& one) const;
  /// What is seen of one wedge's outline, usual widths from T.
  struct Outline {
    double reach = 0.0, breadth = 0.0;  ///< 0: not seen
    double least = 0.0, most = 0.0;     ///< the tail is still deep at one, level clay is seen at the other
    bool seen = false;                  ///< the groove, where it ends
  };
  Outline outline_of(const PlacedImprint& one, const std::vector<Imprint>& drawn) const;
  void draw_outlines(std::vector<PlacedImprint>& placed) const;
  bool deepest_vertex(const PlacedImprint& one, double& x, double& y, double& height) const;

  double doubt(const WedgeSite& site, const Imprint& imprint) const;

  const PatchCells *fine_, *cells_;
  WedgeScale scale_;
  Surprise surprise_;
  std::vector<WedgeSite> sites_;
  std::vector<Fit> fits_;
  std::vector<std::vector<std::uint32_t>> near_;
};

}  // namespace dubsar
