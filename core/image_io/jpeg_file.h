#pragma once
// JPEG pictures, by libjpeg.

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/base/budget.h"
#include "core/base/result.h"
#include "core/image_io/image.h"

namespace dubsar {

/// Decodes baseline and progressive JPEG, grey or colour, as 8-bit RGB. The bytes are not trusted: the
/// announced size is checked against `budget` before memory is taken. A picture cut off at its end is
/// kBadData, not a half grey one. `source` starts the error text. Errors: kBadData, kTryAgain (memory). One
/// thread, about 100 MB/s of pixels.
Result<Image> decode_jpeg(std::span<const std::byte> bytes, std::string_view source, const Budget& budget = {});

/// The same from a file; also kNoInput, kPermission, kIo.
Result<Image> read_jpeg(const std::filesystem::path& path, const Budget& budget = {});

}  // namespace dubsar
