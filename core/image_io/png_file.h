#pragma once
// PNG files, by libpng.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/system/budget.h"
#include "core/image_io/image.h"

namespace dubsar {

struct PngOptions {
  double dpi = 0.0;     ///< written as pHYs when > 0 (rounded to whole pixels per metre)
  int compression = 6;  ///< zlib level 0..9
  std::string xmp{};    ///< a whole XMP packet, as an iTXt chunk; empty: none
};

/// Writes an RGB or RGBA picture, sRGB. The file appears whole or not at all; the same picture gives the same bytes.
/// Errors: kUsage (empty picture, wrong channel count or size), those of AtomicFile. Cost: about 30 MB/s, one thread.
Result<void> write_png(const std::filesystem::path& path, const Image& image, const PngOptions& options = {});

/// Reads any PNG (palette, grey, 1 to 16 bits, interlaced) as 8-bit RGB, or RGBA when the file has transparency. The
/// file is not trusted: sizes are checked against `budget` and against what the file's bytes can hold before memory is
/// taken. Errors: kNoInput, kPermission, kBadData (not a PNG, damaged, cut off), kTryAgain (memory), kIo.
Result<Image> read_png(const std::filesystem::path& path, const Budget& budget = {});
/// The same from bytes; `source` names them in the error text.
Result<Image> decode_png(std::span<const std::byte> bytes, std::string_view source, const Budget& budget = {});

}  // namespace dubsar
