#pragma once
// How the surface looks: colouring by shape class and ambient occlusion (paper sections 3.4.2 and 3.4.4, figure 14),
// light, looks of the parts, background. Plain values and tables; no GL.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/partition_table.h"

namespace dubsar {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< sRGB-coded

enum class ColorMap {
  kPlain,       ///< base_color everywhere
  kTable,       ///< one hue per shape class (figure 14a)
  kBlackWhite,  ///< concave dark, convex light (14b)
  kSkySun,      ///< sky-blue shadows, sun-orange lights (14c)
  // Figures of the surface (surface_field.h), with a legend:
  kIntegral,    ///< multi-scale integral invariants: distance from those of a plane
  kMean,        ///< mean curvature
  kGaussian,    ///< Gaussian curvature
  kShapeIndex,  ///< from cup (-1) over saddle (0) to cap (1)
  kCurvedness,  ///< how much it is bent, whichever way
  kDifference,  ///< how far it lies outside (above 0) or inside another surface that it was laid on
};

/// Colours of figures of the surface. All are told apart by people who do not see red and green.
enum class FieldColors {
  kDesigned,    ///< those of the style: greys of clay for integral invariants, cividis for curvedness, else blue-orange
  kBlueOrange,  ///< concave blue, flat white, convex orange
  kCividis,     ///< J. Nunez, C. Anderton, R. Renslow, 2018: from dark blue to yellow, lightness rises evenly
  kGrey,        ///< from dark to light
};

enum class BackFaces {
  kShow,  ///< lit like front faces
  kTint,  ///< in back_color, so that the inside of an open surface is told from its outside
  kCull,
};

/// The two colours of a hatching.
struct Hatch {
  Rgb8 ground, stripe;
  /// Between both, for what cannot be hatched.
  Rgb8 whole() const {
    Rgb8 out{};
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = static_cast<std::uint8_t>((ground[c] + stripe[c]) / 2);
    return out;
  }
  bool operator==(const Hatch&) const = default;
};
inline constexpr Hatch kSepiaHatch{{200, 166, 120}, {104, 68, 36}}, kBlueHatch{{122, 158, 204}, {38, 70, 128}};

/// What a surface is made of, for the eye.
struct Style {
  ColorMap map = ColorMap::kBlackWhite;
  double contrast = 1.6;  ///< how much of the map's relation to its own flat colour base_color takes on
  bool ambient_occlusion = true;
  double occlusion_power = 1.3;  ///< ambient light to this power: 1 as it is, more for darker hollows
  /// Beyond its linear part the map's contrast bends: the bottoms of wedges and the tops of ridges keep their slopes
  /// instead of all becoming black or white.
  bool shoulder = true;
  bool lit = true;                 ///< false: the colours as they are, as in figure 14 a to e
  Rgb8 base_color{203, 192, 178};  ///< of clay; lit meshes that carry colours have those in its place
  BackFaces back_faces = BackFaces::kShow;
  Rgb8 back_color{120, 60, 60};
  /// Surface that the scan does not show is hatched, never darker than a third of full light. False: it looks like all
  /// the rest.
  bool mark_inferred = true;
  Hatch hatch = kSepiaHatch;
  FieldColors field_colors = FieldColors::kDesigned;  ///< of maps of figures
  /// What planes cut through is filled and hatched, as if it were solid clay. Needs closed surfaces: behind a hole of
  /// one the filling reaches too far.
  bool section = false;
  /// Radiance scaling: how much brighter the light on ridges is and how much darker that in hollows; 0 not, 1 clearly.
  double radiance = 0.0;

  bool operator==(const Style&) const = default;
};

/// One far key light, and what comes from everywhere and from the eye. Turns with the picture, not with the object.
struct Light {
  double azimuth_deg = 315;   ///< in the picture, clockwise from its upper side: 315 is from the upper left
  double elevation_deg = 25;  ///< above the picture plane: 90 is a headlight, below 30 is raking light
  double ambient = 0.12, key = 1.0, fill = 0.25, specular = 0.05;  ///< weights; fill comes from the eye
  double shininess = 24;
  /// `key` is what a surface gets that faces the eye, at any elevation from 7 degrees: what rakes is as bright as what
  /// comes from the front. False: `key` is for a surface that faces the light.
  bool even = false;
  bool shadows = false;  ///< what stands before the light casts them
  double knee = 1.0;     ///< linear light from which on highlights are bent into white instead of clipped, 0..1

  bool operator==(const Light&) const = default;
};

/// A second look that the first one is mixed with, in linear light.
struct OtherLook {
  Style style;
  Light light;         ///< its place is that of the first look's
  double share = 0.0;  ///< 0: the first look alone, 1: this one alone

  bool operator==(const OtherLook&) const = default;
};

/// One partition of a mesh.
struct PartLook {
  bool visible = true;
  Rgb8 color{255, 255, 255};  ///< times the style's colours
  double opacity = 1.0;       ///< 0..1; what is behind shows through, in the right order, whatever the order of drawing
  glm::dvec3 offset_mm{0.0};  ///< moves it, in the model's frame

  bool operator==(const PartLook&) const = default;
};

constexpr int kMaxPartitions = static_cast<int>(PartitionTable::kMost);
using PartLooks = std::array<PartLook, kMaxPartitions>;

/// Bit p: partition p is visible.
std::uint8_t visible_partitions(const PartLooks& parts);
/// Only these.
void show_partitions(PartLooks& parts, std::uint8_t bits);
/// Distinct colours for partitions 0 to 7, for when partitions shall be told apart; they differ in lightness too.
std::array<Rgb8, 8> distinct_partition_colors();
void color_partitions(PartLooks& parts, const std::array<Rgb8, 8>& colors);

struct Background {
  Rgb8 color{24, 24, 26};
  bool transparent = false;  ///< alpha 0 where nothing is seen

  bool operator==(const Background&) const = default;
};

/// Cuts away where dot(normal, p - point) < 0.
struct ClipPlane {
  glm::dvec3 point_mm{0.0};
  glm::dvec3 normal{0, 0, 1};  ///< towards what stays

  bool operator==(const ClipPlane&) const = default;
};
constexpr int kMostClipPlanes = 8;

/// Fades what is far into the background.
struct Fog {
  double strength = 0.0;  ///< 0..1: how much of the background the farthest point of the scene takes on

  bool operator==(const Fog&) const = default;
};

/// All of it, for pictures of one mesh.
struct Shading {
  Style style;
  Light light;
  PartLooks parts{};
  Background background;
  std::vector<ClipPlane> clips{};  ///< in the mesh's frame
  Fog fog{};
  OtherLook other{};

  bool operator==(const Shading&) const = default;
};

/// Names of presets for the command line: "relief" (default), "phong", "raking" (low light with shadows), "table",
/// "black-white", "sky-sun", "ao", "sky-sun-ao", "black-white-ao", "table-ao", "msii" (integral invariants),
/// "radiance", "mean-curvature", "gaussian-curvature", "shape-index", "curvedness", "photograph". kUsage, with the
/// list, for another name.
Result<Shading> shading_preset(std::string_view name);
std::vector<std::string_view> shading_preset_names();

constexpr int kShapeRows = 128, kAoColumns = 64;
/// Colour of shape class s (0..127) under ambient light a (0..63) at [a * 128 + s]: what the vertex shader looks up. Of
/// maps of figures: colour s of its field_colors().
std::vector<std::array<std::uint8_t, 4>> color_table(const Style& style);

/// Unit vector towards the key light in the view frame (+X right, +Y up, +Z to the eye).
glm::dvec3 light_direction(const Light& light);

}  // namespace dubsar
