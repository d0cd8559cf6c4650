#include "core/image_io/jpeg_file.h"

#include <jpeglib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "core/image_io/jpeg_markers.h"
#include "core/image_io/srgb_profile.h"

namespace dubsar {
namespace {

constexpr int kLargestSize = 65500;  // JPEG_MAX_DIMENSION
constexpr long kDecoderMemory = 512l << 20;

// libjpeg reports errors by calling back; the call back jumps out. No object with a destructor lives between
// setjmp and the jump; everything is in here, owned by the caller.
struct Decoder {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> message{};
  ~Decoder() { jpeg_destroy_decompress(&jpeg); }
};

[[noreturn]] void on_error(j_common_ptr jpeg) {
  auto* const decoder = static_cast<Decoder*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, decoder->message.data());
  std::longjmp(decoder->jump, 1);
}
void on_message(j_common_ptr jpeg, int level) {
  if (level < 0) on_error(jpeg);  // a warning: the data are damaged or end too early
}

bool read_header(Decoder* decoder, const unsigned char* bytes, unsigned long size) {
  if (setjmp(decoder->jump) != 0) return false;
  jpeg_create_decompress(&decoder->jpeg);
  decoder->jpeg.mem->max_memory_to_use = kDecoderMemory;
  jpeg_mem_src(&decoder->jpeg, bytes, size);
  jpeg_read_header(&decoder->jpeg, TRUE);
  decoder->jpeg.out_color_space = JCS_RGB;
  return true;
}

bool read_rows(Decoder* decoder, Image* image) {
  if (setjmp(decoder->jump) != 0) return false;
  jpeg_start_decompress(&decoder->jpeg);
  while (decoder->jpeg.output_scanline < decoder->jpeg.output_height) {
    JSAMPROW row = image->at(0, static_cast<int>(decoder->jpeg.output_scanline));
    jpeg_read_scanlines(&decoder->jpeg, &row, 1);
  }
  jpeg_finish_decompress(&decoder->jpeg);
  return true;
}

struct Encoder {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> message{};
  unsigned char* bytes = nullptr;  // of malloc()
  unsigned long size = 0;
  ~Encoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
};

[[noreturn]] void on_encoder_error(j_common_ptr jpeg) {
  auto* const encoder = static_cast<Encoder*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, encoder->message.data());
  std::longjmp(encoder->jump, 1);
}

constexpr std::string_view kXmpMark("http://ns.adobe.com/xap/1.0/\0", 29);
constexpr std::size_t kMostMarkerBytes = 65533;

bool encode(Encoder* encoder, const Image* image, const JpegOptions* options, const std::string* xmp) {
  if (setjmp(encoder->jump) != 0) return false;
  jpeg_compress_struct& jpeg = encoder->jpeg;
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, &encoder->bytes, &encoder->size);
  jpeg.image_width = static_cast<JDIMENSION>(image->width);
  jpeg.image_height = static_cast<JDIMENSION>(image->height);
  jpeg.input_components = image->channels;
  jpeg.in_color_space = image->channels == 4 ? JCS_EXT_RGBX : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, options->quality, TRUE);
  jpeg.optimize_coding = TRUE;
  for (int c = 0; c < jpeg.num_components; ++c) jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
  if (options->dpi > 0.0) {
    jpeg.density_unit = 1;  // dots an inch
    jpeg.X_density = jpeg.Y_density = static_cast<UINT16>(std::clamp(std::lround(options->dpi), 1l, 65535l));
  }
  jpeg_start_compress(&jpeg, TRUE);
  static constexpr std::string_view kMaker =
      "made by dubsar";  // by which the program knows a file that it may write over
  jpeg_write_marker(&jpeg, JPEG_COM, reinterpret_cast<const JOCTET*>(kMaker.data()),
                    static_cast<unsigned>(kMaker.size()));
  if (!xmp->empty())
    jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(xmp->data()),
                      static_cast<unsigned>(xmp->size()));
  jpeg_write_icc_profile(&jpeg, reinterpret_cast<const JOCTET*>(srgb_profile().data()),
                         static_cast<unsigned>(srgb_profile().size()));
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image->at(0, static_cast<int>(jpeg.next_scanline)));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

