#pragma once
// The order of a folder of slices, by what their names count.

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

struct SliceSeries {
  std::vector<std::filesystem::path> files;  ///< first slice first
  std::vector<std::string> warnings;         ///< numbers that are missing, uneven steps; one sentence each
};

/// Files are one series when their names differ in numbers only, and one of these is another in each: slice_9 comes
/// before slice_10, z_-0.5 before z_0, z_0.05 before z_0.1. A "-" is a sign behind "_", "=", "(" or at the front, and
/// where other names have none in its place ("z-1", "z0"); "." and "," make decimals unless numbers then come twice.
/// Names without numbers go by their letters. kBadData: two series ("a_*.tif (48 files) and mask_*.tif (10 files)"),
/// or two files of one number. `where` names the folder.
Result<SliceSeries> order_slices(std::vector<std::filesystem::path> files, const std::string& where);

}  // namespace dubsar
