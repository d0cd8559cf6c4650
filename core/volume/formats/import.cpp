#include "core/volume/formats/import.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/base/files/file_fingerprint.h"
#include "core/base/files/input_file.h"
#include "core/base/system/log.h"
#include "core/hdf5/hdf5_file.h"
#include "core/image_io/tiff_file.h"
#include "core/volume/formats/import_hdf5.h"
#include "core/volume/formats/import_nrrd.h"
#include "core/volume/formats/import_raw.h"
#include "core/volume/formats/import_tiff.h"
#include "core/volume/grid_source.h"
#include "core/volume/oriented_reader.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

// FILE:/dataset, when FILE exists and the whole name does not.
void split_dataset(ImportOptions& options) {
  const std::string text = options.path.string();
  const auto colon = text.rfind(":/");
  std::error_code ignored;
  if (colon == std::string::npos || !options.dataset.empty() || fs::exists(options.path, ignored) ||
      !fs::exists(text.substr(0, colon), ignored))
    return;
  options.dataset = text.substr(colon + 1);
  options.path = text.substr(0, colon);
}

struct Magic {
  std::size_t offset;
  std::string_view bytes;
  const char* what;
};
constexpr Magic kOthers[] = {
    {0, "\x89PNG", "a PNG picture"},
    {0, "\xff\xd8\xff", "a JPEG picture"},
    {0, "\x1f\x8b", "a gzip archive"},
    {0, "PK\x03\x04", "a zip archive"},
    {128, "DICM", "a DICOM slice"},
    {344, "n+1", "a NIfTI volume"},
    {0, "\x93NUMPY", "a NumPy array"},
    {0, "CDF", "a netCDF 3 file"},
    {0, "MATLAB 5.0", "a MATLAB 5 file"},
    {0, "# vtk", "a legacy VTK file"},
    {0, "ply", "a PLY mesh"},
    {0, "solid ", "an STL mesh"},
    {0, "glTF", "a GLB mesh"},
};

Result<OpenedVolume> open_by_content(const ImportOptions& options) {
  if (options.raw) return open_raw(options);
  std::error_code ignored;
  const bool folder = fs::is_directory(options.path, ignored);
  if (folder || (is_slice_pattern(options.path) && !fs::exists(options.path, ignored))) return open_tiff_stack(options);
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(options.path));
  if (file.size() == 0)
    return fail(ErrorKind::kBadData, "import: {} is empty, expected a volume", options.path.string());
  std::array<char, 512> head{};
  const auto bytes = static_cast<std::size_t>(std::min<std::int64_t>(file.size(), head.size()));
  DUBSAR_TRY(file.read_at(0, std::as_writable_bytes(std::span(head)).first(bytes)));
  const std::string_view text(head.data(), bytes);
  if (is_nrrd(text)) return open_nrrd(options);
  if (TiffFile::has_signature(options.path)) return open_tiff_stack(options);
  if (Hdf5File::has_signature(file)) return open_hdf5(options);
  std::string found = "no known format";
  for (const Magic& magic : kOthers)
    if (text.size() >= magic.offset + magic.bytes.size() &&
        text.substr(magic.offset, magic.bytes.size()) == magic.bytes)
      found = magic.what;
  return fail(
      ErrorKind::kBadData,
      "import: {} is {}, expected an HDF5, NRRD or TIFF volume or a folder of TIFF slices; for a raw volume give "
      "its size and number type",
      options.path.string(), found);
}

Result<VoxelBox> box_of(const Dims& file, const ImportOptions& options) {
  const std::array<std::int64_t, 3> sizes{file.x, file.y, file.z};
  std::array<AxisRange, 3> ranges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AxisRange& range = ranges[axis];
    range = {0, sizes[axis], options.stride[axis]};
    if (options.crop) {
      range.begin = options.crop->begin[axis];
      if (options.crop->end[axis] >= 0) range.end = options.crop->end[axis];
    }
    if (range.begin < 0 || range.begin >= range.end || range.end > sizes[axis])
      return fail(ErrorKind::kUsage, "import: crop {}:{} along {} found, expected a part of 0:{}", range.begin,
                  range.end, "xyz"[axis], sizes[axis]);
    if (range.step < 1 || range.count() < 2)
      return fail(ErrorKind::kUsage, "import: crop {}:{} with stride {} leaves {} voxels along {}, expected at least 2",
                  range.begin, range.end, range.step, range.count(), "xyz"[axis]);
  }
  return VoxelBox{ranges[0], ranges[1], ranges[2]};
}

