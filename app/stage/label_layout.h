#pragma once
// Where labels stand beside their places, so that none covers another.

#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "display/optics/view.h"
#include "display/render/scene.h"
#include "display/sinks/output_sink.h"

namespace dubsar::app {

/// A rectangle of the picture, pixels to the right and up.
struct LabelRect {
  glm::dvec2 min{0.0}, max{0.0};
  bool covers(const LabelRect& other) const {
    return min.x < other.max.x && other.min.x < max.x && min.y < other.max.y && other.min.y < max.y;
  }
};

/// What a label takes up in a view of this size: a rectangle, or several where it runs aslant.
std::vector<LabelRect> label_rects(const LabelItem& label, const View& view, const PixelSize& size);
/// Whether any of some covers any of others.
bool cover(std::span<const LabelRect> some, std::span<const LabelRect> others);

/// Whether a label is read in this view: its place does not look away, and the line that its text runs along is not
/// seen from an end, where the text would stick out of the surface. A text that would stand on its head begins at the
/// other end of its line.
bool turn_to_reader(LabelItem& label, const View& view);

/// Keeps from picture to picture what it chose, so that letters do not jump while things turn. One thread.
class LabelLayout {
 public:
  /// Puts labels to another side of their places where they would cover another one, seen in `view`; those for which
  /// there is no room are taken away until there is. Nearer ones than `middle_mm` choose first, then those that have
  /// stood there, then the first. Texts along lines stay. The same labels and views after each other give the same.
  void arrange(std::vector<LabelItem>& labels, const glm::dvec3& middle_mm, const View& view, const PixelSize& size);

 private:
  std::map<std::pair<std::string, int>, int> chosen_;  ///< by text, and which of the same text
};

/// The view from between all of them, in the middle of the row.
View middle_view(std::span<const View> views);

}  // namespace dubsar::app
