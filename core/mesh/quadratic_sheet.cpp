#include "core/mesh/quadratic_sheet.h"

#include <cmath>
#include <utility>

namespace dubsar {

double sheet_height(const SheetTerms& factors, const SheetTerms& place) {
  double height = 0.0;
  for (std::size_t k = 0; k < kSheetTerms; ++k) height += factors[k] * place[k];
  return height;
}

void SheetEquations::add(const SheetTerms& place, double height, double weight) {
  for (std::size_t r = 0; r < kSheetTerms; ++r) {
    for (std::size_t c = 0; c < kSheetTerms; ++c) rows_[r][c] += weight * place[r] * place[c];
    rows_[r][kSheetTerms] += weight * place[r] * height;
  }
}

void SheetEquations::regularize() {
  for (std::size_t r = 0; r < kSheetTerms; ++r) rows_[r][r] += 1e-12 * (rows_[0][0] + 1.0);
}

std::optional<SheetTerms> SheetEquations::solved(double least_pivot) const {
  auto m = rows_;
  for (std::size_t c = 0; c < kSheetTerms; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < kSheetTerms; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    if (!(std::abs(m[pivot][c]) > least_pivot)) return std::nullopt;
    std::swap(m[c], m[pivot]);
    for (std::size_t r = 0; r < kSheetTerms; ++r) {
      if (r == c) continue;
      const double part = m[r][c] / m[c][c];
      for (std::size_t k = c; k <= kSheetTerms; ++k) m[r][k] -= part * m[c][k];
    }
  }
  SheetTerms factors{};
  for (std::size_t i = 0; i < kSheetTerms; ++i) factors[i] = m[i][kSheetTerms] / m[i][i];
  return factors;
}

}  // namespace dubsar
