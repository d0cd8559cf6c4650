#include "core/phantom/cell_lists.h"

#include <algorithm>
#include <cmath>

namespace dubsar::phantom {
namespace {

std::int64_t cell_of(double coordinate, std::int64_t count) noexcept {
  return std::clamp(static_cast<std::int64_t>(std::floor(coordinate / kCellEdge)) + 1, std::int64_t{0}, count - 1);
}

template <class Visit>
void visit_cells(const CellGrid& grid, const Ball& ball, const Visit& visit) {
  const auto gap2 = [](double c, std::int64_t cell) {
    const double lo = static_cast<double>(cell - 1) * kCellEdge, hi = lo + kCellEdge;
    const double d = std::max({lo - c, c - hi, 0.0});
    return d * d;
  };
  const glm::dvec3 lo = ball.centre - ball.radius, hi = ball.centre + ball.radius;
  for (std::int64_t z = cell_of(lo.z, grid.nz); z <= cell_of(hi.z, grid.nz); ++z)
    for (std::int64_t y = cell_of(lo.y, grid.ny); y <= cell_of(hi.y, grid.ny); ++y)
      for (std::int64_t x = cell_of(lo.x, grid.nx); x <= cell_of(hi.x, grid.nx); ++x)
        if (gap2(ball.centre.x, x) + gap2(ball.centre.y, y) + gap2(ball.centre.z, z) <= ball.radius * ball.radius)
          visit((z * grid.ny + y) * grid.nx + x);
}

}  // namespace

std::int64_t CellGrid::index(double x, double y, double z) const noexcept {
  return (cell_of(z, nz) * ny + cell_of(y, ny)) * nx + cell_of(x, nx);
}

CellLists::CellLists(Dims dims, std::span<const Ball> balls) {
  const CellGrid grid(dims);
  first_.assign(static_cast<std::size_t>(grid.count()) + 1, 0);
  for (const Ball& ball : balls)
    visit_cells(grid, ball, [&](std::int64_t cell) { ++first_[static_cast<std::size_t>(cell) + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  ids_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t id = 0; id < balls.size(); ++id)
    visit_cells(grid, balls[id], [&](std::int64_t cell) {
      ids_[next[static_cast<std::size_t>(cell)]++] = static_cast<std::uint32_t>(id);
    });
}

}  // namespace dubsar::phantom
