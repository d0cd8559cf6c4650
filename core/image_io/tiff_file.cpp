#include "core/image_io/tiff_file.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "core/image_io/jpeg_markers.h"
#include "core/image_io/srgb_profile.h"

namespace dubsar {
namespace {

constexpr tmsize_t kMostAllocation = tmsize_t{1} << 30;
constexpr std::size_t kMostPages = 65535;
constexpr std::uint32_t kMostSide = 65535;

int keep_error(TIFF*, void* text, const char*, const char* format, va_list arguments) {
  std::array<char, 256> buffer{};
  std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  *static_cast<std::string*>(text) = buffer.data();
  return 1;
}

int drop_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

TIFF* open_tiff(const std::filesystem::path& path, const char* mode, std::string* message) {
  TIFFOpenOptions* const options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, kMostAllocation);
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_error, message);
  TIFFOpenOptionsSetWarningHandlerExtR(options, drop_warning, nullptr);
  TIFF* const tiff = TIFFOpenExt(path.c_str(), mode, options);
  TIFFOpenOptionsFree(options);
  return tiff;
}

std::string compression_name(std::uint16_t scheme) {
  switch (scheme) {
    case COMPRESSION_NONE:
      return "none";
    case COMPRESSION_LZW:
      return "LZW";
    case COMPRESSION_PACKBITS:
      return "PackBits";
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
      return "deflate";
    case COMPRESSION_JPEG:
      return "JPEG";
    default:
      return fmt::format("scheme {}", scheme);
  }
}

template <class T>
T field(TIFF* tiff, std::uint32_t tag, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : otherwise;
}

/// What stands beside the colours of a pixel.
struct TiffExtras {
  bool alpha = false, premultiplied = false;
  static TiffExtras of(TIFF* tiff) {
    std::uint16_t count = 0;
    const std::uint16_t* kinds = nullptr;
    TiffExtras extras;
    if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1 || count == 0 || kinds == nullptr) return extras;
    extras.premultiplied = kinds[0] == EXTRASAMPLE_ASSOCALPHA;
    extras.alpha = extras.premultiplied || kinds[0] == EXTRASAMPLE_UNASSALPHA;
    return extras;
  }
};

/// Where the strips of a page begin when each follows the one before; -1: they do not. The library cuts a single strip
/// of a file into several.
std::int64_t in_one_piece(TIFF* tiff) {
  const std::uint32_t strips = TIFFNumberOfStrips(tiff);
  if (strips == 0) return -1;
  const std::uint64_t begin = TIFFGetStrileOffset(tiff, 0);
  std::uint64_t next = begin;
  for (std::uint32_t strip = 0; strip < strips; ++strip) {
    if (TIFFGetStrileOffset(tiff, strip) != next) return -1;
    next += TIFFGetStrileByteCount(tiff, strip);
  }
  return begin > 0 && begin < static_cast<std::uint64_t>(INT64_MAX) ? static_cast<std::int64_t>(begin) : -1;
}

void invert(std::span<std::byte> bytes) {
  for (std::byte& byte : bytes) byte = ~byte;  // max - value, for any width
}

}  // namespace

void TiffFile::Closer::operator()(void* tiff) const noexcept { TIFFClose(static_cast<TIFF*>(tiff)); }

tl::unexpected<Error> TiffFile::damaged(const std::string& what) const {
  return fail(ErrorKind::kBadData, "tiff: {}: {}{}", path_.string(), what,
              library_says_->empty() ? "" : " (" + *library_says_ + ")");
}

bool TiffFile::has_signature(const std::filesystem::path& path) {
  const auto file = InputFile::open(path);
  std::array<char, 4> head{};
  if (!file || file->size() < 8 || !file->read_at(0, std::as_writable_bytes(std::span(head)))) return false;
  for (const char* magic : {"II*\0", "MM\0*", "II+\0", "MM\0+"})
    if (std::memcmp(head.data(), magic, 4) == 0) return true;
  return false;
}

Result<TiffFile> TiffFile::open(const std::filesystem::path& path) {
  DUBSAR_TRY(InputFile::open(path));
  TiffFile file;
  file.path_ = path;
  file.library_says_ = std::make_unique<std::string>();
  file.tiff_.reset(open_tiff(path, "rm", file.library_says_.get()));
  if (file.tiff_ == nullptr) return file.damaged("cannot be opened, it is damaged or no TIFF file");
  return file;
}

