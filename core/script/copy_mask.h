#pragma once
// What a side covers of the paper: its silhouette, and its areas that are hatched.

#include <functional>
#include <glm/vec2.hpp>
#include <vector>

namespace dubsar {

/// Cells of the paper that are covered; rows upwards.
class CopyMask {
 public:
  /// Covers low to high, in cells of this size.
  CopyMask(const glm::dvec2& low, const glm::dvec2& high, double cell_mm);
  void add_triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);
  bool at(int x, int y) const;
  bool empty() const;

  /// Closed lines around what is covered, longest first, simplified to `tolerance_mm`; those of fewer than `least`
  /// steps are left out. Each keeps what is covered on its left.
  std::vector<std::vector<glm::dvec2>> outlines(double tolerance_mm, std::size_t least) const;
  /// Parallel lines at 45 degrees over what is covered, falling to the right or rising; ends in pairs.
  std::vector<std::vector<glm::dvec2>> hatch(double spacing_mm, bool rising) const;

 private:
  glm::dvec2 place(double x, double y) const { return low_ + cell_ * glm::dvec2(x, y); }
  glm::dvec2 low_;
  double cell_;
  int width_ = 0, height_ = 0;
  std::vector<char> covered_;
};

}  // namespace dubsar
