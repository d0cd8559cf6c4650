#pragma once
// The six sides of a tablet as text is read on them.

#include <array>
#include <span>

#include "core/mesh/tablet_frame.h"
#include "core/script/wedge.h"

namespace dubsar {

/// How a wedge lies in its side: direction of the tail to the line of text, radians counterclockwise (+ upwards).
struct SideAngle {
  TextSide side = TextSide::kObverse;
  double angle = 0.0;
};

class TextSides {
 public:
  TextSides() = default;
  explicit TextSides(const TabletFrame& frame) : frame_(frame) {}

  TextSide side_of(const glm::dvec3& normal) const;
  glm::dvec3 normal_of(TextSide side) const;
  /// Unit, along the lines of a side: of obverse, reverse, lower and upper edge the tablet's right, on the right edge
  /// the lines of the obverse run on, the left edge is read downwards (docs/fatcross.md); then turned by quarters.
  glm::dvec3 right_of(TextSide side) const;
  glm::dvec3 up_of(TextSide side) const;
  /// Text of a side stands so many quarters counterclockwise from what is usual.
  void turn(TextSide side, int quarters) { turns_[static_cast<std::size_t>(side)] = quarters; }
  int turned(TextSide side) const { return turns_[static_cast<std::size_t>(side)]; }

  /// Right of the text in a surface with this normal, near the middle of a side or round its edge.
  glm::dvec3 right_at(const glm::dvec3& normal) const;
  SideAngle angle_of(const glm::dvec3& direction, const glm::dvec3& normal) const;
  const TabletFrame& frame() const noexcept { return frame_; }

 private:
  glm::dvec3 usual_right(TextSide side) const;
  TabletFrame frame_;
  std::array<int, kTextSideCount> turns_{};
};

}  // namespace dubsar
