#include "core/volume/formats/import_tiff.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/base/files/file_suffix.h"
#include "core/base/system/parallel.h"
#include "core/image_io/tiff_file.h"
#include "core/volume/formats/flat_reader.h"
#include "core/volume/formats/slice_names.h"
#include "core/volume/formats/tiff_description.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

struct Slice {
  fs::path file;
  std::uint64_t page = 0;
};

std::optional<ScalarType> type_of(const TiffPage& page) {
  const char* const kind = page.sample == TiffPage::Sample::kUnsigned ? "uint"
                           : page.sample == TiffPage::Sample::kSigned ? "int"
                                                                      : "float";
  if (page.sample == TiffPage::Sample::kOther || page.bits % 8 != 0) return std::nullopt;
  return parse_scalar_type(fmt::format("{}{}", kind, page.bits));
}

class SliceReader final : public VoxelReader {
 public:
  SliceReader(std::vector<Slice> slices, TiffPage like)
      : slices_(std::move(slices)), like_(std::move(like)), format_{*type_of(like_), kNativeOrder, {}} {}

  Dims dims() const noexcept override { return {like_.width, like_.height, static_cast<std::int64_t>(slices_.size())}; }
  const NumberFormat& format() const noexcept override { return format_; }

  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    const Dims size = box.dims();
    const std::int64_t element = scalar_bytes(format_.type);
    std::mutex mutex;
    Result<void> result;
    const std::int64_t grain = std::max<std::int64_t>(4, (1 << 18) / (like_.width * like_.height));
    parallel_chunks(size.z, grain, [&](std::int64_t begin, std::int64_t end) {
      std::optional<TiffFile> file;
      fs::path open_path;
      std::vector<std::byte> page(static_cast<std::size_t>(like_.width * like_.height * element));
      for (std::int64_t k = begin; k < end; ++k) {
        const Slice& slice = slices_[static_cast<std::size_t>(box.z.at(k))];
        auto loaded = load(slice, file, open_path, page);
        if (!loaded) {
          const std::lock_guard lock(mutex);
          result = std::move(loaded);
          return;
        }
        for (std::int64_t j = 0; j < size.y; ++j)
          copy_row(page.data() + (box.y.at(j) * like_.width + box.x.begin) * element, element, box.x,
                   out.data() + (k * size.y + j) * size.x * element);
      }
    });
    return result;
  }

 private:
  Result<void> load(const Slice& slice, std::optional<TiffFile>& file, fs::path& open_path,
                    std::span<std::byte> page) const {
    if (!file || open_path != slice.file) {
      file.reset();
      DUBSAR_ASSIGN(TiffFile opened, TiffFile::open(slice.file));
      file.emplace(std::move(opened));
      open_path = slice.file;
    }
    DUBSAR_ASSIGN(const TiffPage found, file->select(slice.page));
    if (found.width != like_.width || found.height != like_.height || found.bits != like_.bits ||
        found.channels != like_.channels || found.sample != like_.sample)
      return fail(ErrorKind::kBadData,
                  "import_tiff: {} changed since it was opened, expected {} x {} pixels of {} bits",
                  slice.file.string(), like_.width, like_.height, like_.bits);
    return file->read_gray(page);
  }

  std::vector<Slice> slices_;
  TiffPage like_;
  NumberFormat format_;
};

VoxelSize voxel_size(const TiffPage& page, const TiffDescription& said, std::vector<std::string>& warnings) {
  if (said.spacing < 0.0)
    warnings.push_back(fmt::format(
        "the {} spacing is negative: the slices may be stored last first, and the volume then is a mirror image; "
        "a given axis order states it (-zyx: the slices run backwards)",
        said.said_by));
  if (said.voxel_mm.x > 0.0 && said.voxel_mm.y > 0.0) {
    VoxelSize size{said.voxel_mm, said.said_by + " PhysicalSize"};
    if (!(size.mm.z > 0.0)) {
      size.mm.z = size.mm.x;
      warnings.push_back(fmt::format("the {} states no PhysicalSizeZ, that of the pixels in x is taken", said.said_by));
    }
    return size;
  }
  const double unit_mm = said.unit_mm ? *said.unit_mm : page.resolution.unit_mm;
  const double between = said.unit_mm ? std::abs(said.spacing) * unit_mm : 0.0;
  if (page.resolution.x_per_unit <= 0.0 || page.resolution.y_per_unit <= 0.0 || unit_mm <= 0.0) {
    if (between <= 0.0) return {};
    warnings.push_back(fmt::format(
        "the {} description states the distance of the slices only, pixels are taken as wide", said.said_by));
    return {glm::dvec3(between), fmt::format("{} spacing (x and y taken like z)", said.said_by)};
  }
  const glm::dvec3 mm(unit_mm / page.resolution.x_per_unit, unit_mm / page.resolution.y_per_unit, 0.0);
  if (!std::isfinite(mm.x + mm.y)) return {};
  if (between > 0.0) return {{mm.x, mm.y, between}, fmt::format("TIFF resolution tags and {} spacing", said.said_by)};
  for (const double default_dpi : {72.0, 96.0, 100.0, 150.0, 300.0, 600.0})
    if (!said.unit_mm && std::abs(25.4 / mm.x - default_dpi) < 0.01) {
      warnings.push_back(
          fmt::format("the TIFF resolution of {} dpi is a habit of picture programs and is not used as voxel "
                      "size",
                      default_dpi));
      return {};
    }
  warnings.emplace_back("the TIFF files state no slice distance, that of the pixels in x is taken");
  return {{mm.x, mm.y, mm.x}, "TIFF resolution tags (z taken like x)"};
}

