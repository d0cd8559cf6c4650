#include "core/mesh/writing/side_rise.h"

#include <algorithm>
#include <cmath>

#include "core/mesh/quadratic_sheet.h"

namespace dubsar {
namespace {

constexpr double kInner = 0.8;       // of the extents each way
constexpr int kFitSteps = 160;       // places looked at each way
constexpr double kImpression = 0.6;  // deviations below the sheet: an impression
constexpr double kBump = 2.5;        // and above it: something that does not belong to it

}  // namespace

double side_rise_mm(const HeightMap& map) {
  struct Place {
    SheetTerms terms;
    double mm;
    bool used = true;
  };
  std::vector<Place> places;
  for (int j = 0; j < kFitSteps; ++j)
    for (int i = 0; i < kFitSteps; ++i) {
      const auto place = [](int step, int size) {
        return static_cast<int>(std::lround(0.5 * (size - 1) * (1.0 + kInner * (2.0 * step / (kFitSteps - 1) - 1.0))));
      };
      const int column = place(i, map.width), row = place(j, map.height);
      const double x = 2.0 * column / std::max(1, map.width - 1) - 1.0;
      const double y = 2.0 * row / std::max(1, map.height - 1) - 1.0;
      const float mm = map.at(column, row);
      if (!std::isnan(mm)) places.push_back({sheet_terms(x, y), static_cast<double>(mm)});
    }
  SheetTerms sheet{};
  for (int turn = 0; turn < 12; ++turn) {
    SheetEquations equations;
    for (const Place& place : places)
      if (place.used) equations.add(place.terms, place.mm);
    sheet = equations.solved(1e-9).value_or(SheetTerms{});
    const auto above = [&](const Place& place) { return place.mm - sheet_height(sheet, place.terms); };
    double squares = 0.0;
    int count = 0;
    for (const Place& place : places) {
      if (!place.used) continue;
      squares += above(place) * above(place);
      ++count;
    }
    if (count < 10 * static_cast<int>(kSheetTerms)) return 0.0;
    const double deviation = std::sqrt(squares / count);
    for (Place& place : places) {
      const double d = above(place);
      place.used = d > -kImpression * deviation && d < kBump * deviation;
    }
  }
  return -kInner * kInner * (sheet[3] + sheet[5]);
}

}  // namespace dubsar
