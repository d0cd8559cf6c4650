#include "input/tracking/vision/ssd_anchors.h"

#include <algorithm>
#include <cmath>

#include "core/base/result.h"

namespace dubsar {

std::vector<glm::dvec2> make_anchors(std::span<const AnchorGrid> grids) {
  std::vector<glm::dvec2> anchors;
  for (const AnchorGrid& grid : grids)
    for (int y = 0; y < grid.cells; ++y)
      for (int x = 0; x < grid.cells; ++x)
        for (int k = 0; k < grid.per_cell; ++k) anchors.emplace_back((x + 0.5) / grid.cells, (y + 0.5) / grid.cells);
  return anchors;
}

std::vector<SsdDetection> decode_ssd(std::span<const float> boxes, std::span<const float> scores,
                                     std::span<const glm::dvec2> anchors, std::size_t points, double input_px,
                                     double least_score) {
  const std::size_t stride = 4 + 2 * points;
  DUBSAR_CHECK(points <= kMostPoints && scores.size() == anchors.size() && boxes.size() == anchors.size() * stride);
  const auto least_logit = static_cast<float>(std::log(least_score / (1.0 - least_score)));
  std::vector<SsdDetection> found;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (!(scores[i] >= least_logit)) continue;
    const std::span<const float> raw = boxes.subspan(i * stride, stride);
    const auto point = [&](std::size_t at) { return anchors[i] + glm::dvec2(raw[at], raw[at + 1]) / input_px; };
    SsdDetection detection;
    detection.score = 1.0 / (1.0 + std::exp(-static_cast<double>(scores[i])));
    const glm::dvec2 half = glm::dvec2(raw[2], raw[3]) / (2.0 * input_px);
    detection.least = point(0) - half;
    detection.most = point(0) + half;
    if (!(half.x > 0.0 && half.y > 0.0 && half.x < 4.0 && half.y < 4.0)) continue;
    for (std::size_t k = 0; k < points; ++k) detection.points[k] = point(4 + 2 * k);
    found.push_back(detection);
  }
  return found;
}

double overlap(const SsdDetection& a, const SsdDetection& b) noexcept {
  const double w = std::min(a.most.x, b.most.x) - std::max(a.least.x, b.least.x);
  const double h = std::min(a.most.y, b.most.y) - std::max(a.least.y, b.least.y);
  if (w <= 0.0 || h <= 0.0) return 0.0;
  const auto area = [](const SsdDetection& d) { return (d.most.x - d.least.x) * (d.most.y - d.least.y); };
  return w * h / (area(a) + area(b) - w * h);
}

std::vector<SsdDetection> merge_overlapping(std::vector<SsdDetection> detections, double most_overlap) {
  std::stable_sort(detections.begin(), detections.end(),
                   [](const SsdDetection& a, const SsdDetection& b) { return a.score > b.score; });
  std::vector<SsdDetection> merged;
  while (!detections.empty()) {
    const SsdDetection best = detections.front();
    SsdDetection mean;
    mean.score = best.score;
    double weight = 0.0;
    std::erase_if(detections, [&](const SsdDetection& other) {
      if (overlap(best, other) <= most_overlap) return false;
      weight += other.score;
      mean.least += other.score * other.least;
      mean.most += other.score * other.most;
      for (std::size_t k = 0; k < kMostPoints; ++k) mean.points[k] += other.score * other.points[k];
      return true;
    });
    mean.least /= weight;
    mean.most /= weight;
    for (glm::dvec2& point : mean.points) point /= weight;
    merged.push_back(mean);
  }
  return merged;
}

}  // namespace dubsar
