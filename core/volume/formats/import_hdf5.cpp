#include "core/volume/formats/import_hdf5.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/hdf5/chunk_filters.h"
#include "core/hdf5/hdf5_filters.h"
#include "core/volume/formats/external_access.h"
#include "core/volume/formats/flat_reader.h"
#include "core/volume/formats/front_reader.h"
#include "core/volume/formats/hdf5_axis_order.h"
#include "core/volume/formats/hdf5_imaris.h"
#include "core/volume/formats/hdf5_no_measurement.h"
#include "core/volume/formats/hdf5_search.h"
#include "core/volume/formats/hdf5_voxel_reader.h"
#include "core/volume/formats/hdf5_voxel_size.h"

namespace dubsar {
namespace {

// Filters outside this table have no name and no package here.
struct FilterName {
  int id;
  const char* name;
  const char* package;  ///< Debian 12; nullptr: there is none
};
constexpr FilterName kFilterNames[] = {
    {1, "deflate", "libhdf5"},
    {2, "shuffle", "libhdf5"},
    {3, "fletcher32", "libhdf5"},
    {4, "szip", "libhdf5"},
    {5, "n-bit", nullptr},
    {6, "scale-offset", nullptr},
    {307, "bzip2", "hdf5-filter-plugin"},
    {32000, "lzf", "hdf5-plugin-lzf"},
    {32001, "blosc", "hdf5-filter-plugin-blosc-serial"},
    {32004, "lz4", "hdf5-filter-plugin"},
    {32008, "bitshuffle", "bitshuffle"},
    {32013, "zfp", "hdf5-filter-plugin-zfp-serial"},
    {32015, "zstd", nullptr},
    {32017, "sz", nullptr},
    {32018, "fcidecomp", nullptr},
    {32019, "jpeg", nullptr},
    {32024, "sz3", nullptr},
    {32026, "blosc2", nullptr},
};

const FilterName* filter_name(int id) {
  for (const FilterName& known : kFilterNames)
    if (known.id == id) return &known;
  return nullptr;
}

std::string filter_text(const Hdf5Filter& filter) {
  if (const FilterName* known = filter_name(filter.id)) return known->name;
  return filter.name.empty() ? "unknown" : filter.name.substr(0, filter.name.find(';'));
}

Result<void> check_filters(const Hdf5DatasetInfo& info) {
  if (decodes_chunks(info, *volume_axes(info.dims))) return {};
  for (const Hdf5Filter& filter : info.filters) {
    const std::string name = filter_text(filter);
    if (filter.id == 5 || filter.id == 6)
      return fail(
          ErrorKind::kBadData,
          "import_hdf5: dataset \"{}\" is stored with filter {} ({}), which is not read because its decoder can be "
          "attacked; rewrite the file with: h5repack -f GZIP=4 IN OUT",
          info.path, filter.id, name);
    if (filter.available) continue;
    const FilterName* known = filter_name(filter.id);
    if (known != nullptr && known->package != nullptr)
      return fail(ErrorKind::kBadData,
                  "import_hdf5: dataset \"{}\" needs filter {} ({}), which is missing; "
                  "apt install {}",
                  info.path, filter.id, name, known->package);
    return fail(
        ErrorKind::kBadData,
        "import_hdf5: dataset \"{}\" needs filter {} ({}), for which there is no Debian package; rewrite the file "
        "where it was made, with gzip compression",
        info.path, filter.id, name);
  }
  return {};
}

Result<void> check_shape(const Hdf5DatasetInfo& info, const Budget& budget) {
  if (!info.scalar)
    return fail(ErrorKind::kBadData,
                "import_hdf5: dataset \"{}\" has the type {}, expected integers or floats of 8 to 64 "
                "bits{}",
                info.path, info.type_text,
                info.type_text == "compound" ? "; write one component to a dataset of its own" : "");
  for (const std::uint64_t n : info.dims)
    if (n == 0)
      return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" is empty ({}), expected voxels", info.path,
                  describe_array(info));
  const auto axes = volume_axes(info.dims);
  if (!axes)
    return fail(ErrorKind::kBadData,
                "import_hdf5: dataset \"{}\" has rank {} ({}), expected 3, or more with axes of "
                "length 1{}",
                info.path, info.dims.size(), describe_array(info),
                info.dims.size() == 2 ? "; for a folder of pictures give the folder of TIFF slices" : "");
  for (const std::size_t axis : *axes)
    if (info.dims[axis] < 2)
      return fail(ErrorKind::kBadData,
                  "import_hdf5: dataset \"{}\" is a single picture ({}), expected at least 2 voxels "
                  "along each axis",
                  info.path, describe_array(info));
  DUBSAR_TRY(
      check_dims(fmt::format("import_hdf5: dataset \"{}\"", info.path), info.dims, info.element_bytes(), budget));
  return {};
}

// What is announced must be there: bombs and half-written files stop here.
Result<void> check_storage(const Hdf5Volume& volume, const ImportOptions& options, std::uint64_t logical) {
  const Hdf5DatasetInfo& info = volume.info;
  if (info.layout == Hdf5Layout::kVirtual || !info.external.empty()) return {};
  if (info.storage_bytes == 0 || (info.layout == Hdf5Layout::kContiguous && info.file_offset < 0))
    return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" announces {}, but nothing was ever written to it",
                info.path, describe_array(info));
  if (info.layout != Hdf5Layout::kChunked) {
    if (info.storage_bytes < logical)
      return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" holds {} bytes, expected {}: the file is damaged",
                  info.path, info.storage_bytes, logical);
    return {};
  }
  std::uint64_t chunk_bytes = info.element_bytes(), chunks = 1;
  constexpr std::uint64_t kMostChunk = std::uint64_t{256} << 20;
  for (std::size_t axis = 0; axis < info.chunk.size(); ++axis) {
    if (info.chunk[axis] == 0 || info.chunk[axis] > kMostChunk || (chunk_bytes *= info.chunk[axis]) > kMostChunk)
      return fail(ErrorKind::kBadData,
                  "import_hdf5: dataset \"{}\" has chunks of {}, expected at most 256 MiB each; "
                  "rewrite it with: h5repack -l CHUNK=64x64x64 IN OUT",
                  info.path, fmt::join(info.chunk, "x"));
    chunks *= (info.dims[axis] + info.chunk[axis] - 1) / info.chunk[axis];
  }
  // Below 64 MiB a bomb does no harm.
  if (logical > (std::uint64_t{64} << 20) && logical / info.storage_bytes > 250 && !options.trust)
    return fail(ErrorKind::kBadData,
                "import_hdf5: dataset \"{}\" unpacks {} bytes to {} ({}:1, expected at most 250:1); if you know the "
                "file, say that it is trusted",
                info.path, info.storage_bytes, logical, logical / info.storage_bytes);
  DUBSAR_ASSIGN(const Hdf5Dataset dataset, volume.file->open_dataset(info.path));
  DUBSAR_ASSIGN(const std::uint64_t written, dataset.written_chunks());
  if (static_cast<double>(written) < 0.99 * static_cast<double>(chunks) && !options.allow_sparse)
    return fail(ErrorKind::kBadData,
                "import_hdf5: dataset \"{}\" is sparse or was not written to its end: {} of {} chunks are missing; "
                "if sparse data are allowed they are read as {}",
                info.path, chunks - std::min(written, chunks), chunks, info.fill.value);
  return {};
}

