#include "core/image_io/png_file.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {

constexpr double kMetresPerInch = 0.0254;
constexpr std::uint64_t kDeflateRatio = 1032;  // deflate cannot expand more (zlib technical details)
constexpr std::uint64_t kSignatureBytes = 8;

// libpng reports errors by longjmp. Functions that call setjmp, and the callbacks that longjmp passes through, hold
// no objects with destructors; everything lives in one of these two structs, owned by the caller.

struct Message {
  std::array<char, 160> text{};
};

void on_error(png_structp png, png_const_charp text) {
  auto* message = static_cast<Message*>(png_get_error_ptr(png));
  std::snprintf(message->text.data(), message->text.size(), "%s", text);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

struct Writer {
  Message message;
  AtomicFile* file = nullptr;
  std::optional<Error> file_error;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

bool append(Writer& writer, png_bytep bytes, std::size_t count) {
  auto written = writer.file->write(std::as_bytes(std::span(bytes, count)));
  if (!written) writer.file_error = std::move(written).error();
  return !writer.file_error;
}

void on_write(png_structp png, png_bytep bytes, std::size_t count) {
  if (!append(*static_cast<Writer*>(png_get_io_ptr(png)), bytes, count)) png_error(png, "write failed");
}
void on_flush(png_structp) {}

bool encode(Writer* writer, const Image* image, const PngOptions* options) {
  png_structp png = writer->png;
  char keyword[] = "XML:com.adobe.xmp", language[] = "", software[] = "Software", maker[] = "dubsar";
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, writer, on_write, on_flush);
  png_set_compression_level(png, options->compression);
  png_set_IHDR(png, writer->info, static_cast<png_uint_32>(image->width), static_cast<png_uint_32>(image->height), 8,
               image->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, writer->info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (options->dpi > 0) {
    const auto per_metre = static_cast<png_uint_32>(std::lround(options->dpi / kMetresPerInch));
    png_set_pHYs(png, writer->info, per_metre, per_metre, PNG_RESOLUTION_METER);
  }
  png_text made_by{};  // by which the program knows a file that it may write over
  made_by.compression = PNG_TEXT_COMPRESSION_NONE;
  made_by.key = software;
  made_by.text = maker;
  made_by.text_length = std::strlen(maker);
  png_set_text(png, writer->info, &made_by, 1);
  if (!options->xmp.empty()) {
    png_text packet{};
    packet.compression = PNG_ITXT_COMPRESSION_NONE;
    packet.key = keyword;
    packet.text = const_cast<char*>(options->xmp.c_str());  // libpng does not write to it
    packet.itxt_length = options->xmp.size();
    packet.lang = packet.lang_key = language;
    png_set_text(png, writer->info, &packet, 1);
  }
  png_write_info(png, writer->info);
  for (int y = 0; y < image->height; ++y) png_write_row(png, image->at(0, y));
  png_write_end(png, writer->info);
  return true;
}

struct Closer {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

struct Reader {
  Message message;
  std::unique_ptr<std::FILE, Closer> file;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_read(png_structp png, png_bytep bytes, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (std::fread(bytes, 1, count, reader->file.get()) != count) png_error(png, "the file ends too early");
}

bool decode_header(Reader* reader, const Budget* budget) {
  png_structp png = reader->png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, reader, on_read);
  png_set_sig_bytes(png, kSignatureBytes);
  const auto limit = static_cast<png_uint_32>(std::min<std::uint64_t>(budget->max_dimension, 0x7fffffff));
  png_set_user_limits(png, limit, limit);
  png_set_chunk_cache_max(png, 64);
  png_set_chunk_malloc_max(png, 8 << 20);
  png_read_info(png, reader->info);
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, reader->info);
  return true;
}

bool decode_rows(Reader* reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader->png)) != 0) return false;
  png_read_image(reader->png, rows);
  png_read_end(reader->png, nullptr);
  return true;
}

tl::unexpected<Error> damaged(std::string_view name, const Message& message) {
  return fail(ErrorKind::kBadData, "png: {} is damaged: {}", name, message.text.data());
}

