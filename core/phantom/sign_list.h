#pragma once
// Cuneiform signs as groups of wedges, and lines of them.

#include <cstdint>
#include <vector>

#include "core/base/text/enum_names.h"
#include "core/phantom/random.h"

namespace dubsar::phantom {

/// The five kinds of wedges, as the sign list names them.
enum class StrokeKind : std::uint8_t { kHorizontal, kVertical, kObliqueDown, kObliqueUp, kWinkelhaken };

inline constexpr EnumName<StrokeKind> kStrokeKinds[] = {{StrokeKind::kHorizontal, "horizontal"},
                                                        {StrokeKind::kVertical, "vertical"},
                                                        {StrokeKind::kObliqueDown, "oblique-down"},
                                                        {StrokeKind::kObliqueUp, "oblique-up"},
                                                        {StrokeKind::kWinkelhaken, "winkelhaken"}};
static_assert(names_all(kStrokeKinds, static_cast<std::size_t>(StrokeKind::kWinkelhaken) + 1));

/// One wedge of a sign, in units of the sign height: x to the right, y up, (0, 0) at the left end of the base line.
struct Stroke {
  float x = 0, y = 0;            ///< the deepest point of the head
  float tail_x = 1, tail_y = 0;  ///< unit direction of the tail
  float length = 0;              ///< of the tail; 0: Winkelhaken
  float head = 0.15f;            ///< half width of the head
  StrokeKind kind = StrokeKind::kVertical;
};

struct Sign {
  float width = 1.0f;
  std::vector<Stroke> strokes;
};

/// The sign list: shapes after the common Old Assyrian signs, 1 to 9 wedges (single wedges are numerals and the
/// word divider).
const std::vector<Sign>& sign_list();

/// A line of signs of the given length (in sign heights), filled from left to right: words of two to four signs set
/// apart by a divider or a space. The hand trembles: places, lengths and directions vary a little.
struct PlacedSign {
  int sign = 0;  ///< index into sign_list()
  std::vector<Stroke> strokes;
};
std::vector<PlacedSign> write_line(float length, Random& random);

}  // namespace dubsar::phantom