Result<ScalarMap> scalar_map(const Hdf5Volume& volume) {
  ScalarMap map;
  const auto number = [&](std::initializer_list<const char*> names) -> std::optional<double> {
    for (const char* name : names)
      if (const auto values = volume.file->numbers(volume.info.path, name); values && values->size() == 1)
        return values->front();
    return std::nullopt;
  };
  const auto scale = number({"scale_factor", "scaling_factor", "rescale_slope", "slope"});
  const auto offset = number({"add_offset", "rescale_intercept", "intercept"});
  map.scale = scale.value_or(1.0);
  map.offset = offset ? *offset : scale ? number({"offset"}).value_or(0.0) : 0.0;
  if (!std::isfinite(map.scale) || !std::isfinite(map.offset) || map.scale == 0.0)
    return fail(ErrorKind::kBadData,
                "import_hdf5: dataset \"{}\" has the scale factor {} and offset {}, expected finite "
                "numbers and a factor other than 0",
                volume.info.path, map.scale, map.offset);
  map.none = hdf5_no_measurement(volume, map);
  return map;
}

// Contiguous numbers in this file or in allowed files beside it.
Result<std::vector<FlatSegment>> segments_of(const Hdf5Volume& volume, const ImportOptions& options,
                                             std::int64_t logical) {
  std::vector<FlatSegment> segments;
  if (volume.info.external.empty()) {
    DUBSAR_ASSIGN(InputFile file, InputFile::open(volume.file->path()));
    segments.push_back({std::move(file), volume.info.file_offset, logical});
    return segments;
  }
  for (const Hdf5ExternalPart& part : volume.info.external) {
    DUBSAR_ASSIGN(const std::filesystem::path path,
                  allowed_file(fmt::format("import_hdf5: dataset \"{}\"", volume.info.path), volume.file->path(),
                               part.file, options.allow_external));
    DUBSAR_ASSIGN(InputFile file, InputFile::open(path));
    // The last part may be of unlimited size.
    const std::int64_t bytes = std::min<std::uint64_t>(part.bytes, static_cast<std::uint64_t>(logical));
    if (logical > 0) segments.push_back({std::move(file), part.offset, std::min(bytes, logical)});
    logical -= std::min(bytes, logical);
  }
  return segments;
}

