#pragma once
// How the axes of a stored array lie in space. A volume whose axes are taken in the wrong order, or backwards, shows a
// mirror image: writing on it runs the wrong way.

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// Which stored axis is x, y and z of a right-handed frame, and which of them are stored from their far end. The usual
/// order has x as the fastest stored axis and nothing backwards.
struct AxisOrder {
  std::array<int, 3> stored{0, 1, 2};                  ///< of x, y, z: 0 is the fastest stored axis, 2 the slowest
  std::array<bool, 3> backwards{false, false, false};  ///< of x, y, z
  std::string provenance;                              ///< what says so; empty: nobody does, the usual order is taken

  bool known() const noexcept { return !provenance.empty(); }
  bool usual() const noexcept;
  /// Whether the array read in the usual order is a mirror image of the object.
  bool mirrored_as_stored() const noexcept;
  /// The axes as stored, slowest first, "-" before those that are backwards: "zyx", "xyz", "z-yx".
  std::string letters() const;
  friend bool operator==(const AxisOrder&, const AxisOrder&) = default;
};

/// For people: "z, y, x, slowest first (/v@axis_order)", and what was done about a mirror image.
std::string describe(const AxisOrder& order);

/// What one text or several say about the stored axes, slowest first: "zyx", "XYZ", "z,-y,x", "z:y:x", "['z', 'y',
/// 'x']", or one label an axis ("sample_z", "y (mm)"). `used` are the places of the three axes among the labels (axes
/// of length 1, such as t and c of "tczyx", are not used). nullopt when that is not x, y and z, each once.
std::optional<AxisOrder> parse_axis_labels(std::span<const std::string> labels, std::span<const std::size_t> used);

/// The order that `text` gives for three axes, slowest first; kUsage with what was expected.
Result<AxisOrder> parse_axis_order(std::string_view text);

/// The order nearest to the directions in space of the stored axes, fastest first: of all 48, the one with the same
/// handedness whose axes point closest to x, y, z. In a left-handed space x counts the other way. nullopt when the
/// directions span no volume.
std::optional<AxisOrder> axis_order_of(const std::array<glm::dvec3, 3>& directions, bool left_handed_space);

/// Values of the stored axes, fastest first, as x, y, z.
template <class Vector>
Vector by_axis(const AxisOrder& order, const Vector& stored) {
  Vector out = stored;
  for (int axis = 0; axis < 3; ++axis) out[axis] = stored[order.stored[static_cast<std::size_t>(axis)]];
  return out;
}

}  // namespace dubsar
