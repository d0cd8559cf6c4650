#pragma once
// What the description (tag 270) of a TIFF file says about the stack in it: ImageJ's fields, OME's XML, tifffile's
// JSON.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

namespace dubsar {

struct TiffDescription {
  std::int64_t images = 1;        ///< pages, or pictures that lie one behind the other behind a single page
  std::int64_t slices = 0;        ///< along z; 0: not said
  bool several = false;           ///< channels, time points, positions: more than one volume
  std::string several_of;         ///< e.g. "3 channels"
  glm::dvec3 voxel_mm{0.0};       ///< x, y, z; 0: not said
  std::optional<double> unit_mm;  ///< of the file's resolution tags and of `spacing`; ImageJ and tifffile
  double spacing = 0.0;           ///< between slices, in that unit; its sign says which way they run
  std::string said_by;            ///< "ImageJ", "OME PhysicalSize", "tifffile"; empty: nobody
};

TiffDescription parse_tiff_description(const std::string& text);

}  // namespace dubsar
