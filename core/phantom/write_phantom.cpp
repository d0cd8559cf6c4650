#include "core/phantom/write_phantom.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/hdf5/hdf5_writer.h"
#include "core/phantom/density.h"
#include "core/phantom/phantom_source.h"
#include "core/phantom/rasterise.h"
#include "core/phantom/scan_file.h"

namespace dubsar::phantom {
namespace {

constexpr std::int64_t kSlab = 16;

std::vector<std::uint64_t> shape(const Dims& d) {
  return {static_cast<std::uint64_t>(d.z), static_cast<std::uint64_t>(d.y), static_cast<std::uint64_t>(d.x)};
}

/// What made the file, on its root group, and the voxel size on `data` in the forms that other programs look for.
Result<void> describe(Hdf5Writer& file, const Phantom& phantom, const std::string& data) {
  const PhantomOptions& o = phantom.options();
  DUBSAR_TRY(file.set_attribute("/", "creator", "dubsar phantom"));
  DUBSAR_TRY(file.set_attribute("/", "seed", static_cast<std::int64_t>(o.seed)));
  if (!o.scanner) {
    DUBSAR_TRY(file.set_attribute("/", "snr_db", o.snr_db));
    DUBSAR_TRY(file.set_attribute("/", "blur_vox", o.blur_vox));
  }
  DUBSAR_TRY(file.set_attribute("/", "glued_fraction", phantom.glued_fraction()));
  const std::vector<double> element_um(3, o.voxel_mm * 1000.0);
  return file.set_attribute(data, "element_size_um", std::span<const double>(element_um));
}

Result<void> write_axes(Hdf5Writer& file, const PhantomOptions& o) {
  const std::vector<std::string> names{"z", "y", "x"};
  const std::array<std::int64_t, 3> counts{o.dims.z, o.dims.y, o.dims.x};
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<double> axis(static_cast<std::size_t>(counts[a]));
    for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = static_cast<double>(i) * o.voxel_mm;
    const std::string path = "/entry/data/" + names[a];
    DUBSAR_TRY(file.write<double>(path, {.type = ScalarType::kF64, .dims = {axis.size()}, .chunk = {}}, axis));
    DUBSAR_TRY(file.set_attribute(path, "units", "mm"));
  }
  DUBSAR_TRY(file.set_attribute("/entry", "NX_class", "NXentry"));
  DUBSAR_TRY(file.set_attribute("/entry", "default", "data"));
  DUBSAR_TRY(file.set_attribute("/entry/data", "NX_class", "NXdata"));
  DUBSAR_TRY(file.set_attribute("/entry/data", "signal", "data"));
  DUBSAR_TRY(file.set_attribute("/entry/data", "axes", std::span<const std::string>(names)));
  return file.set_attribute("/", "default", "entry");
}

Result<void> write_scan(const std::filesystem::path& path, const std::shared_ptr<const Phantom>& phantom,
                        Progress& progress) {
  const Dims d = phantom->options().dims;
  PhantomSource source(phantom);
  DUBSAR_ASSIGN(Hdf5Writer file, Hdf5Writer::create(path));
  const std::string data = "/entry/data/data";
  DUBSAR_TRY(file.create_dataset(data, {.type = ScalarType::kF32, .dims = shape(d), .chunk = {}}));
  DUBSAR_TRY(describe(file, *phantom, data));
  DUBSAR_TRY(write_axes(file, phantom->options()));
  progress.begin("phantom", d.count(), "voxel");
  std::vector<float> slab;
  for (std::int64_t z = 0; z < d.z; z += kSlab) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t slices = std::min(kSlab, d.z - z);
    slab.resize(static_cast<std::size_t>(slices * d.slice()));
    DUBSAR_TRY(source.read(z, z + slices, slab));
    DUBSAR_TRY(file.write_slab<float>(data, static_cast<std::uint64_t>(z), slab));
    progress.advance(slices * d.slice());
  }
  progress.end();
  return file.commit();
}

