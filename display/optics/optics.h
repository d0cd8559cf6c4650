#pragma once
// Optical simulator: a panel image behind a lens sheet, and an eye in front of it. What does that eye see, and how much
// of it was meant for the other? The acceptance test of every sink and a tool for users (`render --see-from X,Y,Z`).

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/image_io/image.h"
#include "display/optics/weave.h"

namespace dubsar {

/// How much light of a subpixel reaches the eye: the lens images a point of the subpixel plane to the eye, blurred by
/// lens.spot_sigma_periods and by the subpixel's own extent (a third of a pixel wide, a pixel high, the height seen
/// through the slant). `phase` is eye_phase() of the subpixel's centre. Not normalised, 1 at most.
double visibility(const LensOptics& lens, double phase) noexcept;

/// What an eye sees of a panel image, one output pixel a panel pixel: for each colour the mean of the subpixels around
/// it (one lens period to either side, in its row), weighted by visibility, in linear light.
Image see(const Image& panel_image, const TrackedPanel& panel, const glm::dvec3& eye_mm);

/// Share of wrong-eye light (0..1) that each eye gets at its true place when the panel was woven for `woven_for`.
struct Crosstalk {
  double left = 0.0, right = 0.0;
  double worst() const noexcept { return left > right ? left : right; }
};
Crosstalk wrong_eye_light(const TrackedPanel& panel, const EyePair& woven_for, const EyePair& true_eyes,
                          bool exact_weave = true, int step_px = 16);

/// Light of each of N views that an eye gets from an N-view sheet (shares, sum 1). The sheet's phase figures say which
/// view a subpixel shows; `lens` describes the same sheet in millimetres.
std::vector<double> view_shares(const LensSheet& sheet, const TrackedPanel& panel, int views, const glm::dvec3& eye_mm,
                                int step_px = 16);

/// A panel's lenses, and which view each of its subpixels shows.
struct PanelLight {
  TrackedPanel panel;
  std::optional<LensSheet> sheet;  ///< N views; none: two views (0 left, 1 right) woven for `woven_for`
  EyePair woven_for;
  int views = 2;
  int own_views = 0;  ///< views to either side of the main one that still belong to the same eye
};

struct EyeLight {
  std::vector<double> shares;  ///< of each view, sum 1
  int main_view = 0;           ///< the one with the greatest share
  double crosstalk = 0.0;      ///< share of the views farther from main_view than PanelLight::own_views
};
EyeLight light_at(const PanelLight& light, const glm::dvec3& eye_mm, int step_px = 16);

/// The same sheet as optics. Pitch and slant follow from the sheet and the panel's size; the reduced gap from the view
/// cone (an eye that crosses the cone at `distance_mm` crosses one lens period); the lens pitch is a little finer than
/// the pattern so that an eye at that distance sees one view all over the panel; the middle view is in front.
TrackedPanel optics_of_sheet(const LensSheet& sheet, double width_mm, double view_cone_rad, double distance_mm,
                             double refractive_index = 1.5, double spot_sigma_periods = 0.02);

}  // namespace dubsar