Result<TiffPage> TiffFile::describe() {
  TIFF* const tiff = static_cast<TIFF*>(tiff_.get());
  TiffPage page;
  const auto width = field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  const auto height = field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  if (width == 0 || height == 0 || width > kMostSide || height > kMostSide)
    return damaged(fmt::format("a page of {} x {} pixels found, expected 1 to {} each way", width, height, kMostSide));
  page.offset = TIFFCurrentDirOffset(tiff);
  page.width = width;
  page.height = height;
  page.data.depth = std::max<std::int64_t>(1, field<std::uint32_t>(tiff, TIFFTAG_IMAGEDEPTH, 1));
  page.bits = field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  page.channels = field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  page.palette = field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_PALETTE;
  page.reduced = (field<std::uint32_t>(tiff, TIFFTAG_SUBFILETYPE, 0) & FILETYPE_REDUCEDIMAGE) != 0;
  switch (field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT)) {
    case SAMPLEFORMAT_UINT:
      page.sample = TiffPage::Sample::kUnsigned;
      break;
    case SAMPLEFORMAT_INT:
      page.sample = TiffPage::Sample::kSigned;
      break;
    case SAMPLEFORMAT_IEEEFP:
      page.sample = TiffPage::Sample::kFloat;
      break;
    default:
      page.sample = TiffPage::Sample::kOther;
      break;
  }
  const auto scheme = field<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  page.compression = compression_name(scheme);
  float x = 0.0F, y = 0.0F;
  if (TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &x) == 1) page.resolution.x_per_unit = static_cast<double>(x);
  if (TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &y) == 1) page.resolution.y_per_unit = static_cast<double>(y);
  const auto unit = field<std::uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  page.resolution.unit_mm = unit == RESUNIT_INCH ? 25.4 : unit == RESUNIT_CENTIMETER ? 10.0 : 0.0;
  const auto text_of = [&](std::uint32_t tag) {
    const char* text = nullptr;
    return TIFFGetField(tiff, tag, &text) == 1 && text != nullptr ? std::string(text).substr(0, 65536) : std::string();
  };
  page.texts = {text_of(TIFFTAG_IMAGEDESCRIPTION), text_of(TIFFTAG_PAGENAME), text_of(TIFFTAG_SOFTWARE)};
  if (std::uint16_t orientation = 0; TIFFGetField(tiff, TIFFTAG_ORIENTATION, &orientation) == 1)
    page.orientation = orientation;
  page.big_endian = TIFFIsBigEndian(tiff) != 0;
  page.white_is_zero =
      field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE;
  if (scheme == COMPRESSION_NONE && TIFFIsTiled(tiff) == 0) page.data.offset = in_one_piece(tiff);
  return page;
}

Result<std::vector<TiffPage>> TiffFile::pages() {
  TIFF* const tiff = static_cast<TIFF*>(tiff_.get());
  std::vector<TiffPage> all;
  DUBSAR_ASSIGN(TiffPage page, select(0));
  for (;;) {
    all.push_back(page);
    if (TIFFLastDirectory(tiff) != 0) return all;
    if (all.size() >= kMostPages) return damaged(fmt::format("more than {} pages found, expected fewer", kMostPages));
    library_says_->clear();
    if (TIFFReadDirectory(tiff) != 1)
      return damaged(fmt::format("page {} cannot be read, the file is damaged", all.size() + 1));
    DUBSAR_ASSIGN(page, describe());
  }
}

Result<TiffPage> TiffFile::select(std::uint64_t offset) {
  TIFF* const tiff = static_cast<TIFF*>(tiff_.get());
  const bool good = offset == 0 ? TIFFSetDirectory(tiff, 0) == 1
                                : TIFFCurrentDirOffset(tiff) == offset || TIFFSetSubDirectory(tiff, offset) == 1;
  if (!good) return damaged("a page cannot be read, the file is damaged");
  return describe();
}

