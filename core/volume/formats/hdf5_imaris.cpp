#include "core/volume/formats/hdf5_imaris.h"

#include <array>
#include <charconv>
#include <cmath>

#include "core/base/numbers/units.h"
#include "core/volume/formats/hdf5_path.h"

namespace dubsar {
namespace {

constexpr const char* kImarisImage = "/DataSetInfo/Image";

/// A text, also where each character is an element of its own.
std::optional<std::string> text_of(const Hdf5File& file, const std::string& object, const std::string& name) {
  const auto pieces = file.strings(object, name);
  if (!pieces) return std::nullopt;
  std::string text;
  for (const std::string& piece : *pieces) text += piece;
  return text;
}

std::optional<double> number_of(const Hdf5File& file, const std::string& object, const std::string& name) {
  if (const auto numbers = file.numbers(object, name)) return numbers->front();
  const auto text = text_of(file, object, name);
  if (!text) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  return error == std::errc() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// What ExtMin and ExtMax of an axis say, in the file's unit.
struct ImarisExtent {
  double least, most;
};
std::optional<ImarisExtent> extent_of(const Hdf5File& file, int axis) {
  const auto least = number_of(file, kImarisImage, fmt::format("ExtMin{}", axis)),
             most = number_of(file, kImarisImage, fmt::format("ExtMax{}", axis));
  return least && most ? std::optional(ImarisExtent{*least, *most}) : std::nullopt;
}

}  // namespace

std::optional<Dims> imaris_dims(const Hdf5Volume& volume, const Dims& stored) {
  if (!volume.info.path.starts_with("/DataSet/ResolutionLevel ")) return std::nullopt;
  const std::string channel = hdf5_parent(volume.info.path);
  std::array<std::int64_t, 3> sizes{};
  const std::array<std::int64_t, 3> most{stored.x, stored.y, stored.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto size = number_of(*volume.file, channel, fmt::format("ImageSize{}", "XYZ"[axis]));
    if (!size || *size < 2.0 || *size > static_cast<double>(most[axis])) return std::nullopt;
    sizes[axis] = static_cast<std::int64_t>(*size);
  }
  return Dims{sizes[0], sizes[1], sizes[2]};
}

std::optional<VoxelSize> imaris_voxel_size(const Hdf5Volume& volume) {
  const Hdf5File& file = *volume.file;
  const std::string image = kImarisImage;
  if (!volume.info.path.starts_with(std::string(kImarisFinest) + "/")) return std::nullopt;
  const auto unit = mm_per_unit(text_of(file, image, "Unit").value_or("um"));
  glm::dvec3 mm(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto extent = extent_of(file, axis);
    const auto count = number_of(file, image, std::string(1, "XYZ"[axis]));
    if (!unit || !extent || !count || !(*count >= 1.0)) return std::nullopt;
    mm[axis] = std::abs(extent->most - extent->least) / *count * *unit;
  }
  if (!(mm.x > 0.0 && mm.y > 0.0 && mm.z > 0.0) || !std::isfinite(mm.x + mm.y + mm.z)) return std::nullopt;
  return VoxelSize{mm, image + "@ExtMin, ExtMax"};
}

std::optional<AxisOrder> imaris_axis_order(const Hdf5Volume& volume) {
  if (!volume.info.path.starts_with("/DataSet/ResolutionLevel ")) return std::nullopt;
  AxisOrder order;
  for (int axis = 0; axis < 3; ++axis) {
    const auto extent = extent_of(*volume.file, axis);
    if (!extent) return std::nullopt;
    order.backwards[static_cast<std::size_t>(axis)] = extent->least > extent->most;
  }
  if (order.usual()) return std::nullopt;
  order.provenance = std::string(kImarisImage) + "@ExtMin, ExtMax";
  return order;
}

}  // namespace dubsar
