#pragma once
// What single-shot detectors say: offsets of boxes and points from a grid of anchors (MediaPipe's palm and
// face networks).

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// Anchors are the middles of the cells of square grids, every cell several times; all of them have size 1.
struct AnchorGrid {
  int cells = 0;  ///< per side
  int per_cell = 0;
};
std::vector<glm::dvec2> make_anchors(std::span<const AnchorGrid> grids);

inline constexpr std::size_t kMostPoints = 7;

/// In units of the network's input square, 0 to 1.
struct SsdDetection {
  double score = 0.0;
  glm::dvec2 least{0.0}, most{0.0};  ///< the box
  std::array<glm::dvec2, kMostPoints> points{};

  glm::dvec2 centre() const noexcept { return 0.5 * (least + most); }
  double width() const noexcept { return most.x - least.x; }
};

/// `boxes`: for each anchor (x, y, width, height) and `points` pairs (x, y), pixels of an input of
/// `input_px`, from the anchor. `scores`: one logit for each anchor. Those of at least `least_score` (0 to
/// 1), unsorted.
std::vector<SsdDetection> decode_ssd(std::span<const float> boxes, std::span<const float> scores,
                                     std::span<const glm::dvec2> anchors, std::size_t points, double input_px,
                                     double least_score);

double overlap(const SsdDetection& a, const SsdDetection& b) noexcept;  ///< intersection over union

/// One detection for each object: the best, with all that overlap it by more than `most_overlap` averaged by
/// their scores (weighted non-maximum suppression, as the networks were trained for). Best first.
std::vector<SsdDetection> merge_overlapping(std::vector<SsdDetection> detections, double most_overlap);

}  // namespace dubsar
