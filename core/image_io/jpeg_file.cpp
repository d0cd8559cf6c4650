#include "core/image_io/jpeg_file.h"

#include <jpeglib.h>

#include <array>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it
#include <string>

#include "core/base/input_file.h"

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
  return decode_jpeg(std::as_bytes(std::span(bytes.data(), bytes.size())), path.string(), budget);
}

}  // namespace dubsar
