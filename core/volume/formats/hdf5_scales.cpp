#include "core/volume/formats/hdf5_scales.h"

#include <algorithm>

#include "core/volume/formats/hdf5_path.h"

namespace dubsar {

std::optional<std::array<std::string, 3>> hdf5_scales(const Hdf5File& file, const Hdf5DatasetInfo& info) {
  const auto axes = volume_axes(info.dims);
  if (!axes) return std::nullopt;
  std::array<std::string, 3> scales;
  // Beside the volume or in a group above it; the nearest counts.
  for (std::string group = hdf5_parent(info.path);; group = hdf5_parent(group)) {
    const auto links = file.list(group);
    if (!links) return std::nullopt;
    for (const Hdf5Link& link : *links) {
      if (link.kind != Hdf5Link::Kind::kDataset || hdf5_parent(link.path) != group ||
          file.string(link.path, "CLASS") != "DIMENSION_SCALE")
        continue;
      for (const Hdf5File::ScaledAxis& scaled : file.scaled_axes(link.path))
        for (std::size_t i = 0; i < 3; ++i)
          if (scaled.address == info.address && scaled.axis == static_cast<int>((*axes)[i]) && scales[i].empty())
            scales[i] = link.path;
    }
    if (group == "/") break;
  }
  if (std::all_of(scales.begin(), scales.end(), [](const std::string& path) { return path.empty(); }))
    return std::nullopt;
  return scales;
}

}  // namespace dubsar
