#include "core/volume/formats/import_nrrd.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "core/base/numbers/units.h"
#include "core/base/text/lower_text.h"
#include "core/volume/formats/external_access.h"
#include "core/volume/formats/flat_reader.h"
#include "core/volume/formats/gzip_stream.h"

namespace dubsar {
namespace {

constexpr std::int64_t kMostHeader = 1 << 20;

struct Header {
  std::map<std::string, std::string> fields;  ///< names in lower case
  std::int64_t end = 0;                       ///< first byte behind the blank line

  std::string text(const char* name, const char* other_name = "") const {
    auto found = fields.find(name);
    if (found == fields.end()) found = fields.find(other_name);
    return found == fields.end() ? "" : found->second;
  }
};

std::string trimmed(std::string text) {
  const auto space = [](unsigned char c) { return std::isspace(c) != 0; };
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), space));
  text.erase(std::find_if_not(text.rbegin(), text.rend(), space).base(), text.end());
  return text;
}

std::optional<double> to_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// "(1,0,0) none (0,1,0)" or "1 2 3" or "\"mm\" \"mm\"": words, with brackets and quotes kept together.
std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> all;
  std::string word;
  bool quoted = false, inside = false;
  for (const char c : text) {
    if (c == '"') {
      if (quoted) all.push_back(std::exchange(word, ""));
      quoted = !quoted;
    } else if (!quoted && !inside && std::isspace(static_cast<unsigned char>(c)) != 0) {
      if (!word.empty()) all.push_back(std::exchange(word, ""));
    } else {
      inside = c == '(' || (inside && c != ')');
      word += c;
    }
  }
  if (!word.empty()) all.push_back(word);
  return all;
}

Result<Header> read_header(const InputFile& file) {
  std::string text(static_cast<std::size_t>(std::min(file.size(), kMostHeader)), '\0');
  DUBSAR_TRY(file.read_at(0, std::as_writable_bytes(std::span(text))));
  Header header;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t newline = text.find('\n', begin);
    const std::size_t end = std::min(newline, text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    header.end = static_cast<std::int64_t>(std::min(begin, text.size()));
    if (line.empty()) return header;
    const auto colon = line.find(": ");
    if (line.front() == '#' || colon == std::string::npos) continue;
    header.fields[lower_text(line.substr(0, colon))] = trimmed(line.substr(colon + 2));
  }
  if (file.size() > kMostHeader)
    return fail(ErrorKind::kBadData, "import_nrrd: {} has a header of more than 1 MiB, expected less",
                file.path().string());
  return header;  // a detached header may end with its last line
}

// Slices of a gzip stream in rising order; the last ones are kept for readers that overlap.
class GzipReader final : public VoxelReader {
 public:
  GzipReader(GzipStream stream, Dims dims, ScalarType type, ByteOrder order)
      : stream_(std::move(stream)), dims_(dims), format_{type, order, {}} {
    constexpr std::int64_t kKeptBytes = 64 << 20;
    kept_most_ = std::max<std::int64_t>(8, kKeptBytes / (dims.slice() * scalar_bytes(type)));
  }

  Dims dims() const noexcept override { return dims_; }
  const NumberFormat& format() const noexcept override { return format_; }
  bool sequential() const noexcept override { return true; }

  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    const Dims size = box.dims();
    const std::int64_t element = scalar_bytes(format_.type);
    for (std::int64_t k = 0; k < size.z; ++k) {
      DUBSAR_ASSIGN(const std::byte* slice, slice_at(box.z.at(k)));
      for (std::int64_t j = 0; j < size.y; ++j)
        copy_row(slice + (box.y.at(j) * dims_.x + box.x.begin) * element, element, box.x,
                 out.data() + (k * size.y + j) * size.x * element);
    }
    return {};
  }

 private:
  Result<const std::byte*> slice_at(std::int64_t z) {
    const auto first_kept = next_ - static_cast<std::int64_t>(kept_.size());
    if (z < first_kept) {
      DUBSAR_TRY(stream_.rewind());
      kept_.clear();
      next_ = 0;
    }
    while (next_ <= z) {
      std::vector<std::byte> slice;
      if (static_cast<std::int64_t>(kept_.size()) >= kept_most_) {
        slice = std::move(kept_.front());
        kept_.pop_front();
      }
      slice.resize(static_cast<std::size_t>(dims_.slice() * scalar_bytes(format_.type)));
      DUBSAR_TRY(stream_.read(slice));
      kept_.push_back(std::move(slice));
      ++next_;
    }
    return kept_[kept_.size() - static_cast<std::size_t>(next_ - z)].data();
  }

  GzipStream stream_;
  Dims dims_;
  NumberFormat format_;
  std::deque<std::vector<std::byte>> kept_;
  std::int64_t kept_most_ = 0;
  std::int64_t next_ = 0;
};

