#include "core/volume/formats/import_options.h"

#include <charconv>
#include <vector>

#include "core/base/numbers/units.h"

namespace dubsar {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Result<CropRange> parse_crop(std::string_view text) {
  const auto wrong = [&] {
    return fail(
        ErrorKind::kUsage,
        "crop \"{}\" not understood, expected x0:x1,y0:y1,z0:z1 with 0 <= x0 < x1; an empty bound is the border", text);
  };
  const auto axes = split(text, ',');
  if (axes.size() != 3) return wrong();
  CropRange crop;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto bounds = split(axes[axis], ':');
    if (bounds.size() != 2) return wrong();
    const auto begin = bounds[0].empty() ? std::optional<std::int64_t>(0) : whole_number(bounds[0]);
    const auto end = bounds[1].empty() ? std::optional<std::int64_t>(-1) : whole_number(bounds[1]);
    if (!begin || !end || *begin < 0 || (!bounds[1].empty() && *end <= *begin)) return wrong();
    crop.begin[axis] = *begin;
    crop.end[axis] = *end;
  }
  return crop;
}

Result<std::array<std::int64_t, 3>> parse_stride(std::string_view text) {
  std::array<std::int64_t, 3> stride{};
  const auto parts = split(text, ',');
  for (std::size_t axis = 0; axis < 3 && (parts.size() == 1 || parts.size() == 3); ++axis)
    stride[axis] = whole_number(parts[parts.size() == 1 ? 0 : axis]).value_or(0);
  if (stride[0] < 1 || stride[1] < 1 || stride[2] < 1)
    return fail(ErrorKind::kUsage,
                "stride \"{}\" not understood, expected one whole number or three (x,y,z), at least 1", text);
  return stride;
}

Result<std::array<std::int64_t, 3>> parse_dims(std::string_view text) {
  std::array<std::int64_t, 3> dims{};
  const auto parts = split(text, 'x');
  for (std::size_t axis = 0; axis < 3 && parts.size() == 3; ++axis) dims[axis] = whole_number(parts[axis]).value_or(0);
  if (dims[0] < 1 || dims[1] < 1 || dims[2] < 1)
    return fail(ErrorKind::kUsage, "size \"{}\" not understood, expected XxYxZ such as 512x512x300", text);
  return dims;
}

Result<glm::dvec3> parse_voxel_size(std::string_view text) {
  const auto parts = split(text, ',');
  if (parts.size() != 1 && parts.size() != 3)
    return fail(ErrorKind::kUsage, "voxel size \"{}\" not understood, expected one length or three (x,y,z)", text);
  glm::dvec3 mm(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    DUBSAR_ASSIGN(mm[axis], parse_length_mm(parts[parts.size() == 1 ? 0 : static_cast<std::size_t>(axis)]));
    if (mm[axis] <= 0.0) return fail(ErrorKind::kUsage, "voxel size \"{}\" found, expected more than 0", text);
  }
  return mm;
}

Result<ByteOrder> parse_byte_order(std::string_view text) {
  if (text == "little") return ByteOrder::kLittle;
  if (text == "big") return ByteOrder::kBig;
  return fail(ErrorKind::kUsage, "byte order \"{}\" found, expected little or big", text);
}

}  // namespace dubsar
