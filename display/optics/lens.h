#pragma once
// The one lens core: a lenticular sheet over subpixels. Slanted N-view sheets, Looking Glass panels and head-tracked
// two-view weaves differ in their figures, not in their code. Pure mathematics, double precision: the reference that
// the shaders are tested against.

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

/// Positions of the red, green and blue subpixels relative to the pixel's own position, in pixels, y up.
struct SubpixelCell {
  std::array<glm::dvec2, 3> offset_px{glm::dvec2{0.0, 0.0}, {1.0 / 3.0, 0.0}, {2.0 / 3.0, 0.0}};
  friend bool operator==(const SubpixelCell&, const SubpixelCell&) = default;
};

/// How the cell of a pixel is chosen from its integer coordinates (vendor numbering 0..4).
enum class CellPattern : int { kUniform = 0, kCheckerboard = 1, kColumns = 2, kShiftedRows = 3, kRows = 4 };

/// Where the subpixels are: which cell a pixel has, and the cells.
struct SubpixelLayout {
  CellPattern pattern = CellPattern::kUniform;
  std::vector<SubpixelCell> cells = std::vector<SubpixelCell>(1);  ///< at least one
  /// Offset in pixels of channel k of pixel (x, y); y counts from the bottom.
  glm::dvec2 offset_px(std::int64_t x, std::int64_t y, int channel) const noexcept;
};

/// How a fractional view position becomes a colour (vendor numbering 0..3). Linear mixes the views floor(p) and
/// floor(p)
/// + 1; the Gaussians mix 3 and 21 views, view v lying at p = v, as the maker has it: half a view from where nearest
/// has its middle.
enum class ViewFilter : int { kNearest = 0, kLinear = 1, kGaussian3 = 2, kGaussian10 = 3 };

/// A sheet in the terms of the shader: with u to the right and v up, both 0..1 over the whole panel, a subpixel lies at
/// lens phase a = (u + v * tilt) * periods - centre. fract(a) is its place across its lens.
struct LensSheet {
  int width_px = 0, height_px = 0;  ///< panel
  double periods = 0.0;             ///< lens periods across the panel's width
  double tilt = 0.0;                ///< lens slant in (u, v)
  double centre = 0.0;              ///< phase offset in periods
  bool invert_views = true;         ///< view order reversed across a lens
  SubpixelLayout subpixels;
  /// Coded colours are multiplied by 1 - |fringe| in every second row: the even ones from the bottom where it is above
  /// 0, else the odd ones. Some panels of 15.6" and 8K carry such a figure, and the maker's own weave (HoloPlay SDK for
  /// Unity) dims coded colours by it.
  double fringe = 0.0;
};

/// What figures of lens sheets may be; beyond, a calibration is not believed. Known panels have 37 to 110 lenses an
/// inch, slopes of 5 to 8 and centres within a few periods.
inline constexpr double kLeastPitch = 5.0, kMostPitch = 500.0;  ///< lenses per inch
inline constexpr double kLeastSlope = 0.5, kMostSlope = 1e4;    ///< of either sign; upright lenses have the largest
inline constexpr double kMostCentre = 100.0;                    ///< periods, of either sign

/// Figures of a Looking Glass calibration from which a sheet follows (the calibration file's own names and units).
struct LookingGlassFigures {
  double pitch = 0.0;   ///< lenses per inch across the lens axis
  double slope = 0.0;   ///< dy/dx of the lens axis, not 0
  double center = 0.0;  ///< phase in periods
  double dpi = 0.0;
  int screen_width = 0, screen_height = 0;  ///< pixels
  bool invert_views = true;
  bool flip_image_x = false;
  bool flip_subpixels = false;  ///< blue first
  CellPattern pattern = CellPattern::kUniform;
  std::vector<SubpixelCell> cells;  ///< empty: plain RGB stripes
  double fringe = 0.0;              ///< -1 to 1, as LensSheet::fringe
};

/// periods = pitch * width / dpi * cos(atan(1 / slope)); tilt = height / (width * slope); both signs as the vendor's.
LensSheet lens_sheet(const LookingGlassFigures& figures);

/// Index of a pixel's cell among `cells` cells; (x, y) counts from the panel's lower left corner.
int cell_index(CellPattern pattern, int cells, std::int64_t x, std::int64_t y) noexcept;

/// Place across the lens, 0..1, of channel k (0 red, 1 green, 2 blue) of pixel (x, y), lower left origin; already
/// inverted where the sheet inverts. A view index is floor(position * view_count).
double lens_position(const LensSheet& sheet, std::int64_t x, std::int64_t y, int channel) noexcept;

/// clamp(floor(position * views), 0, views - 1)
int nearest_view(double position, int views) noexcept;

/// Width of the Gaussians in lens positions, as the maker has it.
inline constexpr double kViewSigma = 0.01;

/// A sheet in the terms of optics, for eyes at known places (millimetres, panel frame: centre, x right, y up, z to
/// the viewer).
struct LensOptics {
  double pitch_mm = 0.0;        ///< horizontal distance of lenses
  double tan_slant = 0.0;       ///< lens axis dx/dy; phase = (x + tan_slant * y) / pitch - phase0
  double reduced_gap_mm = 0.0;  ///< lens height over the subpixels divided by its refractive index, d/n
  double refractive_index = 1.5;
  double phase0 = 0.0;              ///< periods
  double spot_sigma_periods = 0.0;  ///< blur of the lens focus on the subpixel plane (aberration), Gaussian
  glm::dvec2 pixel_mm{0.0, 0.0};    ///< pixel pitch
};

/// Where the light that leaves a subpixel at (x, y) towards the eye crosses the lens surface: exact refraction.
/// Shift = (d/n) (E - p) / sqrt(ez^2 + (1 - 1/n^2) rho^2), rho^2 = |E.xy - p|^2.
glm::dvec2 refraction_shift_mm(const LensOptics& lens, const glm::dvec3& eye_mm, const glm::dvec2& point_mm) noexcept;

/// The paraxial approximation (d/n) (E - p) / ez, for comparison.
glm::dvec2 paraxial_shift_mm(const LensOptics& lens, const glm::dvec3& eye_mm, const glm::dvec2& point_mm) noexcept;

/// Lens phase of a subpixel as seen from an eye, -0.5..0.5 periods; 0: the eye sees the subpixel's centre.
double eye_phase(const LensOptics& lens, const glm::dvec3& eye_mm, const glm::dvec2& point_mm,
                 bool exact = true) noexcept;

}  // namespace dubsar
