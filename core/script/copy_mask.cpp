#include "core/script/copy_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace dubsar {
namespace {

/// Douglas and Peucker, of an open line.
void simplify_line(const std::vector<glm::dvec2>& line, std::size_t from, std::size_t to, double tolerance,
                   std::vector<char>& keep) {
  double far = tolerance;
  std::size_t most = from;
  const glm::dvec2 along = line[to] - line[from];
  const double length = glm::length(along);
  for (std::size_t k = from + 1; k < to; ++k) {
    const glm::dvec2 off = line[k] - line[from];
    const double distance = length > 0.0 ? std::abs(along.x * off.y - along.y * off.x) / length : glm::length(off);
    if (distance > far) {
      far = distance;
      most = k;
    }
  }
  if (most == from) return;
  keep[most] = 1;
  simplify_line(line, from, most, tolerance, keep);
  simplify_line(line, most, to, tolerance, keep);
}

std::vector<glm::dvec2> simplified(const std::vector<glm::dvec2>& loop, double tolerance) {
  std::vector<char> keep(loop.size(), 0);
  const std::size_t half = loop.size() / 2;
  keep[0] = keep[half] = keep.back() = 1;
  simplify_line(loop, 0, half, tolerance, keep);
  simplify_line(loop, half, loop.size() - 1, tolerance, keep);
  std::vector<glm::dvec2> out;
  for (std::size_t k = 0; k < loop.size(); ++k)
    if (keep[k]) out.push_back(loop[k]);
  return out;
}

}  // namespace

CopyMask::CopyMask(const glm::dvec2& low, const glm::dvec2& high, double cell_mm)
    : low_(low - 2.0 * cell_mm),
      cell_(cell_mm),
      width_(static_cast<int>((high.x - low.x) / cell_mm) + 5),
      height_(static_cast<int>((high.y - low.y) / cell_mm) + 5),
      covered_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0) {}

bool CopyMask::at(int x, int y) const {
  return x >= 0 && y >= 0 && x < width_ && y < height_ &&
         covered_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] != 0;
}

bool CopyMask::empty() const {
  return std::none_of(covered_.begin(), covered_.end(), [](char c) { return c != 0; });
}

void CopyMask::add_triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const std::array<glm::dvec2, 3> p{(a - low_) / cell_, (b - low_) / cell_, (c - low_) / cell_};
  const auto cover = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < width_ && y < height_)
      covered_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] = 1;
  };
  for (const glm::dvec2& q : p) cover(static_cast<int>(q.x), static_cast<int>(q.y));
  const int x0 = static_cast<int>(std::floor(std::min({p[0].x, p[1].x, p[2].x}))),
            x1 = static_cast<int>(std::max({p[0].x, p[1].x, p[2].x})),
            y0 = static_cast<int>(std::floor(std::min({p[0].y, p[1].y, p[2].y}))),
            y1 = static_cast<int>(std::max({p[0].y, p[1].y, p[2].y}));
  if (x1 - x0 < 1 && y1 - y0 < 1) return;
  const auto side = [&](const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& q) {
    return (to.x - from.x) * (q.y - from.y) - (to.y - from.y) * (q.x - from.x);
  };
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const glm::dvec2 q(x + 0.5, y + 0.5);
      const double s = side(p[0], p[1], q), t = side(p[1], p[2], q), u = side(p[2], p[0], q);
      if ((s >= 0 && t >= 0 && u >= 0) || (s <= 0 && t <= 0 && u <= 0)) cover(x, y);
    }
}

std::vector<std::vector<glm::dvec2>> CopyMask::outlines(double tolerance_mm, std::size_t least) const {
  // Edges of cells that are covered on the left and not on the right, from corner to corner.
  std::multimap<std::pair<int, int>, std::pair<int, int>> edges;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      if (!at(x, y)) continue;
      if (!at(x, y - 1)) edges.insert({{x, y}, {x + 1, y}});
      if (!at(x + 1, y)) edges.insert({{x + 1, y}, {x + 1, y + 1}});
      if (!at(x, y + 1)) edges.insert({{x + 1, y + 1}, {x, y + 1}});
      if (!at(x - 1, y)) edges.insert({{x, y + 1}, {x, y}});
    }
  std::vector<std::vector<glm::dvec2>> loops;
  while (!edges.empty()) {
    const auto first = edges.begin();
    const std::pair<int, int> begin = first->first;
    std::pair<int, int> here = first->second;
    std::vector<std::pair<int, int>> corners{begin, here};
    edges.erase(first);
    while (here != begin) {
      const auto next = edges.find(here);
      if (next == edges.end()) break;
      here = next->second;
      edges.erase(next);
      corners.push_back(here);
    }
    if (corners.size() < least) continue;
    std::vector<glm::dvec2> loop;  // middles of edges: stairs become slopes
    for (std::size_t k = 0; k + 1 < corners.size(); ++k)
      loop.push_back(
          place(0.5 * (corners[k].first + corners[k + 1].first), 0.5 * (corners[k].second + corners[k + 1].second)));
    loops.push_back(simplified(loop, tolerance_mm));
  }
  std::stable_sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return loops;
}

std::vector<std::vector<glm::dvec2>> CopyMask::hatch(double spacing_mm, bool rising) const {
  std::vector<std::vector<glm::dvec2>> out;
  const int every = std::max(1, static_cast<int>(std::lround(spacing_mm * std::sqrt(2.0) / cell_)));
  for (int offset = -height_; offset < width_ + height_; offset += every) {
    int from = -1;
    for (int y = 0; y <= height_; ++y) {
      const int x = rising ? offset + y : offset - y;
      const bool on = y < height_ && at(x, y);
      if (on && from < 0) from = y;
      if (!on && from >= 0) {
        const auto end = [&](double v) { return place((rising ? offset + v : offset - v + 1.0), v); };
        if (y - from > 2) out.push_back({end(from), end(y)});
        from = -1;
      }
    }
  }
  return out;
}

}  // namespace dubsar
