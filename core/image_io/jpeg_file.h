#pragma once
// JPEG pictures, by libjpeg.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/system/budget.h"
#include "core/image_io/image.h"

namespace dubsar {

/// Decodes baseline and progressive JPEG, grey or colour, as 8-bit RGB. The bytes are not trusted: the
/// announced size is checked against `budget` before memory is taken. A picture cut off at its end is
/// kBadData, not a half grey one. `source` starts the error text. Errors: kBadData, kTryAgain (memory). One
/// thread, about 100 MB/s of pixels.
Result<Image> decode_jpeg(std::span<const std::byte> bytes, std::string_view source, const Budget& budget = {});

/// The same from a file, upright as its EXIF orientation says; also kNoInput, kPermission, kIo.
Result<Image> read_jpeg(const std::filesystem::path& path, const Budget& budget = {});

struct JpegOptions {
  int quality = 92;   ///< 1..100; colours keep their full resolution
  double dpi = 0.0;   ///< written into the JFIF head when > 0 (whole dots an inch, at most 65535)
  std::string xmp{};  ///< a whole XMP packet of at most 65 kB; empty: none
};

/// The bytes of a file of an RGB picture, or an opaque RGBA one, with the sRGB profile; the same picture gives the same
/// bytes. kUsage: an empty picture, one with transparency (JPEG has none), more than 65500 pixels a side.
Result<std::string> encode_jpeg(const Image& image, const JpegOptions& options = {});

/// Writes an RGB picture, or an opaque RGBA one, with the sRGB profile. The file appears whole or not at all; the same
/// picture gives the same bytes. kUsage: an empty picture, one with transparency (JPEG has none), more than 65500
/// pixels a side; the errors of AtomicFile.
Result<void> write_jpeg(const std::filesystem::path& path, const Image& image, const JpegOptions& options = {});

}  // namespace dubsar