template <class T>
Result<void> write_stored(Hdf5Writer& file, const std::string& data, const ScannedVolume& scan,
                          const StoredScan& stored, const FileOptions& options, Progress& progress) {
  const Dims d = scan.per_mm.dims;
  progress.begin("phantom", d.count(), "voxel");
  for (std::int64_t z = 0; z < d.z; z += kSlab) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t slices = std::min(kSlab, d.z - z);
    DUBSAR_TRY(
        file.write_slab<T>(data, static_cast<std::uint64_t>(z), store_slices<T>(scan, stored, options, z, z + slices)));
    progress.advance(slices * d.slice());
  }
  progress.end();
  return {};
}

Result<ScannerReport> write_scanned(const std::filesystem::path& path, const Phantom& phantom, Progress& progress) {
  const PhantomOptions& o = phantom.options();
  DUBSAR_ASSIGN(Hdf5Writer file, Hdf5Writer::create(path));  // before the work: a place that cannot be written says so
  DensitySource object(phantom);
  DUBSAR_ASSIGN(const ScannedVolume scan, scan_object(object, o.voxel_mm, *o.scanner, o.seed, progress));
  const FileOptions& how = o.scanner->file;
  const StoredScan stored = stored_scan(scan, how);
  const std::string data = "/entry/data/data";
  DUBSAR_TRY(file.create_dataset(data, {.type = stored.type, .dims = shape(o.dims), .chunk = {}}));
  DUBSAR_TRY(describe(file, phantom, data));
  DUBSAR_TRY(write_axes(file, o));
  DUBSAR_TRY(file.set_attribute("/", "scanner", o.scanner->text));
  if (how.type == ScanFile::kUint16) {
    DUBSAR_TRY(file.set_attribute(data, "scale_factor", stored.map.scale));
    DUBSAR_TRY(file.set_attribute(data, "add_offset", stored.map.offset));
  }
  DUBSAR_TRY(file.set_attribute(data, "units", how.type == ScanFile::kHu ? "HU" : "1/mm"));
  Result<void> written;
  if (stored.type == ScalarType::kU16)
    written = write_stored<std::uint16_t>(file, data, scan, stored, how, progress);
  else if (stored.type == ScalarType::kI16)
    written = write_stored<std::int16_t>(file, data, scan, stored, how, progress);
  else
    written = write_stored<float>(file, data, scan, stored, how, progress);
  DUBSAR_TRY(written);
  DUBSAR_TRY(file.commit());
  return ScannerReport{scan.geometry, scan.longest_mm, scan.least_light, scan.stray_light, scan.clay_per_mm};
}

Result<void> write_wedges(Hdf5Writer& file, const Phantom& phantom) {
  const std::vector<std::string> columns{"x",       "y",       "z",      "out_x", "out_y",  "out_z",
                                         "tail_x",  "tail_y",  "tail_z", "depth", "length", "head_half_width",
                                         "side",    "owner",   "sign",   "open",  "case",   "head_x",
                                         "head_y",  "head_z",  "end_x",  "end_y", "end_z",  "right_x",
                                         "right_y", "right_z", "kind",   "line",  "air"};
  std::vector<double> rows;
  for (const Wedge& w : phantom.wedges())
    rows.insert(rows.end(), {w.position.x,
                             w.position.y,
                             w.position.z,
                             w.outward.x,
                             w.outward.y,
                             w.outward.z,
                             w.tail.x,
                             w.tail.y,
                             w.tail.z,
                             w.depth,
                             w.length,
                             w.head_half_width,
                             static_cast<double>(w.side),
                             static_cast<double>(w.owner),
                             static_cast<double>(w.sign),
                             w.open ? 1.0 : 0.0,
                             static_cast<double>(w.state),
                             w.place.head.x,
                             w.place.head.y,
                             w.place.head.z,
                             w.place.end.x,
                             w.place.end.y,
                             w.place.end.z,
                             w.place.right.x,
                             w.place.right.y,
                             w.place.right.z,
                             static_cast<double>(w.kind),
                             static_cast<double>(w.line),
                             w.has_air() ? 1.0 : 0.0});
  return file.write_table("/truth/wedges", columns, rows);
}

