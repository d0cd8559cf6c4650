#pragma once
// A wedge: the imprint of a stylus's corner in clay (docs/edition.md says how each figure is defined).

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/text/enum_names.h"
#include "core/mesh/evidence.h"

namespace dubsar {

/// By the angle of the tail to the line of text. kOdd: points where no kind does.
enum class WedgeKind : std::uint8_t { kHorizontal, kVertical, kObliqueDown, kObliqueUp, kWinkelhaken, kOdd };

inline constexpr EnumName<WedgeKind> kWedgeKinds[] = {
    {WedgeKind::kHorizontal, "horizontal"},    {WedgeKind::kVertical, "vertical"},
    {WedgeKind::kObliqueDown, "oblique-down"}, {WedgeKind::kObliqueUp, "oblique-up"},
    {WedgeKind::kWinkelhaken, "winkelhaken"},  {WedgeKind::kOdd, "odd"}};
inline constexpr std::size_t kWedgeKindCount = static_cast<std::size_t>(WedgeKind::kOdd) + 1;
static_assert(names_all(kWedgeKinds, kWedgeKindCount));

/// In the order in which a tablet is read.
enum class TextSide : std::uint8_t { kObverse, kLowerEdge, kReverse, kUpperEdge, kLeftEdge, kRightEdge };

inline constexpr EnumName<TextSide> kTextSides[] = {
    {TextSide::kObverse, "obverse"},      {TextSide::kLowerEdge, "lower-edge"}, {TextSide::kReverse, "reverse"},
    {TextSide::kUpperEdge, "upper-edge"}, {TextSide::kLeftEdge, "left-edge"},   {TextSide::kRightEdge, "right-edge"}};
inline constexpr std::size_t kTextSideCount = static_cast<std::size_t>(TextSide::kRightEdge) + 1;
static_assert(names_all(kTextSides, kTextSideCount));

/// Who says that a wedge is there and how it lies: the program; a person; the program first, then changed by a person.
enum class WedgeBy : std::uint8_t { kMachine, kPerson, kCorrected };

inline constexpr EnumName<WedgeBy> kWedgeBys[] = {
    {WedgeBy::kMachine, "machine"}, {WedgeBy::kPerson, "person"}, {WedgeBy::kCorrected, "corrected"}};
static_assert(names_all(kWedgeBys, static_cast<std::size_t>(WedgeBy::kCorrected) + 1));

/// Where a wedge stands in the text: line and order from 1, 0 not known.
struct TextPlace {
  TextSide side = TextSide::kObverse;
  int column = 1, line = 0, order = 0;
  friend bool operator==(const TextPlace&, const TextPlace&) = default;
};

/// A wedge that was pressed before another that it overlaps.
struct WedgeBefore {
  int order = 0;
  double clear = 0.0;  ///< by how much more it is filled than the later one where they meet, of a usual depth
  friend bool operator==(const WedgeBefore&, const WedgeBefore&) = default;
};

/// How sure it is that there is a wedge of this place and direction, and who says so.
struct WedgeClaim {
  double confidence = 0.0;  ///< 0..1
  Evidence evidence = Evidence::kMeasured;
  WedgeBy by = WedgeBy::kMachine;
  friend bool operator==(const WedgeClaim&, const WedgeClaim&) = default;
};

/// Lengths in mm, points in the mesh's frame in mm.
struct ScriptWedge : TextPlace, WedgeClaim {
  glm::dvec3 head_mm{0.0};        ///< middle of the head's edge, on the writing surface
  glm::dvec3 corner_mm[2]{};      ///< the ends of that edge: left and right of the tail's direction
  glm::dvec3 tip_mm{0.0};         ///< deepest place, in the clay
  glm::dvec3 tail_mm{0.0};        ///< where the tail runs out, on the writing surface
  glm::dvec3 normal{0, 0, 1};     ///< unit, of the writing surface, towards the air
  glm::dvec3 direction{1, 0, 0};  ///< unit, head to tail, in the writing surface
  double depth_mm = 0.0;          ///< of the clay below the writing surface at the tip
  double length_mm = 0.0;         ///< head to tail's end
  double width_mm = 0.0;          ///< between the corners
  double opening_deg = 0.0;       ///< inner dihedral angle of the flanks
  int id = 0;                     ///< as it was found: order says where it stands in the text
  std::vector<WedgeBefore> pressed_after;
  WedgeKind kind = WedgeKind::kOdd;
  friend bool operator==(const ScriptWedge&, const ScriptWedge&) = default;
};

}  // namespace dubsar