/// Where rows and columns of the pixels begin (tag 274), as an order of axes.
AxisOrder axes_of(int orientation) {
  AxisOrder axes;
  if (orientation <= 1 || orientation > 8) return axes;
  const bool turned = orientation >= 5;  // rows of pixels are columns of the picture
  if (turned) axes.stored = {1, 0, 2};
  const bool right = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool bottom = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  axes.backwards = {right, bottom, false};
  axes.provenance = fmt::format("TIFF orientation {}", orientation);
  return axes;
}

/// Of a file that is called a slice and is none: left out it would bring what lies beyond it nearer.
Result<void> refuse_slice(const fs::path& path) {
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(path));
  const std::string what =
      file.size() == 0 ? std::string("is empty") : fmt::format("({} bytes) is no TIFF file", file.size());
  return fail(
      ErrorKind::kBadData,
      "import_tiff: {} {}, expected a slice of the volume; copy it again from where it was made, or take it out "
      "of the folder",
      path.string(), what);
}

Result<SliceSeries> files_of(const ImportOptions& options) {
  std::error_code error;
  const bool folder = fs::is_directory(options.path, error);
  const fs::path parent = folder ? options.path : options.path.has_parent_path() ? options.path.parent_path() : ".";
  const std::string pattern = folder ? "*" : options.path.filename().string();
  std::vector<fs::path> files;
  fs::directory_iterator entries(parent, error);
  if (error) return fail_errno(error.value(), fmt::format("cannot list {}", parent.string()));
  for (const auto& entry : entries) {
    const std::string name = entry.path().filename().string();
    std::error_code ignored;
    if (name.front() == '.' || ::fnmatch(pattern.c_str(), name.c_str(), 0) != 0 || !entry.is_regular_file(ignored))
      continue;
    if (TiffFile::has_signature(entry.path()))
      files.push_back(entry.path());
    else if (const std::string suffix = lower_suffix(name); suffix == ".tif" || suffix == ".tiff")
      DUBSAR_TRY(refuse_slice(entry.path()));
  }
  if (files.empty())
    return fail(folder ? ErrorKind::kBadData : ErrorKind::kNoInput,
                "import_tiff: {} holds no TIFF files{}, expected the "
                "slices of a volume",
                parent.string(), folder ? "" : fmt::format(" called {}", pattern));
  return order_slices(std::move(files), options.path.string());
}

Result<void> check_page(const fs::path& file, const TiffPage& page) {
  if (page.channels != 1 || page.palette)
    return fail(ErrorKind::kBadData,
                "import_tiff: {} is a colour picture ({} channels), expected gray values of one channel", file.string(),
                page.palette ? 3 : page.channels);
  if (!type_of(page))
    return fail(ErrorKind::kBadData,
                "import_tiff: {} has samples of {} bits, expected whole numbers or floats of 8, 16, 32 or "
                "64 bits",
                file.string(), page.bits);
  return {};
}

}  // namespace

bool is_slice_pattern(const std::filesystem::path& path) {
  return path.filename().string().find_first_of("*?") != std::string::npos;
}