Result<void> write_truth(const std::filesystem::path& path, const Phantom& phantom, Progress& progress) {
  const Dims d = phantom.options().dims;
  DUBSAR_ASSIGN(Hdf5Writer file, Hdf5Writer::create(path));
  // Chunks of one slab in z and about 64 KB: both arrays are mostly constant and shrink to a few percent.
  const std::vector<std::uint64_t> chunk{static_cast<std::uint64_t>(std::min(kSlab, d.z)),
                                         static_cast<std::uint64_t>(std::min<std::int64_t>(64, d.y)),
                                         static_cast<std::uint64_t>(std::min<std::int64_t>(64, d.x))};
  const std::string label_path = "/truth/label", distance_path = "/truth/distance", interface_path = "/truth/interface";
  DUBSAR_TRY(
      file.create_dataset(label_path, {.type = ScalarType::kU8, .dims = shape(d), .chunk = chunk, .deflate = 1}));
  DUBSAR_TRY(file.create_dataset(
      distance_path, {.type = ScalarType::kI16, .dims = shape(d), .chunk = chunk, .deflate = 1, .shuffle = true}));
  DUBSAR_TRY(file.create_dataset(
      interface_path, {.type = ScalarType::kI16, .dims = shape(d), .chunk = chunk, .deflate = 1, .shuffle = true}));
  DUBSAR_TRY(describe(file, phantom, label_path));
  const std::vector<std::string> names{"outside", "tablet", "envelope", "gap", "pore", "organic", "glue"};
  DUBSAR_TRY(file.set_attribute(label_path, "names", std::span<const std::string>(names)));
  DUBSAR_TRY(file.set_attribute(distance_path, "scale_voxel", 1.0 / kDistanceSteps));
  DUBSAR_TRY(file.set_attribute(distance_path, "reach_voxel", Phantom::kReach));
  DUBSAR_TRY(file.set_attribute(interface_path, "scale_voxel", 1.0 / kDistanceSteps));
  DUBSAR_TRY(file.set_attribute(interface_path, "reach_voxel", Phantom::kReach));
  DUBSAR_TRY(write_wedges(file, phantom));
  progress.begin("truth", d.count(), "voxel");
  std::vector<std::uint8_t> label;
  std::vector<std::int16_t> distance, interface;
  for (std::int64_t z = 0; z < d.z; z += kSlab) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t slices = std::min(kSlab, d.z - z);
    label.resize(static_cast<std::size_t>(slices * d.slice()));
    distance.resize(label.size());
    interface.resize(label.size());
    rasterise_truth(phantom, z, z + slices, label, distance);
    rasterise_interface(phantom, z, z + slices, interface);
    DUBSAR_TRY(file.write_slab<std::int16_t>(interface_path, static_cast<std::uint64_t>(z), interface));
    DUBSAR_TRY(file.write_slab<std::uint8_t>(label_path, static_cast<std::uint64_t>(z), label));
    DUBSAR_TRY(file.write_slab<std::int16_t>(distance_path, static_cast<std::uint64_t>(z), distance));
    progress.advance(slices * d.slice());
  }
  progress.end();
  return file.commit();
}

}  // namespace