Result<void> TiffFile::read_gray(std::span<std::byte> out) {
  TIFF* const tiff = static_cast<TIFF*>(tiff_.get());
  DUBSAR_ASSIGN(const TiffPage page, describe());
  const std::int64_t row = page.width * page.bits / 8;
  DUBSAR_CHECK(page.channels == 1 && page.bits % 8 == 0 && static_cast<std::int64_t>(out.size()) == row * page.height);
  library_says_->clear();
  const auto short_of = [&](const char* piece, std::uint32_t index) {
    return damaged(fmt::format("{} {} cannot be decoded, the file is damaged or truncated", piece, index));
  };
  if (TIFFIsTiled(tiff) == 0) {
    const std::uint32_t strips = TIFFNumberOfStrips(tiff);
    std::size_t at = 0;
    for (std::uint32_t strip = 0; strip < strips && at < out.size(); ++strip) {
      const auto expected = std::min<std::uint64_t>(
          TIFFVStripSize64(tiff, std::min<std::uint32_t>(field<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, UINT32_MAX),
                                                         static_cast<std::uint32_t>(page.height))),
          out.size() - at);
      const tmsize_t got = TIFFReadEncodedStrip(tiff, strip, out.data() + at, static_cast<tmsize_t>(expected));
      if (got < 0 || static_cast<std::uint64_t>(got) != expected) return short_of("strip", strip);
      at += expected;
    }
    if (at != out.size()) return damaged("fewer rows found than announced, the file is damaged");
  } else {
    const auto tile_width = static_cast<std::int64_t>(field<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0));
    const auto tile_height = static_cast<std::int64_t>(field<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0));
    const std::int64_t sample = page.bits / 8;
    const tmsize_t bytes = TIFFTileSize(tiff);
    if (tile_width <= 0 || tile_height <= 0 || bytes != tile_width * tile_height * sample || bytes > kMostAllocation)
      return damaged(fmt::format("tiles of {} x {} pixels found, expected smaller ones", tile_width, tile_height));
    std::vector<std::byte> tile(static_cast<std::size_t>(bytes));
    for (std::int64_t y = 0; y < page.height; y += tile_height)
      for (std::int64_t x = 0; x < page.width; x += tile_width) {
        const std::uint32_t index =
            TIFFComputeTile(tiff, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
        if (TIFFReadEncodedTile(tiff, index, tile.data(), bytes) != bytes) return short_of("tile", index);
        const auto count = static_cast<std::size_t>(std::min(tile_width, page.width - x) * sample);
        for (std::int64_t j = 0; j < std::min(tile_height, page.height - y); ++j)
          std::memcpy(out.data() + (y + j) * row + x * sample, tile.data() + j * tile_width * sample, count);
      }
  }
  if (page.sample == TiffPage::Sample::kUnsigned &&
      field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE)
    invert(out);
  return {};
}

Result<Image> TiffFile::read_picture(const Budget& budget) {
  TIFF* const tiff = static_cast<TIFF*>(tiff_.get());
  DUBSAR_ASSIGN(const TiffPage page, describe());
  const auto width = static_cast<std::uint64_t>(page.width), height = static_cast<std::uint64_t>(page.height);
  const std::array dims{width, height};
  DUBSAR_TRY(check_dims("tiff", dims, 4, budget));
  DUBSAR_TRY(check_memory("tiff", width * height * 8, budget));
  library_says_->clear();
  const auto extras = TiffExtras::of(tiff);
  const bool plain = page.bits == 8 && !page.palette && TIFFIsTiled(tiff) == 0 &&
                     field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, 0) == PHOTOMETRIC_RGB &&
                     field<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_CONTIG &&
                     field<std::uint16_t>(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) == ORIENTATION_TOPLEFT;
  if (plain && (page.channels == 3 || (page.channels == 4 && extras.alpha && !extras.premultiplied))) {
    Image image(static_cast<int>(width), static_cast<int>(height), page.channels);
    const std::size_t row = width * static_cast<std::size_t>(page.channels);
    for (std::uint32_t y = 0; y < height; ++y)
      if (TIFFReadScanline(tiff, image.pixels.data() + y * row, y, 0) != 1)
        return damaged(fmt::format("row {} cannot be decoded, the file is damaged or truncated", y));
    return image;
  }
  std::array<char, 1024> why{};
  if (TIFFRGBAImageOK(tiff, why.data()) != 1)
    return damaged(fmt::format("no picture that can be shown: {}", why.data()));
  std::vector<std::uint32_t> raster(width * height);
  if (TIFFReadRGBAImageOriented(tiff, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                                raster.data(), std::max(1, page.orientation), 1) != 1)
    return damaged("the picture cannot be decoded, the file is damaged or truncated");
  Image image(static_cast<int>(width), static_cast<int>(height), extras.alpha ? 4 : 3);
  std::uint8_t* out = image.pixels.data();
  for (const std::uint32_t pixel : raster) {
    const std::array rgb{TIFFGetR(pixel), TIFFGetG(pixel), TIFFGetB(pixel)};
    const std::uint32_t alpha = TIFFGetA(pixel);
    for (const std::uint32_t value : rgb)  // libtiff gives colours times alpha
      *out++ = static_cast<std::uint8_t>(
          !extras.alpha || alpha == 0 ? value : std::min<std::uint32_t>(255, (255 * value + alpha / 2) / alpha));
    if (extras.alpha) *out++ = static_cast<std::uint8_t>(alpha);
  }
  return upright(std::move(image), page.orientation);
}

