#pragma once
// A curved sheet z(x, y) = a + b x + c y + d x2 + e x y + f y2, fitted by weighted least squares.

#include <array>
#include <optional>

namespace dubsar {

inline constexpr std::size_t kSheetTerms = 6;
using SheetTerms = std::array<double, kSheetTerms>;  ///< 1 x y x2 xy y2, or the factors of these

constexpr SheetTerms sheet_terms(double x, double y) { return {1.0, x, y, x * x, x * y, y * y}; }

/// Height of the sheet with these factors at the place with these terms.
double sheet_height(const SheetTerms& factors, const SheetTerms& place);

/// The normal equations. Places should be of the size of 1, for the sake of the digits.
class SheetEquations {
 public:
  void add(const SheetTerms& place, double height, double weight = 1.0);
  /// Adds a trace of the mean weight to the diagonal, so that places on a line have a solution too.
  void regularize();
  /// Factors by elimination with row pivots; nothing where a pivot is not above `least_pivot`.
  std::optional<SheetTerms> solved(double least_pivot = 0.0) const;

 private:
  std::array<std::array<double, kSheetTerms + 1>, kSheetTerms> rows_{};
};

}  // namespace dubsar