void rasterise_truth(const Phantom& phantom, std::int64_t z_begin, std::int64_t z_end, std::span<std::uint8_t> label,
                     std::span<std::int16_t> distance) {
  const Dims d = phantom.options().dims;
  const auto quantise = [](double value) { return static_cast<std::int16_t>(std::lround(value * kDistanceSteps)); };
  const std::int64_t y_bricks = brick_of(d.y - 1) + 1;
  const std::int64_t z_first = brick_of(z_begin), z_bricks = brick_of(z_end - 1) - z_first + 1;
  parallel_for(y_bricks * z_bricks, 1, [&](std::int64_t item) {
    const std::int64_t y_lo = item % y_bricks * kBrickEdge, z_lo = (z_first + item / y_bricks) * kBrickEdge;
    const VoxelBounds clip{{0, y_lo, std::max(z_lo, z_begin)},
                           {d.x, std::min(y_lo + kBrickEdge, d.y), std::min(z_lo + kBrickEdge, z_end)}};
    const auto row = [&](std::int64_t y, std::int64_t z) { return (z - z_begin) * d.slice() + y * d.x; };
    for (std::int64_t bx = 0; bx <= brick_of(d.x - 1); ++bx)
      visit_brick(
          phantom, {static_cast<float>(Phantom::kReach), true}, {bx * kBrickEdge, y_lo, z_lo}, kBrickEdge, clip,
          [&](const VoxelBounds& box, const Fields& f) {
            const auto name = static_cast<std::uint8_t>(label_of(f));
            const std::int16_t far = quantise(f.clay.v < 0.0f ? -Phantom::kReach : Phantom::kReach);
            for (std::int64_t z = box.lo[2]; z < box.hi[2]; ++z)
              for (std::int64_t y = box.lo[1]; y < box.hi[1]; ++y) {
                std::fill_n(label.data() + row(y, z) + box.lo[0], box.hi[0] - box.lo[0], name);
                std::fill_n(distance.data() + row(y, z) + box.lo[0], box.hi[0] - box.lo[0], far);
              }
          },
          [&](std::int64_t x, std::int64_t y, std::int64_t z, const Fields& f) {
            label[static_cast<std::size_t>(row(y, z) + x)] = static_cast<std::uint8_t>(label_of(f));
            distance[static_cast<std::size_t>(row(y, z) + x)] = quantise(
                phantom.signed_distance({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
          });
  });
}

void rasterise_interface(const Phantom& phantom, std::int64_t z_begin, std::int64_t z_end,
                         std::span<std::int16_t> distance) {
  const Dims d = phantom.options().dims;
  parallel_for(d.y * (z_end - z_begin), 4, [&](std::int64_t item) {
    const std::int64_t y = item % d.y, z = z_begin + item / d.y;
    for (std::int64_t x = 0; x < d.x; ++x)
      distance[static_cast<std::size_t>(item * d.x + x)] =
          static_cast<std::int16_t>(std::lround(kDistanceSteps * phantom.tablet_distance({x, y, z})));
  });
}

Result<PhantomReport> write_phantom(const std::filesystem::path& scan,
                                    const std::optional<std::filesystem::path>& truth, const PhantomOptions& options,
                                    Progress& progress) {
  DUBSAR_ASSIGN(std::shared_ptr<const Phantom> phantom, Phantom::create(options));
  PhantomReport report;
  if (phantom->options().scanner) {
    DUBSAR_ASSIGN(report.scanner, write_scanned(scan, *phantom, progress));
  } else {
    DUBSAR_TRY(write_scan(scan, phantom, progress));
    report.sigma = PhantomSource(phantom).sigma();
  }
  if (truth) DUBSAR_TRY(write_truth(*truth, *phantom, progress));
  report.options = phantom->options();
  report.glued_fraction = phantom->glued_fraction();
  report.cracked = phantom->cracked();
  report.pores = phantom->pore_count();
  for (const Wedge& wedge : phantom->wedges()) {
    if (wedge.owner == Owner::kTablet) ++report.wedges_by_case[static_cast<std::size_t>(wedge.state)];
    ++(wedge.owner == Owner::kTablet ? report.tablet_wedges : report.envelope_wedges);
  }
  return report;
}

}  // namespace dubsar::phantom