// Directions of the axes `axes` in space; nullopt when the header states none that can be read.
std::optional<std::array<glm::dvec3, 3>> directions_of(const Header& header, const std::array<std::size_t, 3>& axes) {
  const auto texts = words(header.text("space directions"));
  std::array<glm::dvec3, 3> directions{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (axes[i] >= texts.size()) return std::nullopt;
    std::istringstream stream(texts[axes[i]].substr(texts[axes[i]].find('(') + 1));
    int count = 0;
    for (std::string part; std::getline(stream, part, ','); ++count) {
      const auto value = to_number(trimmed(part.substr(0, part.find(')'))));
      if (!value || count >= 3) return std::nullopt;
      directions[i][count] = *value;
    }
    if (count != 3) return std::nullopt;
  }
  return directions;
}

AxisOrder axis_order(const Header& header, const std::array<std::size_t, 3>& axes, std::vector<std::string>& warnings) {
  const std::string space = lower_text(header.text("space"));
  if (!header.text("space directions").empty()) {
    const bool left_handed = space == "las" || space == "last" || space.starts_with("left-anterior-superior") ||
                             space.starts_with("3d-left-handed");
    const auto directions = directions_of(header, axes);
    if (auto order = directions ? axis_order_of(*directions, left_handed) : std::nullopt) {
      order->provenance = "NRRD space directions" + (space.empty() ? "" : " in the space " + space);
      return *order;
    }
    warnings.push_back(fmt::format(
        "the NRRD space directions \"{}\" are not three independent vectors: whether the volume is a mirror "
        "image cannot be told; a given axis order states it",
        header.text("space directions")));
    return {};
  }
  auto labels = words(header.text("labels"));  // fastest first
  std::reverse(labels.begin(), labels.end());
  std::array<std::size_t, 3> used{};
  for (std::size_t i = 0; i < 3 && labels.size() > axes[2]; ++i) used[i] = labels.size() - 1 - axes[2 - i];
  auto order = labels.size() > axes[2] ? parse_axis_labels(labels, used) : std::nullopt;
  if (!order) return {};
  order->provenance = "NRRD labels";
  return *std::move(order);
}

// Lengths of the axes `axes`; provenance empty when the header says nothing that can be used.
VoxelSize voxel_size(const Header& header, const std::array<std::size_t, 3>& axes, std::vector<std::string>& warnings) {
  glm::dvec3 size(0.0), unit(0.0);
  std::string where = "space directions";
  const auto directions = words(header.text("space directions"));
  const auto spacings = words(header.text("spacings"));
  auto units = words(header.text("space units"));
  const bool by_directions = !directions.empty();
  if (!by_directions) {
    where = "spacings";
    units = words(header.text("units"));
  }
  for (int i = 0; i < 3; ++i) {
    const std::size_t axis = axes[static_cast<std::size_t>(i)];
    if (by_directions) {
      if (axis >= directions.size()) return {};
      double squares = 0.0;
      std::string part;
      std::istringstream stream(directions[axis].substr(directions[axis].find('(') + 1));
      while (std::getline(stream, part, ',')) {
        const auto value = to_number(trimmed(part.substr(0, part.find(')'))));
        squares += value ? *value * *value : NAN;
      }
      size[i] = std::sqrt(squares);
    } else {
      if (axis >= spacings.size()) return {};
      size[i] = to_number(spacings[axis]).value_or(NAN);
    }
    // "space units" are those of the space, which a scan's axes follow one to one
    const std::size_t at = by_directions ? static_cast<std::size_t>(i) : axis;
    if (at < units.size()) unit[i] = mm_per_unit(units[at]).value_or(0.0);
  }
  if (!(size.x > 0.0 && size.y > 0.0 && size.z > 0.0) || !std::isfinite(size.x + size.y + size.z)) return {};
  if (unit.x > 0.0 && unit.y > 0.0 && unit.z > 0.0) return {size * unit, "NRRD " + where};
  const std::string space = lower_text(header.text("space"));
  if (space.find("left") != std::string::npos || space.find("right") != std::string::npos ||
      space.starts_with("scanner") || space == "las" || space == "lps" || space == "ras") {
    warnings.push_back(
        fmt::format("the NRRD {} have no unit, millimetres are taken as usual in the space \"{}\"", where, space));
    return {size, fmt::format("NRRD {} (unit taken as mm)", where)};
  }
  warnings.push_back(fmt::format("the NRRD {} have no unit of length and are not used as voxel size", where));
  return {};
}

struct Data {
  InputFile file;
  std::int64_t offset = 0;
};

Result<Data> find_data(const ImportOptions& options, InputFile header_file, const Header& header) {
  const std::string name = header.text("data file", "datafile");
  if (name.empty()) return Data{std::move(header_file), header.end};
  const std::string what = fmt::format("import_nrrd: the data of {}", options.path.string());
  if (name.starts_with("LIST") || name.find('%') != std::string::npos)
    return fail(ErrorKind::kBadData, "{} are spread over several files (\"{}\"), expected one data file", what, name);
  const std::filesystem::path folder = options.path.has_parent_path() ? options.path.parent_path() : ".";
  DUBSAR_ASSIGN(const std::filesystem::path path,
                allowed_file(what, options.path, name, options.allow_external ? *options.allow_external : folder));
  DUBSAR_ASSIGN(InputFile file, InputFile::open(path));
  return Data{std::move(file), 0};
}

}  // namespace