/// From the stored axes to x, y, z of the object.
void turn(OpenedVolume& opened, const ImportOptions& options) {
  VolumeInfo& info = opened.info;
  if (options.axis_order) {
    info.axes = *options.axis_order;
    info.axes.provenance = "given by the user";
  }
  if (info.axes.usual()) return;
  const auto dims = by_axis(info.axes, std::array{info.file_dims.x, info.file_dims.y, info.file_dims.z});
  info.file_dims = {dims[0], dims[1], dims[2]};
  if (!opened.voxel_by_name) info.voxel.mm = by_axis(info.axes, info.voxel.mm);
  opened.reader = std::make_unique<OrientedReader>(std::move(opened.reader), info.axes, options.budget.kept_bytes());
}

void check_voxel_size(VolumeInfo& info) {
  const glm::dvec3 mm = info.voxel.mm;
  if (!info.voxel.known()) {
    info.warnings.emplace_back("voxel size unknown: 1 voxel is taken as 1 mm; give the voxel size");
    return;
  }
  // What micro-CT and CT scanners deliver; beyond it the unit is usually wrong by a factor of 1000.
  constexpr double kLeast = 0.0005, kMost = 1.0;
  const auto [least, most] = std::minmax({mm.x, mm.y, mm.z});
  if (least < kLeast || most > kMost)
    info.warnings.push_back(
        fmt::format("voxel size {:g} x {:g} x {:g} mm ({}) found, expected 0.0005 to 1 mm: is the unit "
                    "right? a given voxel size overrides it",
                    mm.x, mm.y, mm.z, info.voxel.provenance));
}

}  // namespace

Result<OpenedVoxels> open_voxels(ImportOptions options) {
  split_dataset(options);
  if (options.same_files && !options.same_files->empty()) DUBSAR_TRY(check_unchanged(*options.same_files));
  DUBSAR_ASSIGN(OpenedVolume opened, open_by_content(options));
  VolumeInfo& info = opened.info;
  if (options.same_files && options.same_files->empty()) {
    std::error_code ignored;
    if (fs::is_regular_file(options.path, ignored)) opened.files.push_back(options.path);
    DUBSAR_ASSIGN(*options.same_files, identify_files(opened.files));
  }
  info.path = options.path.string();
  if (const auto found = file_fingerprint(options.path)) info.fingerprint = *found;  // of a folder there is none
  turn(opened, options);
  if (options.voxel_size_mm) info.voxel = {*options.voxel_size_mm, "given by the user"};
  return OpenedVoxels{std::move(info), std::move(opened.reader)};
}

Result<std::unique_ptr<ImportedVolume>> open_volume(ImportOptions options) {
  DUBSAR_ASSIGN(OpenedVoxels opened, open_voxels(options));
  VolumeInfo& info = opened.info;
  DUBSAR_ASSIGN(info.box, box_of(info.file_dims, options));
  check_voxel_size(info);
  for (const std::string& warning : info.warnings) log_warning("{}: {}", info.path, warning);
  auto grid = std::make_unique<GridSource>(std::move(opened.reader), info.box, info.voxel, options.budget);
  auto measured = std::make_unique<MeasuredSource>(
      std::move(grid), MeasuredSource::Options{options.ignored, std::move(options.unmeasured), options.unmeasured_fill,
                                               info.stored.may_have_nonfinite});
  return std::make_unique<ImportedVolume>(std::move(info), std::move(measured));
}

}  // namespace dubsar