/// `bytes` is how many there are; 0: not known.
Result<Image> decode(Reader& reader, std::string_view name, std::uint64_t bytes, const Budget& budget) {
  std::array<png_byte, kSignatureBytes> signature{};
  if (std::fread(signature.data(), 1, signature.size(), reader.file.get()) != signature.size() ||
      png_sig_cmp(signature.data(), 0, signature.size()) != 0)
    return fail(ErrorKind::kBadData, "png: {} does not start like a PNG file", name);

  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader.message, on_error, on_warning);
  reader.info = reader.png != nullptr ? png_create_info_struct(reader.png) : nullptr;
  if (reader.info == nullptr) return fail(ErrorKind::kTryAgain, "png: no memory for the decoder");
  if (!decode_header(&reader, &budget)) return damaged(name, reader.message);

  const std::uint64_t width = png_get_image_width(reader.png, reader.info);
  const std::uint64_t height = png_get_image_height(reader.png, reader.info);
  const int channels = png_get_channels(reader.png, reader.info);
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  DUBSAR_CHECK((channels == 3 || channels == 4) && row_bytes == width * static_cast<std::uint64_t>(channels));
  const std::array<std::uint64_t, 2> dims{width, height};
  DUBSAR_TRY(check_dims("png", dims, static_cast<std::uint64_t>(channels), budget));
  // The smallest raw form of a pixel is one bit.
  if (bytes > 0 && width * height / 8 > bytes * kDeflateRatio)
    return fail(ErrorKind::kBadData, "png: {} announces {} x {} pixels, which its {} bytes cannot hold", name, width,
                height, bytes);
  DUBSAR_TRY(check_memory("png", row_bytes * height + height * sizeof(png_bytep), budget));

  Image image(static_cast<int>(width), static_cast<int>(height), channels);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = image.pixels.data() + y * row_bytes;
  if (!decode_rows(&reader, rows.data())) return damaged(name, reader.message);
  return image;
}

}  // namespace

Result<void> write_png(const std::filesystem::path& path, const Image& image, const PngOptions& options) {
  if (image.width < 1 || image.height < 1 || (image.channels != 3 && image.channels != 4) ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * image.height * image.channels)
    return fail(ErrorKind::kUsage, "png: picture of {} x {} pixels, {} channels and {} bytes, expected RGB or RGBA",
                image.width, image.height, image.channels, image.pixels.size());
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path));
  Writer writer;
  writer.file = &file;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer.message, on_error, on_warning);
  writer.info = writer.png != nullptr ? png_create_info_struct(writer.png) : nullptr;
  if (writer.info == nullptr) return fail(ErrorKind::kTryAgain, "png: no memory for the encoder");
  if (!encode(&writer, &image, &options)) {
    if (writer.file_error) return tl::unexpected(*writer.file_error);
    return fail(ErrorKind::kInternal, "png: cannot encode {}: {}", path.string(), writer.message.text.data());
  }
  return file.commit();
}

Result<Image> read_png(const std::filesystem::path& path, const Budget& budget) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return fail(ErrorKind::kBadData, "png: {} is a folder, expected a PNG file", path.string());
  Reader reader;
  reader.file.reset(std::fopen(path.c_str(), "rbe"));
  if (reader.file == nullptr) return fail_errno(errno, "png: cannot open " + path.string());
  const std::uint64_t bytes = std::filesystem::file_size(path, ignored);
  return decode(reader, path.string(), ignored ? 0 : bytes, budget);
}

Result<Image> decode_png(std::span<const std::byte> bytes, std::string_view source, const Budget& budget) {
  Reader reader;
  std::string copy(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), copy.begin(), [](std::byte b) { return static_cast<char>(b); });
  if (!copy.empty()) reader.file.reset(::fmemopen(copy.data(), copy.size(), "rb"));
  if (reader.file == nullptr) return fail(ErrorKind::kBadData, "png: {} has no bytes", source);
  return decode(reader, source, bytes.size(), budget);
}

}  // namespace dubsar
