#include "core/image_io/picture_file.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/base/files/file_suffix.h"
#include "core/base/files/input_file.h"
#include "core/image_io/jpeg_file.h"
#include "core/image_io/png_file.h"
#include "core/image_io/tiff_file.h"

namespace dubsar {
namespace {

struct Suffix {
  std::string_view text;
  PictureFormat format;
};
constexpr std::array<Suffix, 5> kSuffixes{{{".png", PictureFormat::kPng},
                                           {".tif", PictureFormat::kTiff},
                                           {".tiff", PictureFormat::kTiff},
                                           {".jpg", PictureFormat::kJpeg},
                                           {".jpeg", PictureFormat::kJpeg}}};

}  // namespace

Result<PictureFormat> picture_format_from_path(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  for (const Suffix& known : kSuffixes)
    if (suffix == known.text) return known.format;
  return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .png, .tif or .jpg", path.string());
}

Result<void> write_picture(const std::filesystem::path& path, const Image& image, const PictureOptions& options) {
  DUBSAR_ASSIGN(const PictureFormat format, picture_format_from_path(path));
  if (image.width < 1 || image.height < 1)
    return fail(ErrorKind::kUsage, "cannot write {}: the picture has no pixels", path.string());
  switch (format) {
    case PictureFormat::kPng: {
      PngOptions png;
      png.dpi = options.dpi;
      png.xmp = options.xmp;
      return write_png(path, image, png);
    }
    case PictureFormat::kJpeg:
      return write_jpeg(path, image, {options.jpeg_quality, options.dpi, options.xmp});
    case PictureFormat::kTiff:
      break;
  }
  return write_tiff(path, image, options.dpi, {options.description, options.copyright, options.xmp});
}

Result<Image> read_picture(const std::filesystem::path& path, const Budget& budget) {
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(path));
  std::array<char, 4> head{};
  if (file.size() >= static_cast<std::int64_t>(head.size()))
    DUBSAR_TRY(file.read_at(0, std::as_writable_bytes(std::span(head))));
  const std::string_view magic(head.data(), head.size());
  if (magic == "\x89PNG") return read_png(path, budget);
  if (magic.starts_with("\xff\xd8\xff")) return read_jpeg(path, budget);
  if (TiffFile::has_signature(path)) return read_tiff_picture(path, budget);
  return fail(ErrorKind::kBadData, "{} is no picture that can be read, expected PNG, TIFF or JPEG", path.string());
}

}  // namespace dubsar