bool opaque(const Image& image) {
  if (image.channels == 3) return true;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    if (image.pixels[i] != 255) return false;
  return true;
}

}  // namespace

Result<Image> decode_jpeg(std::span<const std::byte> bytes, std::string_view source, const Budget& budget) {
  Decoder decoder;
  decoder.jpeg.err = jpeg_std_error(&decoder.errors);
  decoder.errors.error_exit = on_error;
  decoder.errors.emit_message = on_message;
  decoder.jpeg.client_data = &decoder;
  const auto damaged = [&] { return fail(ErrorKind::kBadData, "{}: {}", source, decoder.message.data()); };
  if (!read_header(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()),
                   static_cast<unsigned long>(bytes.size())))
    return damaged();
  const std::array<std::uint64_t, 2> size{decoder.jpeg.image_width, decoder.jpeg.image_height};
  DUBSAR_TRY(check_dims(source, size, 3, budget));
  if (size[0] > kLargestSize || size[1] > kLargestSize)
    return fail(ErrorKind::kBadData, "{}: {} x {} pixels", source, size[0], size[1]);
  DUBSAR_TRY(check_memory(source, size[0] * size[1] * 3, budget));
  Image image(static_cast<int>(size[0]), static_cast<int>(size[1]), 3);
  if (!read_rows(&decoder, &image)) return damaged();
  return image;
}

Result<Image> read_jpeg(const std::filesystem::path& path, const Budget& budget) {
  DUBSAR_ASSIGN(const std::string bytes, read_file_bytes(path));
  const auto all = std::as_bytes(std::span(bytes.data(), bytes.size()));
  DUBSAR_ASSIGN(Image image, decode_jpeg(all, path.string(), budget));
  return upright(std::move(image), read_jpeg_markers(all).orientation);
}

Result<std::string> encode_jpeg(const Image& image, const JpegOptions& options) {
  if (image.width < 1 || image.height < 1 || image.width > kLargestSize || image.height > kLargestSize ||
      (image.channels != 3 && image.channels != 4) ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * image.height * image.channels)
    return fail(ErrorKind::kUsage,
                "jpeg: a picture of {} x {} pixels found, expected 1 to {} a side; PNG and TIFF take more", image.width,
                image.height, kLargestSize);
  if (options.quality < 1 || options.quality > 100)
    return fail(ErrorKind::kUsage, "jpeg: quality {} found, expected 1 to 100", options.quality);
  if (!opaque(image))
    return fail(ErrorKind::kUsage, "jpeg: a picture with transparency found, which JPEG has not; take PNG or TIFF");
  const std::string xmp = options.xmp.empty() ? std::string() : std::string(kXmpMark) + options.xmp;
  if (xmp.size() > kMostMarkerBytes)
    return fail(ErrorKind::kUsage, "jpeg: {} bytes of XMP found, expected at most {}; shorten the title or the rights",
                xmp.size(), kMostMarkerBytes);
  Encoder encoder;
  encoder.jpeg.err = jpeg_std_error(&encoder.errors);
  encoder.errors.error_exit = on_encoder_error;
  encoder.jpeg.client_data = &encoder;
  if (!encode(&encoder, &image, &options, &xmp))
    return fail(ErrorKind::kInternal, "jpeg: cannot encode: {}", encoder.message.data());
  return std::string(reinterpret_cast<const char*>(encoder.bytes), encoder.size);
}

Result<void> write_jpeg(const std::filesystem::path& path, const Image& image, const JpegOptions& options) {
  DUBSAR_ASSIGN(const std::string bytes, encode_jpeg(image, options));
  return write_file_atomically(path, std::string_view(bytes));
}

}  // namespace dubsar