/// netCDF 3 has no unsigned numbers: _Unsigned says that signed ones are meant to be (netCDF User's Guide, appendix A).
void read_as_meant(Hdf5Volume& volume) {
  std::optional<ScalarType>& scalar = volume.info.scalar;
  if (!scalar || !volume.info.plain_scalar) return;
  const auto said = volume.file->string(volume.info.path, "_Unsigned");
  if (!said || (*said != "true" && *said != "True")) return;
  for (const auto& [is, meant] : {std::pair{ScalarType::kI8, ScalarType::kU8},
                                  {ScalarType::kI16, ScalarType::kU16},
                                  {ScalarType::kI32, ScalarType::kU32},
                                  {ScalarType::kI64, ScalarType::kU64}})
    if (*scalar == is) {
      scalar = meant;
      volume.info.type_text = std::string(scalar_name(meant));
      return;
    }
}

/// Files besides the one that was asked for: behind a link, of a virtual dataset, or with its numbers.
std::vector<std::filesystem::path> other_files(const Hdf5Volume& volume, const ImportOptions& options,
                                               std::span<const FlatSegment> segments) {
  std::vector<std::filesystem::path> files;
  if (volume.file->path() != options.path) files.push_back(volume.file->path());
  for (const FlatSegment& segment : segments)
    if (segment.file.path() != volume.file->path()) files.push_back(segment.file.path());
  for (const std::string& name : volume.info.virtual_files)
    if (const auto part = allowed_file("", volume.file->path(), name, options.allow_external); part && name != ".")
      files.push_back(*part);
  return files;
}

std::string layout_text(const Hdf5DatasetInfo& info, const std::array<std::size_t, 3>& axes) {
  switch (info.layout) {
    case Hdf5Layout::kCompact:
      return "compact";
    case Hdf5Layout::kContiguous:
      return info.external.empty() ? "contiguous" : "contiguous in other files";
    case Hdf5Layout::kVirtual:
      return "virtual";
    case Hdf5Layout::kChunked:
      break;
  }
  return fmt::format("chunked {}x{}x{}", info.chunk[axes[0]], info.chunk[axes[1]], info.chunk[axes[2]]);
}

}  // namespace

