#pragma once
// The imprint of a stylus as a model, and its fit to the depth of a patch.
//
// Head: three planes, D (1 + a / back) before the tip T, D (1 - a / front) - k |b| behind it; a groove of half the
// head's width runs on behind it to the tail's end. Without the groove this is the tetrahedron of docs/edition.md.

#include <array>
#include <cstddef>
#include <vector>

namespace dubsar {

/// Lengths in units of the tablet's usual width of a head; a along the tail, b across. Log: so that they stay positive.
struct Imprint {
  enum : std::size_t { kX, kY, kAngle, kWidth, kDepth, kBack, kFront, kTail, kCount };
  /// x, y of T; radians counterclockwise; log width, log depth, log of back, front and tail over the width.
  std::array<double, kCount> p{};
  bool tailed = false;    ///< else p[kTail] means nothing
  double rounding = 0.0;  ///< of the inner edges between planes: a tip is about a third of it shallower than the planes

  double width() const;
  double depth() const;
  double back() const;
  double front() const;
  /// From T to the end: of the groove, or of the head where that is longer.
  double reach() const;
};

/// Places of a patch and how deep they are, in the same units; arrays of one length.
struct DepthSamples {
  std::vector<float> x, y, depth, weight;
  std::vector<float> level;   ///< of the writing surface, along the patch's normal
  std::vector<float> others;  ///< depth that other imprints explain
  float area = 1.0f;          ///< that one sample stands for
  std::size_t size() const noexcept { return x.size(); }
};

/// What is usual on a tablet, in widths of its heads: depth of its wedges, and how round their inner edges are.
struct UsualImprint {
  double depth = 0.5, rounding = 0.0;
};

struct FitOptions {
  double deeper = 1.0;  ///< what clay deeper than the model costs, of what shallower clay costs
  int rounds = 12;      ///< of Gauss and Newton
};

inline constexpr FitOptions kFitAlone{0.5, 12};  ///< a neighbour only digs deeper
inline constexpr FitOptions kFitTogether{1.0, 8};
inline constexpr int kStartDirections = 24;

/// Radians between two directions, 0 to pi.
double angle_apart(double a, double b);

/// Depth of the model at each sample, 0 beside it.
void imprint_depths(const Imprint& imprint, const DepthSamples& samples, std::vector<float>& out);

/// How the places of one patch lie to an imprint of another: along it, across it and above its writing surface, each
/// [0] + [1] x + [2] y + [3] level.
struct ImprintView {
  std::array<float, 4> along{}, across{}, above{};
};
/// Raises `samples.others` to what an imprint of another patch explains there. What is more than kOtherSheet widths off
/// its surface is another sheet.
void explain_by_other(const Imprint& imprint, const ImprintView& view, DepthSamples& samples);

/// The sum over the samples of weight, area and rho(depth - max(model, others)), rho(r) as r^2 where that is small and
/// bounded (Geman, McClure), plus what is unlikely about the imprint itself.
double imprint_energy(const Imprint& imprint, const DepthSamples& samples, const UsualImprint& usual,
                      const FitOptions& options);
/// The same without an imprint.
double empty_energy(const DepthSamples& samples, const FitOptions& options);

/// Moves to a least energy nearby (Levenberg, Marquardt; reweighted). Returns it.
double fit_imprint(Imprint& imprint, const DepthSamples& samples, const UsualImprint& usual, const FitOptions& options);

/// Starts for fits: the best of a set of templates for each of `directions` directions, with its energy.
struct ImprintStart {
  Imprint imprint;
  double energy = 0.0;
};
std::vector<ImprintStart> imprint_starts(const DepthSamples& samples, const UsualImprint& usual, double x, double y,
                                         int directions, const FitOptions& options);

}  // namespace dubsar