bool is_nrrd(std::string_view head) noexcept { return head.starts_with("NRRD000"); }

Result<OpenedVolume> open_nrrd(const ImportOptions& options) {
  DUBSAR_ASSIGN(InputFile header_file, InputFile::open(options.path));
  DUBSAR_ASSIGN(const Header header, read_header(header_file));
  const std::string path = options.path.string();

  const auto type = parse_scalar_type(header.text("type"));
  if (!type)
    return fail(ErrorKind::kBadData, "import_nrrd: {} has the type \"{}\", expected integers or floats of 8 to 64 bits",
                path, header.text("type"));
  std::vector<std::uint64_t> sizes;
  for (const std::string& word : words(header.text("sizes"))) {
    const auto size = to_number(word);
    if (!size || *size < 0.0 || *size > 1e15 || *size != std::floor(*size) || sizes.size() >= 16)
      return fail(ErrorKind::kBadData, "import_nrrd: {} has the sizes \"{}\", expected whole numbers", path,
                  header.text("sizes"));
    sizes.push_back(static_cast<std::uint64_t>(*size));
  }
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < sizes.size(); ++axis)
    if (sizes.size() == 3 || sizes[axis] != 1) axes.push_back(axis);
  if (axes.size() != 3 || to_number(header.text("dimension")) != static_cast<double>(sizes.size()))
    return fail(ErrorKind::kBadData,
                "import_nrrd: {} has dimension \"{}\" and sizes \"{}\", expected 3 axes of a scalar volume", path,
                header.text("dimension"), header.text("sizes"));
  DUBSAR_ASSIGN(const std::int64_t count, check_dims(fmt::format("import_nrrd: {}", path), sizes,
                                                     static_cast<std::uint64_t>(scalar_bytes(*type)), options.budget));

  OpenedVolume opened;
  VolumeInfo& info = opened.info;
  const auto size_of = [&](std::size_t i) { return static_cast<std::int64_t>(sizes[axes[i]]); };
  info.file_dims = {size_of(0), size_of(1), size_of(2)};
  info.stored.logical_bytes = count * scalar_bytes(*type);
  const std::string endian = lower_text(header.text("endian"));
  if (endian.empty() && scalar_bytes(*type) > 1)
    info.warnings.emplace_back("the NRRD header states no endian, little is taken");
  const ByteOrder order = endian == "big" ? ByteOrder::kBig : ByteOrder::kLittle;

  DUBSAR_ASSIGN(Data data, find_data(options, std::move(header_file), header));
  if (data.file.path() != options.path) opened.files.push_back(data.file.path());
  const std::string encoding = lower_text(header.text("encoding"));
  const double skip = to_number(header.text("byte skip", "byteskip")).value_or(0.0);
  const double lines = to_number(header.text("line skip", "lineskip")).value_or(0.0);
  if (lines != 0.0 || skip < -1.0 || skip > 1e15 || skip != std::floor(skip))
    return fail(ErrorKind::kBadData, "import_nrrd: {} skips {} lines and {} bytes, expected no lines and whole bytes",
                path, lines, skip);
  info.stored.storage_bytes = std::max<std::int64_t>(0, data.file.size() - data.offset);
  if (encoding == "raw") {
    const std::int64_t offset =
        skip < 0.0 ? data.file.size() - info.stored.logical_bytes : data.offset + static_cast<std::int64_t>(skip);
    info.stored.layout = "contiguous";
    std::vector<FlatSegment> segments;
    segments.push_back({std::move(data.file), offset, info.stored.logical_bytes});
    DUBSAR_ASSIGN(opened.reader, make_flat_reader({info.file_dims, {*type, order, {}}, std::move(segments)}));
  } else if ((encoding == "gzip" || encoding == "gz") && skip == 0.0) {
    if (info.stored.logical_bytes > (std::int64_t{64} << 20) &&
        info.stored.logical_bytes / 250 > info.stored.storage_bytes && !options.trust)
      return fail(ErrorKind::kBadData,
                  "import_nrrd: {} unpacks {} bytes to {}, expected at most 250:1; if you know the file, "
                  "say that it is trusted",
                  path, info.stored.storage_bytes, info.stored.logical_bytes);
    info.stored.layout = "stream";
    info.stored.filters = {"gzip"};
    opened.reader =
        std::make_unique<GzipReader>(GzipStream(std::move(data.file), data.offset), info.file_dims, *type, order);
  } else {
    return fail(ErrorKind::kBadData,
                "import_nrrd: {} has the encoding \"{}\", expected raw or gzip; convert it with: unu save -f "
                "nrrd -e gzip",
                path, header.text("encoding"));
  }
  info.format = "nrrd";
  info.found_by = "header";
  info.stored.dtype = scalar_name(*type);
  info.stored.byte_order = order_name(order);
  info.stored.may_have_nonfinite = is_float(*type);
  info.voxel = voxel_size(header, {axes[0], axes[1], axes[2]}, info.warnings);
  info.axes = axis_order(header, {axes[0], axes[1], axes[2]}, info.warnings);
  return opened;
}

}  // namespace dubsar