Result<OpenedVolume> open_tiff_stack(const ImportOptions& options) {
  std::error_code ignored;
  SliceSeries series{{options.path}, {}};
  if (!fs::is_regular_file(options.path, ignored)) {
    DUBSAR_ASSIGN(series, files_of(options));
  }
  const std::vector<fs::path>& files = series.files;
  std::vector<Slice> slices;
  std::optional<TiffPage> first;
  TiffDescription said;
  for (const fs::path& path : files) {
    DUBSAR_ASSIGN(TiffFile file, TiffFile::open(path));
    DUBSAR_ASSIGN(const std::vector<TiffPage> pages, file.pages());
    for (const TiffPage& page : pages) {
      if (page.reduced) continue;
      DUBSAR_TRY(check_page(path, page));
      if (!first) {
        first = page;
        said = parse_tiff_description(page.texts.description);
        if (said.several)
          return fail(
              ErrorKind::kBadData,
              "import_tiff: {} holds several channels or time points ({}), expected one volume; save the one that "
              "is wanted as a file of its own",
              options.path.string(), said.several_of);
      }
      if (&page != &pages.front() && page.texts.description.starts_with("{\"shape\"") &&
          parse_tiff_description(page.texts.description).images > 1)
        return fail(ErrorKind::kBadData, "import_tiff: {} holds several series of pictures, expected one volume",
                    path.string());
      if (page.data.depth > 1 && (files.size() > 1 || pages.size() > 1 || page.data.offset < 0))
        return fail(ErrorKind::kBadData,
                    "import_tiff: {} holds {} slices in one page (ImageDepth, tag 32997), and these packed, in tiles "
                    "or beside other pages; expected a page a slice, save it so",
                    path.string(), page.data.depth);
      // Some programs state it in the first page alone.
      const int oriented = page.orientation > 0 ? page.orientation : std::max(1, pages.front().orientation);
      if (oriented != std::max(1, first->orientation))
        return fail(ErrorKind::kBadData,
                    "import_tiff: {} has the orientation {} (tag 274), but the slices before it {}; expected one",
                    path.string(), oriented, std::max(1, first->orientation));
      if (page.width != first->width || page.height != first->height || type_of(page) != type_of(*first))
        return fail(
            ErrorKind::kBadData,
            "import_tiff: {} has {} x {} pixels of {}, but the slices before it {} x {} of {}: expected slices of one "
            "size; name them with a pattern such as slice_*.tif",
            path.string(), page.width, page.height, scalar_name(*type_of(page)), first->width, first->height,
            scalar_name(*type_of(*first)));
      slices.push_back({path, page.offset});
    }
  }
  if (!first) return fail(ErrorKind::kBadData, "import_tiff: {} holds thumbnails only", options.path.string());
  const ScalarType type = *type_of(*first);
  // ImageJ above 4 GiB and tifffile where it was told to write one page and the rest of the slices behind it; pages
  // that are deep themselves.
  const std::int64_t behind =
      slices.size() == 1 && first->data.offset >= 0 ? std::max(said.images, first->data.depth) : 1;
  const std::int64_t depth = std::max(behind, static_cast<std::int64_t>(slices.size()));
  if (depth < 2)
    return fail(ErrorKind::kBadData,
                "import_tiff: {} is a single picture, expected a stack; give the folder of the slices or "
                "a pattern such as slice_*.tif",
                options.path.string());
  OpenedVolume opened;
  VolumeInfo& info = opened.info;
  info.file_dims = {first->width, first->height, depth};
  const std::array<std::uint64_t, 3> dims{static_cast<std::uint64_t>(depth), static_cast<std::uint64_t>(first->height),
                                          static_cast<std::uint64_t>(first->width)};
  DUBSAR_ASSIGN(const std::int64_t count, check_dims("import_tiff: the stack", dims,
                                                     static_cast<std::uint64_t>(scalar_bytes(type)), options.budget));
  info.stored.logical_bytes = count * scalar_bytes(type);
  for (const fs::path& path : files)
    info.stored.storage_bytes += static_cast<std::int64_t>(fs::file_size(path, ignored));
  if (info.stored.logical_bytes > (std::int64_t{64} << 20) &&
      info.stored.logical_bytes / 250 > info.stored.storage_bytes && !options.trust)
    return fail(ErrorKind::kBadData,
                "import_tiff: {} unpacks {} bytes to {}, expected at most 250:1; if you know the files, "
                "say that they are trusted",
                options.path.string(), info.stored.storage_bytes, info.stored.logical_bytes);
  if (files.size() > 1 || files.front() != options.path) opened.files = files;
  info.format = "tiff";
  info.found_by = files.size() > 1 ? fmt::format("{} files", files.size()) : "pages of one file";
  info.stored.dtype = scalar_name(type);
  info.stored.byte_order = order_name(first->big_endian ? ByteOrder::kBig : ByteOrder::kLittle);
  info.stored.layout = "slices";
  if (first->compression != "none") info.stored.filters = {first->compression};
  info.stored.may_have_nonfinite = is_float(type);
  info.warnings = std::move(series.warnings);
  if (said.slices > 1 && said.slices != depth)
    info.warnings.push_back(
        fmt::format("the {} description says {} slices, {} are here", said.said_by, said.slices, depth));
  info.voxel = voxel_size(*first, said, info.warnings);
  info.axes = axes_of(first->orientation);
  if (behind > 1) {
    DUBSAR_ASSIGN(InputFile file, InputFile::open(files.front()));
    std::vector<FlatSegment> segments;
    segments.push_back({std::move(file), first->data.offset, info.stored.logical_bytes});
    const ByteOrder order = first->big_endian ? ByteOrder::kBig : ByteOrder::kLittle;
    ScalarMap map;  // as read_gray() does
    if (first->white_is_zero && first->sample == TiffPage::Sample::kUnsigned)
      map = {-1.0, std::ldexp(1.0, first->bits) - 1.0, {}};
    DUBSAR_ASSIGN(opened.reader, make_flat_reader({info.file_dims, {type, order, map}, std::move(segments)}));
  } else {
    opened.reader = std::make_unique<SliceReader>(std::move(slices), *first);
  }
  return opened;
}

}  // namespace dubsar
