#pragma once
// The one door to picture files: PNG, TIFF and JPEG, read by their content and written by their suffix.

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/base/system/budget.h"
#include "core/image_io/image.h"

namespace dubsar {

enum class PictureFormat { kPng, kTiff, kJpeg };

/// By the suffix (.png, .tif, .tiff, .jpg, .jpeg), upper or lower case. kUsage for others, with the list.
Result<PictureFormat> picture_format_from_path(const std::filesystem::path& path);

/// What goes into the file beside the pixels. All formats say that the pixels are sRGB.
struct PictureOptions {
  double dpi = 0.0;                        ///< dots an inch; 0: not said
  int jpeg_quality = 92;                   ///< 1..100
  std::string description{}, copyright{};  ///< TIFF tags; empty: not said
  std::string xmp{};                       ///< a whole XMP packet, in all formats; empty: none
};

/// Writes RGB or RGBA (JPEG: opaque) whole or not at all; the same picture gives the same bytes. kUsage: the suffix,
/// an empty picture, transparency in JPEG; the errors of AtomicFile.
Result<void> write_picture(const std::filesystem::path& path, const Image& image, const PictureOptions& options = {});

/// Any PNG, TIFF (its first page) or JPEG as 8-bit RGB, or RGBA where it has transparency. The file is not trusted.
/// kNoInput, kPermission, kIo, kBadData (also for what is no picture), kTryAgain.
Result<Image> read_picture(const std::filesystem::path& path, const Budget& budget = {});

}  // namespace dubsar