Result<OpenedVolume> open_hdf5(const ImportOptions& options) {
  DUBSAR_ASSIGN(Hdf5File opened_file, Hdf5File::open(options.path));
  DUBSAR_ASSIGN(Hdf5Volume volume, find_hdf5_volume(std::make_shared<Hdf5File>(std::move(opened_file)), options));
  read_as_meant(volume);
  const Hdf5DatasetInfo& info = volume.info;
  DUBSAR_TRY(check_shape(info, options.budget));
  DUBSAR_TRY(check_filters(info));
  const auto axes = *volume_axes(info.dims);
  OpenedVolume opened;
  opened.info.file_dims = {static_cast<std::int64_t>(info.dims[axes[2]]), static_cast<std::int64_t>(info.dims[axes[1]]),
                           static_cast<std::int64_t>(info.dims[axes[0]])};
  const std::int64_t logical = opened.info.file_dims.count() * static_cast<std::int64_t>(info.element_bytes());
  const bool flat = info.layout == Hdf5Layout::kContiguous && info.plain_scalar;
  if (!info.external.empty() && !flat)
    return fail(ErrorKind::kBadData,
                "import_hdf5: dataset \"{}\" keeps odd numbers in other files, expected plain ones", info.path);
  std::vector<FlatSegment> segments;
  if (flat && (!info.external.empty() || info.file_offset >= 0)) {
    DUBSAR_ASSIGN(segments, segments_of(volume, options, logical));
  }
  DUBSAR_TRY(check_storage(volume, options, static_cast<std::uint64_t>(logical)));
  opened.files = other_files(volume, options, segments);
  DUBSAR_ASSIGN(opened.info.map, scalar_map(volume));
  if (flat) {
    DUBSAR_ASSIGN(
        opened.reader,
        make_flat_reader({opened.info.file_dims, {*info.scalar, info.order, opened.info.map}, std::move(segments)}));
  } else {
    DUBSAR_ASSIGN(opened.reader, make_hdf5_reader(volume.file, info, axes, opened.info.map));
  }
  if (const auto front = imaris_dims(volume, opened.info.file_dims)) {
    opened.reader = make_front_reader(std::move(opened.reader), *front);
    opened.info.file_dims = *front;
  }
  opened.info.format = "hdf5";
  opened.info.dataset = volume.named;
  opened.info.found_by = volume.found_by;
  opened.info.stored.dtype = info.type_text;
  opened.info.stored.byte_order = order_name(info.order);
  opened.info.stored.layout = layout_text(info, axes);
  for (const Hdf5Filter& filter : info.filters) opened.info.stored.filters.push_back(filter_text(filter));
  opened.info.stored.storage_bytes = static_cast<std::int64_t>(info.storage_bytes);
  opened.info.stored.logical_bytes = logical;
  opened.info.candidates = volume.others;
  opened.info.stored.may_have_nonfinite = can_be_nonfinite(*info.scalar, opened.info.map);
  const StatedVoxelSize stated = hdf5_voxel_size(volume, opened.info.warnings);
  opened.info.voxel = stated.size;
  opened.voxel_by_name = stated.by_name;
  opened.info.axes = hdf5_axis_order(volume, opened.info.warnings);
  return opened;
}

std::vector<Hdf5FilterState> hdf5_filter_states() {
  std::vector<Hdf5FilterState> states;
  for (const FilterName& known : kFilterNames)
    if (known.package != nullptr)
      states.push_back({known.name, can_undo_filter(known.id) || hdf5_filter_available(known.id),
                        fmt::format("apt install {}", known.package)});
  return states;
}

}  // namespace dubsar
