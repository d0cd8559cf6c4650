#include "core/image_io/jpeg_markers.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/base/files/file_suffix.h"
#include "core/base/files/input_file.h"
#include "core/image_io/jpeg_file.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kDisparity = 0x020002;

/// A TIFF structure inside a marker; reads beyond its end give 0.
class Directory {
 public:
  explicit Directory(std::span<const std::byte> bytes) : bytes_(bytes), big_(byte(0) == 'M') {}
  bool good() const { return bytes_.size() >= 8 && (byte(0) == 'I' || byte(0) == 'M') && number(2, 2) == 42; }
  std::uint32_t number(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | byte(big_ ? at + i : at + count - 1 - i);
    return value;
  }
  /// Where the entry of a tag stands in the first directory; nullopt: it has none.
  std::optional<std::size_t> find(std::uint32_t tag) const {
    const std::size_t first = number(4, 4), count = std::min<std::size_t>(number(first, 2), 512);
    for (std::size_t i = 0; i < count; ++i)
      if (const std::size_t at = first + 2 + 12 * i; number(at, 2) == tag) return at;
    return std::nullopt;
  }

 private:
  std::uint8_t byte(std::size_t at) const {
    return at < bytes_.size() ? std::to_integer<std::uint8_t>(bytes_[at]) : std::uint8_t{0};
  }
  std::span<const std::byte> bytes_;
  bool big_;
};

int exif_orientation(std::span<const std::byte> tiff) {
  const Directory directory(tiff);
  const auto entry = directory.good() ? directory.find(274) : std::nullopt;
  const std::uint32_t value = entry ? directory.number(*entry + 8, 2) : 1;
  return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
}

std::vector<JpegMarkers::Picture> mp_pictures(std::span<const std::byte> tiff, std::size_t base, std::size_t file) {
  const Directory directory(tiff);
  const auto entry = directory.good() ? directory.find(0xB002) : std::nullopt;
  if (!entry) return {};
  std::vector<JpegMarkers::Picture> pictures;
  const std::size_t bytes = directory.number(*entry + 4, 4), at = directory.number(*entry + 8, 4);
  for (std::size_t i = 0; i + 16 <= std::min<std::size_t>(bytes, 64 * 16); i += 16) {
    JpegMarkers::Picture one{directory.number(at + i, 4) & 0xFFFFFF, directory.number(at + i + 8, 4),
                             directory.number(at + i + 4, 4)};
    one.offset = i == 0 ? 0 : base + one.offset;  // counted from the structure, that of the first from the file
    if (one.offset >= file) return {};
    one.bytes = std::min(one.bytes, file - one.offset);
    pictures.push_back(one);
  }
  return pictures;
}

}  // namespace

JpegMarkers read_jpeg_markers(std::span<const std::byte> bytes) {
  JpegMarkers out;
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint8_t>(bytes[i]); };
  if (bytes.size() < 4 || at(0) != 0xFF || at(1) != 0xD8) return out;
  for (std::size_t i = 2; i + 4 <= bytes.size() && at(i) == 0xFF;) {
    const std::uint8_t marker = at(i + 1);
    if (marker == 0xFF) {  // fill byte
      ++i;
      continue;
    }
    if (marker == 0xDA || marker == 0xD9) break;
    const std::size_t length = static_cast<std::size_t>(at(i + 2)) << 8 | at(i + 3);
    if (length < 2 || i + 2 + length > bytes.size()) break;
    const auto body = bytes.subspan(i + 4, length - 2);
    const std::string_view text(reinterpret_cast<const char*>(body.data()), body.size());
    if (marker == 0xE1 && text.starts_with(std::string_view("Exif\0\0", 6)))
      out.orientation = exif_orientation(body.subspan(6));
    if (marker == 0xE2 && text.starts_with(std::string_view("MPF\0", 4)) && out.pictures.empty())
      out.pictures = mp_pictures(body.subspan(4), i + 8, bytes.size());
    // "_JPSJPS_", two bytes of length, then kind, layout and flags from the low end of a big endian word
    if (marker == 0xE3 && text.starts_with("_JPSJPS_") && body.size() >= 14) {
      const auto flag = [&](std::size_t k) { return std::to_integer<std::uint8_t>(body[k]); };
      const int layout = flag(12), flags = flag(11);
      if (flag(13) == 1 && (layout == 2 || layout == 3))
        out.pair = JpsPair{layout == 3, (flags & (layout == 3 ? 1 : 2)) != 0, (flags & 4) == 0};
    }
    i += 2 + length;
  }
  return out;
}

Image upright(Image image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  const bool turned = orientation >= 5;
  const bool right = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool bottom = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  Image out(turned ? image.height : image.width, turned ? image.width : image.height, image.channels);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int to_x = turned ? y : x, to_y = turned ? x : y;
      if (right) to_x = out.width - 1 - to_x;
      if (bottom) to_y = out.height - 1 - to_y;
      std::memcpy(out.at(to_x, to_y), image.at(x, y), channels);
    }
  return out;
}

Result<std::vector<Image>> read_jpeg_views(const std::filesystem::path& path, int& others, const Budget& budget) {
  others = 0;
  std::vector<Image> views;
  DUBSAR_ASSIGN(const std::string text, read_file_bytes(path));
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  const JpegMarkers markers = read_jpeg_markers(bytes);
  if (markers.pictures.size() < 2) return views;
  const auto is_view = [](const JpegMarkers::Picture& one) { return one.kind == kDisparity; };
  const auto all = static_cast<int>(markers.pictures.size());
  const auto said = static_cast<int>(std::count_if(markers.pictures.begin(), markers.pictures.end(), is_view));
  const bool by_name = said < 2 && lower_suffix(path) == ".mpo";
  others = all - 1;
  if (said < 2 && !by_name) return views;
  for (const JpegMarkers::Picture& one : markers.pictures) {
    if (!by_name && !is_view(one)) continue;
    const auto piece = bytes.subspan(one.offset, one.bytes);
    DUBSAR_ASSIGN(Image image, decode_jpeg(piece, path.string(), budget));
    image = upright(std::move(image), read_jpeg_markers(piece).orientation);
    if (!views.empty() && (image.width != views[0].width || image.height != views[0].height)) continue;
    views.push_back(std::move(image));
  }
  if (views.size() < 2 || (by_name && views.size() != 2)) views.clear();
  others = views.empty() ? all - 1 : all - static_cast<int>(views.size());
  return views;
}

}  // namespace dubsar
