#pragma once
// The box that cuts leave of an object, and dragging its sides. Plain values.

#include <array>
#include <optional>

#include "app/commands/box_sides.h"
#include "app/commands/editor.h"
#include "app/document/box_picture.h"
#include "app/stage/pick_camera.h"

namespace dubsar::app {

class CutBox {
 public:
  /// `reach`: of the surface towards each of kBoxSides.
  CutBox(const std::array<Workplace::Reach, kBoxSides.size()>& reach, const Document& document);

  /// The middle of a side, where its handle is, in mm of the scan.
  glm::dvec3 middle(std::size_t side) const;
  /// What is cut away from a side, in percent of the surface's reach, when it stands at `at_mm` along its direction:
  /// never more than leaves a hundredth of the reach before the side that faces it.
  double percent(std::size_t side, double at_mm) const;
  double at_mm(std::size_t side) const noexcept { return at_mm_[side]; }
  const glm::dvec3& direction(std::size_t side) const noexcept { return reach_[side].direction; }

  /// As it is seen.
  BoxPicture picture(const PickCamera& camera) const;

 private:
  glm::dvec3 corner(std::size_t bits) const;
  bool faces(std::size_t side, const PickCamera& camera) const;

  std::array<Workplace::Reach, kBoxSides.size()> reach_;
  std::array<double, kBoxSides.size()> at_mm_{};
};

/// The handle under a place of the window: the nearest to the viewer within `within` heights of the window.
std::optional<std::size_t> handle_at(const BoxPicture& picture, const glm::dvec2& at, double within);

/// A side in somebody's hand: it follows the pointer along its direction. Where it comes straight at the viewer, it
/// goes away from them as the pointer goes up.
class BoxDrag {
 public:
  BoxDrag(const CutBox& box, std::size_t side, const PickCamera& camera, const glm::dvec2& at);
  std::size_t side() const noexcept { return side_; }
  /// Where the side stands along its direction, with the pointer at `at`.
  double at_mm(const PickCamera& camera, const glm::dvec2& at) const;

 private:
  double along(const PickCamera& camera, const glm::dvec2& at) const;

  std::size_t side_;
  glm::dvec3 handle_mm_, direction_;
  double begun_mm_, begun_along_ = 0.0;
  bool straight_ = false;  ///< at the viewer, or away
};

}  // namespace dubsar::app
