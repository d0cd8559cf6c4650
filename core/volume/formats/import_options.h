#pragma once
// What the user says about an input volume.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files/file_identity.h"
#include "core/base/numbers/scalar_type.h"
#include "core/base/result.h"
#include "core/base/system/budget.h"
#include "core/volume/axis_order.h"
#include "core/volume/unmeasured.h"

namespace dubsar {

/// How to read a file without a header.
struct RawSpec {
  std::array<std::int64_t, 3> dims{};  ///< x, y, z
  ScalarType type = ScalarType::kU8;
  ByteOrder order = ByteOrder::kLittle;
  std::int64_t skip = 0;  ///< bytes in front of the voxels
};

/// Half-open ranges of stored voxels; an end of -1 means up to the border.
struct CropRange {
  std::array<std::int64_t, 3> begin{0, 0, 0};  ///< x, y, z
  std::array<std::int64_t, 3> end{-1, -1, -1};
};

struct ImportOptions {
  std::filesystem::path path;  ///< a file, a folder of TIFF slices, or FILE:/dataset
  std::string dataset;         ///< HDF5 path of the volume, or of a group that holds it; empty: found by itself
  std::optional<CropRange> crop;
  std::array<std::int64_t, 3> stride{1, 1, 1};          ///< x, y, z
  std::optional<AxisOrder> axis_order;                  ///< overrides what the file says
  std::optional<glm::dvec3> voxel_size_mm;              ///< x, y, z; overrides what the file says
  std::optional<RawSpec> raw;                           ///< set: the file is read as raw, whatever it holds
  std::optional<std::filesystem::path> allow_external;  ///< folder in which other files may be opened
  bool trust = false;                                   ///< accept compression ratios above 250
  bool allow_sparse = false;             ///< accept chunks that were never written (read as the fill value)
  IgnoredValues ignored;                 ///< grey values that are no measurement
  std::optional<Unmeasured> unmeasured;  ///< what an earlier look at the same part of the file found
  std::optional<float> unmeasured_fill;  ///< what they count as; default: air, see unmeasured.h
  Budget budget;
  /// Where a scan is opened several times: what its files were the first time, filled in then; kTryAgain when they are
  /// not the same any more. nullptr: nobody asks.
  std::shared_ptr<std::vector<FileIdentity>> same_files;
};

/// "x0:x1,y0:y1,z0:z1"; an empty bound is the border: "100:400,:,:800". kUsage.
Result<CropRange> parse_crop(std::string_view text);
/// "2" or "2,2,4" (x, y, z), each at least 1. kUsage.
Result<std::array<std::int64_t, 3>> parse_stride(std::string_view text);
/// "512x512x300" (x, y, z). kUsage.
Result<std::array<std::int64_t, 3>> parse_dims(std::string_view text);
/// "38um" or "10um,10um,25um" (x, y, z). kUsage.
Result<glm::dvec3> parse_voxel_size(std::string_view text);
/// "little" or "big". kUsage.
Result<ByteOrder> parse_byte_order(std::string_view text);

}  // namespace dubsar
