#pragma once
// How deep a picture may be so that eyes look at it with ease: they converge on what they see, but focus on the panel.

#include <span>

#include "display/optics/view.h"

namespace dubsar {

/// One degree between where the eyes converge and the panel that they focus on (Lambooij, IJsselsteijn, Fortuin and
/// Heynderickx, Visual discomfort and visual fatigue of stereoscopic displays: a review, J. Imaging Sci. Technol. 53,
/// 2009, section "one-degree limit").
inline constexpr double kEasyParallaxDeg = 1.0;

/// Two eyes before a panel.
struct EyesBefore {
  double distance_mm = 600.0;  ///< from the panel's plane
  double apart_mm = 63.0;
};

/// What stands so far before the panel (behind: less than 0) makes the eyes converge so many degrees more than the
/// panel does: 2 atan(b / (2 (d - z))) - 2 atan(b / (2 d)), for a point straight before them, where that is most.
double parallax_deg(const EyesBefore& eyes, double z_mm) noexcept;

/// The depths with that much parallax: before the panel above 0, behind below 0. Parallel eyes see no farther:
/// -infinity where `most_deg` would need more than that.
struct EasyDepths {
  double front_mm = 0.0, back_mm = 0.0;
};
EasyDepths easy_depth(const EyesBefore& eyes, double most_deg) noexcept;

/// The eyes of somebody before a panel with these cameras, which are not scaled in depth: two cameras are the eyes;
/// more than two stand in a fan, and of those people's own eyes, `apart_mm`, choose two. The nearest counts. One
/// camera: eyes that are in one place.
EyesBefore eyes_before(std::span<const View> views, double apart_mm) noexcept;

/// By how much the depth of a scene that reaches from `back_mm` (at most 0) to `front_mm` (at least 0) is to be
/// multiplied so that no parallax is more than `most_deg`: 1 where it is not, at most 1.
double easy_depth_factor(const EyesBefore& eyes, double front_mm, double back_mm, double most_deg) noexcept;

}  // namespace dubsar
