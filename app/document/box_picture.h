#pragma once
// The box of cuts as it is seen: its edges, and a handle in the middle of each side. Plain values.

#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace dubsar::app {

/// Places count in heights of the window from its middle, to the right and up.
struct BoxEdge {
  glm::dvec2 from{0.0}, to{0.0};
  bool before = true;  ///< the object; false: behind it
  friend bool operator==(const BoxEdge&, const BoxEdge&) = default;
};
struct BoxHandle {
  glm::dvec2 at{0.0}, towards{0.0};  ///< towards: which way out of the box
  bool before = true;
  bool touched = false;      ///< the pointer is on it, or holds it
  double distance_mm = 0.0;  ///< from the viewer
  std::string words{};
  friend bool operator==(const BoxHandle&, const BoxHandle&) = default;
};
struct BoxPicture {
  std::vector<BoxEdge> edges;
  std::vector<BoxHandle> handles;
  friend bool operator==(const BoxPicture&, const BoxPicture&) = default;
};

inline constexpr float kHandlePx = 8.0f;  ///< radius of a handle, of the layout

}  // namespace dubsar::app
