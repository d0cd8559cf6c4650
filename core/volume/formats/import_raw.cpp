#include "core/volume/formats/import_raw.h"

#include <charconv>
#include <system_error>
#include <utility>

#include "core/volume/formats/flat_reader.h"

namespace dubsar {
namespace {

constexpr std::string_view kContiguous = "contiguous", kBehind = "contiguous behind ";

}  // namespace

Result<OpenedVolume> open_raw(const ImportOptions& options) {
  DUBSAR_CHECK(options.raw.has_value());
  const RawSpec& raw = *options.raw;
  DUBSAR_ASSIGN(InputFile file, InputFile::open(options.path));
  const auto unsigned_of = [](std::int64_t n) { return static_cast<std::uint64_t>(n < 0 ? 0 : n); };
  const std::array<std::uint64_t, 3> dims{unsigned_of(raw.dims[0]), unsigned_of(raw.dims[1]), unsigned_of(raw.dims[2])};
  DUBSAR_ASSIGN(const std::int64_t count,
                check_dims("import_raw: the size given", dims, unsigned_of(scalar_bytes(raw.type)), options.budget));
  const std::int64_t bytes = count * scalar_bytes(raw.type);
  const std::int64_t left = file.size() - raw.skip;
  if (raw.skip < 0 || left < bytes)
    return fail(
        ErrorKind::kBadData,
        "import_raw: {} has {} bytes, expected {} ({} x {} x {} of {} behind {} skipped bytes); check the size, the "
        "number type and the bytes to skip",
        options.path.string(), file.size(), raw.skip + bytes, raw.dims[0], raw.dims[1], raw.dims[2],
        scalar_name(raw.type), raw.skip);
  OpenedVolume opened;
  VolumeInfo& info = opened.info;
  if (left > bytes)
    info.warnings.push_back(fmt::format(
        "{} bytes follow the voxels and are not read; check the size, the number type and the bytes to skip",
        left - bytes));
  info.format = "raw";
  info.found_by = "named by the user";
  info.file_dims = {raw.dims[0], raw.dims[1], raw.dims[2]};
  info.stored.dtype = scalar_name(raw.type);
  info.stored.byte_order = order_name(raw.order);
  info.stored.layout = raw_layout(raw.skip);
  info.stored.storage_bytes = info.stored.logical_bytes = bytes;
  info.stored.may_have_nonfinite = is_float(raw.type);
  std::vector<FlatSegment> segments;
  segments.push_back({std::move(file), raw.skip, bytes});
  DUBSAR_ASSIGN(opened.reader, make_flat_reader({info.file_dims, {raw.type, raw.order, {}}, std::move(segments)}));
  return opened;
}

std::string raw_layout(std::int64_t skip) {
  return skip > 0 ? fmt::format("{}{} bytes", kBehind, skip) : std::string(kContiguous);
}

std::optional<std::int64_t> skip_of_layout(std::string_view layout) {
  if (layout == kContiguous) return 0;
  if (!layout.starts_with(kBehind)) return std::nullopt;
  const char* const digits = layout.data() + kBehind.size();
  std::int64_t skip = 0;
  if (std::from_chars(digits, layout.data() + layout.size(), skip).ec != std::errc()) return std::nullopt;
  return skip;
}

}  // namespace dubsar