Result<Image> read_tiff_picture(const std::filesystem::path& path, const Budget& budget) {
  DUBSAR_ASSIGN(TiffFile file, TiffFile::open(path));
  DUBSAR_TRY(file.select(0));
  return file.read_picture(budget);
}

namespace {

/// What stands in one page of a file.
struct PageText {
  const TiffTags* tags = nullptr;
  std::string name{};
  int number = 0, count = 1;
};

bool write_page(TIFF* tiff, const Image& image, double dpi, const PageText& text) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.height));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, image.channels);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, "dubsar");
  if (!text.name.empty()) TIFFSetField(tiff, TIFFTAG_PAGENAME, text.name.c_str());
  if (text.count > 1)
    TIFFSetField(tiff, TIFFTAG_PAGENUMBER, static_cast<std::uint16_t>(text.number),
                 static_cast<std::uint16_t>(text.count));
  if (text.tags != nullptr) {
    const TiffTags& tags = *text.tags;
    if (!tags.description.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, tags.description.c_str());
    if (!tags.copyright.empty()) TIFFSetField(tiff, TIFFTAG_COPYRIGHT, tags.copyright.c_str());
    if (!tags.xmp.empty())
      TIFFSetField(tiff, TIFFTAG_XMLPACKET, static_cast<std::uint32_t>(tags.xmp.size()), tags.xmp.data());
  }
  const auto profile = srgb_profile();
  TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
  if (image.channels == 4) {
    const std::uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &alpha);
  }
  if (dpi > 0.0) {
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, dpi);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, dpi);
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  }
  constexpr int kRowsPerStrip = 64;
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kRowsPerStrip);
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  std::vector<std::uint8_t> strip;  // libtiff changes the buffer it encodes
  for (int y = 0; y < image.height; y += kRowsPerStrip) {
    const auto rows = static_cast<std::size_t>(std::min(kRowsPerStrip, image.height - y));
    const auto from = image.pixels.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row);
    strip.assign(from, from + static_cast<std::ptrdiff_t>(rows * row));
    if (TIFFWriteEncodedStrip(tiff, static_cast<std::uint32_t>(y / kRowsPerStrip), strip.data(),
                              static_cast<tmsize_t>(strip.size())) < 0)
      return false;
  }
  return true;
}

struct TiffCloser {
  void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};

struct NamedImage {
  const Image* image = nullptr;
  std::string name{};
};

Result<void> write_pages(const std::filesystem::path& path, int count,
                         const std::function<Result<NamedImage>(int)>& page, double dpi, const TiffTags& tags) {
  DUBSAR_CHECK(count > 0);
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path));
  std::string message;
  const auto failed = [&] {
    return fail(ErrorKind::kIo, "tiff: cannot write {} ({}); is the disk full?", path.string(), message);
  };
  std::unique_ptr<TIFF, TiffCloser> tiff;
  for (int k = 0; k < count; ++k) {
    DUBSAR_ASSIGN(const NamedImage one, page(k));
    const Image& image = *one.image;
    DUBSAR_CHECK(image.width > 0 && image.height > 0 && (image.channels == 3 || image.channels == 4));
    DUBSAR_CHECK(image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                                            static_cast<std::size_t>(image.channels));
    const bool big = static_cast<std::size_t>(count) * image.pixels.size() > (std::size_t{3} << 30);
    if (!tiff) tiff.reset(open_tiff(file.temporary_path(), big ? "w8" : "w", &message));
    if (!tiff || !write_page(tiff.get(), image, dpi, {k == 0 ? &tags : nullptr, one.name, k, count})) return failed();
    if (k + 1 < count && TIFFWriteDirectory(tiff.get()) != 1) return failed();
  }
  if (TIFFFlush(tiff.get()) != 1) return failed();
  tiff.reset();
  return file.commit();
}

}  // namespace

Result<void> write_tiff_layers(const std::filesystem::path& path, int count,
                               const std::function<Result<TiffLayer>(int)>& layer, double dpi, const TiffTags& tags) {
  TiffLayer now;
  const auto page = [&](int k) -> Result<NamedImage> {
    DUBSAR_ASSIGN(now, layer(k));
    return NamedImage{&now.image, now.name};
  };
  return write_pages(path, count, page, dpi, tags);
}

Result<void> write_tiff(const std::filesystem::path& path, const Image& image, double dpi, const TiffTags& tags) {
  return write_pages(
      path, 1, [&](int) -> Result<NamedImage> { return NamedImage{&image}; }, dpi, tags);
}

}  // namespace dubsar
