#include "display/panels/lens_fields.h"

#include <array>
#include <cmath>

namespace dubsar {
using nlohmann::json;

namespace {

constexpr std::size_t kMaxCells = 10;  // the vendor's shaders hold 60 floats
constexpr double kMostOffsetPx = 2.0;  // beyond, a subpixel would belong to another pixel's neighbour
constexpr std::array<const char*, 3> kChannels{"R", "G", "B"};
constexpr std::array<std::array<const char*, 2>, 3> kMakersNames{
    {{"ROffsetX", "ROffsetY"}, {"GOffsetX", "GOffsetY"}, {"BOffsetX", "BOffsetY"}}};

bool is_offset(const json& value) { return value.is_number() && std::abs(value.get<double>()) <= kMostOffsetPx; }

SubpixelCell read_cell(const json& entry, JsonFields& fields) {
  SubpixelCell cell;
  if (!entry.is_object()) fields.complain(fmt::format("a subpixel cell is {}, expected an object", entry.type_name()));
  for (std::size_t k = 0; k < 3; ++k) {
    JsonFields own(entry, "subpixel cell");
    if (!own.has(kChannels[k])) {
      for (int axis = 0; axis < 2; ++axis)
        cell.offset_px[k][axis] =
            own.number(kMakersNames[k][static_cast<std::size_t>(axis)], -kMostOffsetPx, kMostOffsetPx);
      if (auto ok = own.finish(); !ok) fields.complain(ok.error().message);
      continue;
    }
    const json& pair = entry.at(kChannels[k]);
    if (!pair.is_array() || pair.size() != 2 || !is_offset(pair[0]) || !is_offset(pair[1]))
      fields.complain(
          fmt::format("subpixel cell: {} is something else, expected two numbers of -2 to 2", kChannels[k]));
    else
      cell.offset_px[k] = {pair[0].get<double>(), pair[1].get<double>()};
  }
  return cell;
}

}  // namespace

void read_lens_figures(JsonFields& fields, LookingGlassFigures& sheet, const char* invert_name,
                       const char* pattern_name) {
  sheet.pitch = fields.number("pitch", kLeastPitch, kMostPitch);
  sheet.slope = fields.number("slope", -kMostSlope, kMostSlope);
  if (std::abs(sheet.slope) < kLeastSlope)
    fields.complain(fmt::format("slope is {}, expected {} or more, of either sign", sheet.slope, kLeastSlope));
  const double zero = 0.0;
  sheet.center = fields.number("center", -kMostCentre, kMostCentre, &zero);
  sheet.fringe = fields.number("fringe", -1.0, 1.0, &zero);
  sheet.invert_views = fields.flag(invert_name, true);
  const int uniform = 0;
  sheet.pattern = static_cast<CellPattern>(fields.integer(pattern_name, 0, 4, &uniform));
}

void read_lens_cells(const json& cells, JsonFields& fields, LookingGlassFigures& sheet) {
  if (!cells.is_array() || cells.size() > kMaxCells)
    return fields.complain(fmt::format("subpixel cells: expected an array of at most {}", kMaxCells));
  for (const json& entry : cells) sheet.cells.push_back(read_cell(entry, fields));
}

}  // namespace dubsar
