#pragma once
// What a person has made of a surface: where it is looked at from, by which light, which parts are there, what was
// measured and noted. Plain values, without GL or devices; one owner, who keeps a history of them.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "app/document/camera_pose.h"
#include "app/document/edition_wedges.h"
#include "app/document/keyframe.h"
#include "app/document/measure.h"
#include "core/edition/tablet_record.h"
#include "input/navigation/view_state.h"

namespace dubsar::app {

/// A piece of the object that is shown as one: "tablet", "envelope".
struct Part {
  std::string name;
  std::uint8_t partitions = 0;  ///< bit p: partition p of the mesh belongs to it
  bool visible = true;
  std::array<std::uint8_t, 3> colour{255, 255, 255};  ///< sRGB; white: as the style wants
  double opacity = 1.0;                               ///< 0..1
  glm::dvec3 offset_mm{0.0};                          ///< from its place in the scan
  std::uint8_t pores = 0;  ///< bit p: partition p, of another part, lies within its clay and goes with it
  friend bool operator==(const Part&, const Part&) = default;
};

struct StyleChoice {
  std::string name = "relief";  ///< of shading_preset()
  double strength = 1.0;        ///< of its colours: 0 none, 1 as designed, 2 twice
  bool occlusion = true;        ///< hollows are darker
  bool evidence = true;         ///< what the scan does not show is hatched
  std::string hatch{};          ///< its colours, as the command says them; empty: sepia
  std::string other{};          ///< a second style that it is mixed with; empty: none
  double share = 0.0;           ///< of that, 0..1
  double radiance = 0.0;        ///< radiance scaling besides that of the style, 0..2
  std::string back_faces{};     ///< as the command says them; empty: shown
  bool section = true;          ///< what is cut through is filled
  std::string colours{};        ///< of figures of the surface, as the command says them; empty: as designed
  friend bool operator==(const StyleChoice&, const StyleChoice&) = default;
};

/// Hides what lies beyond it: points x with dot(normal, x) > distance_mm.
struct Cut {
  glm::dvec3 normal{0.0, 0.0, 1.0};
  double distance_mm = 0.0;
  bool on = true;
  friend bool operator==(const Cut&, const Cut&) = default;
};

struct Note {
  std::string part;   ///< that it is pinned to; empty: none of them
  std::string label;  ///< as editions count: "o. 5", "r. 3"; may be empty
  std::string text;
  glm::dvec3 at_mm{0.0}, normal{0.0, 0.0, 1.0};  ///< where it is pinned to the surface
  std::vector<glm::dvec3> line_mm;  ///< the text stands along these places, a line's transliteration; empty: a pin
  CameraPose camera;                ///< how it was seen
  std::string id{};                 ///< that it has for life, in all copies of the work
  std::string translation{};        ///< of a line
  std::string created{};            ///< day, as 2026-11-27; empty: not known
  friend bool operator==(const Note&, const Note&) = default;
};

/// Where slices of the scan are laid, and how they are seen: three across its axes and a free one, all of them through
/// one place.
struct ScanView {
  glm::dvec3 cursor_mm{0.0};                                   ///< that place, in the frame of the scan
  glm::dvec3 centre_mm{0.0};                                   ///< what stands in the middle of the pictures
  glm::dvec3 free_right{1.0, 0.0, 0.0}, free_up{0.0, 0, 1.0};  ///< of the free one's picture: unit, across each other
  double zoom = 1.0;                                           ///< 1: the whole surface fits
  double black = 0.0, white = 0.0;                             ///< values of the scan; equal: as the scan has them
  int large = 0;                                               ///< 1 x, 2 y, 3 z, 4 free: this one alone; 0: all four
  friend bool operator==(const ScanView&, const ScanView&) = default;
};

struct SourceFile {
  std::string path;
  std::int64_t bytes = 0;
  std::string content{};  ///< file_checksum(): the surface is known by it under any name; empty: not known
  std::string scan{};     ///< file_fingerprint() of the scan that it was made of; empty: not known
  friend bool operator==(const SourceFile&, const SourceFile&) = default;
};

/// Another surface that stands beside this one, turned with it in the same light.
struct Companion {
  std::string path;            ///< of its file; empty: there is none
  std::string content;         ///< file_checksum() of that
  double difference_mm = 0.0;  ///< from which difference on colours are full; 0: colours tell no difference
  friend bool operator==(const Companion&, const Companion&) = default;
};
/// What is farther apart is not told (display/render/mesh/surface_field.h).
inline constexpr double kMostDifferenceMm = 1.9;

/// What is said of the tablet and its text, besides the lines that are pinned to it.
struct TabletEdition {
  TabletRecord record;
  std::string atf{};                  ///< the text that was read in, as it is; empty: none
  std::vector<MarkedWedge> wedges{};  ///< in the order of reading; in files and joined as things of their own
  friend bool operator==(const TabletEdition&, const TabletEdition&) = default;
};

/// What stands around the surface.
struct Surroundings {
  Companion companion;
  friend bool operator==(const Surroundings&, const Surroundings&) = default;
};

struct Document : Surroundings {
  SourceFile source;
  std::vector<Part> parts;
  double unpack = 0.0;   ///< how far the envelope is lifted from the tablet: 0 not, 1 away
  CameraPose home, now;  ///< home is the obverse, upright
  LightPlace home_light, light;
  StyleChoice style;
  std::vector<Cut> clips;
  double fog = 0.0;  ///< 0..1: how much the far side fades
  std::vector<Measure> measures;
  std::vector<Note> notes;
  TabletEdition edition;
  ScanView scan;
  std::vector<Keyframe> keyframes;
  friend bool operator==(const Document&, const Document&) = default;
};

/// Camera and light as navigation has them, and back.
ViewState view_of(const Document& document);
ViewState home_of(const Document& document);
void set_view(Document& document, const ViewState& view);

/// Whether there is an envelope to lift from something else: a part of that name beside others.
bool can_unpack(const Document& document);

/// Partitions of the parts that are shown; all when there are no parts.
std::uint8_t visible_partitions(const Document& document);

}  // namespace dubsar::app
