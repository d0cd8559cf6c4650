#include "app/cli/input_options.h"

namespace dubsar::app {

namespace {

void add_reading(Arguments group, InputOptionTexts& texts) {
  group.value("--dataset", texts.dataset, "HDF5 path of the volume (also FILE:/path); default: found by itself");
  group.value("--axis-order", texts.axis_order,
              "order of the stored axes, slowest first: zyx, xyz, ...; a minus before one that runs backwards");
  group.value("--dims", texts.dims, "raw file: size NXxNYxNZ");
  group.value("--type", texts.type, "raw file: uint8, int16, float32, ...");
  group.value("--endian", texts.endian, "raw file: little or big").one_of({"little", "big"});
  group.value("--skip", texts.skip, "raw file: bytes before the voxels").not_negative();
  group.value("--allow-external", texts.allow_external,
              "folder in which the file may refer to other files (external links, virtual datasets)");
  group.flag("--trust", texts.trust, "accept compression ratios above 250:1");
  group.flag("--allow-sparse", texts.allow_sparse, "accept chunks that were never written");
}

}  // namespace

void add_input_options(Arguments command, InputOptionTexts& texts) {
  const Arguments group = command.group("Input");
  add_reading(group, texts);
  Arguments taken = group;
  taken.value("--voxel-size", texts.voxel_size, "voxel size, e.g. 38um or 10um,10um,25um (x,y,z)");
  taken.value("--crop", texts.crop, "part of the volume, x0:x1,y0:y1,z0:z1; empty bounds are the borders");
  taken
      .value("--ignore", texts.ignore,
             "grey value that is no measurement, wherever it occurs; may be repeated; none: nothing is but NaN and Inf "
             "(default: a constant outside the field of view is found)")
      .one_word_each_time()
      .called("VALUE");
  taken.value("--stride", texts.stride, "take every N-th voxel: N or NX,NY,NZ");
}

void add_scan_options(Arguments command, InputOptionTexts& texts) { add_reading(command.group("Scan"), texts); }

Result<ImportOptions> parse_input_options(const std::string& path, const InputOptionTexts& texts) {
  ImportOptions options;
  options.path = path;
  options.dataset = texts.dataset;
  options.trust = texts.trust;
  options.allow_sparse = texts.allow_sparse;
  if (!texts.allow_external.empty()) options.allow_external = texts.allow_external;
  if (!texts.crop.empty()) {
    DUBSAR_ASSIGN(options.crop, parse_crop(texts.crop));
  }
  DUBSAR_ASSIGN(options.ignored, parse_ignored(texts.ignore));
  if (!texts.stride.empty()) {
    DUBSAR_ASSIGN(options.stride, parse_stride(texts.stride));
  }
  if (!texts.axis_order.empty()) {
    DUBSAR_ASSIGN(options.axis_order, parse_axis_order(texts.axis_order));
  }
  if (!texts.voxel_size.empty()) {
    DUBSAR_ASSIGN(options.voxel_size_mm, parse_voxel_size(texts.voxel_size));
  }
  if (texts.dims.empty() && texts.type.empty()) {
    if (texts.skip > 0) return fail(ErrorKind::kUsage, "--skip is for raw files: give --dims and --type too");
    return options;
  }
  if (texts.dims.empty() || texts.type.empty())
    return fail(ErrorKind::kUsage, "a raw file needs both --dims NXxNYxNZ and --type");
  RawSpec raw;
  DUBSAR_ASSIGN(raw.dims, parse_dims(texts.dims));
  const auto type = parse_scalar_type(texts.type);
  if (!type)
    return fail(ErrorKind::kUsage, "--type \"{}\" is not known, expected uint8, int16, float32 and the like",
                texts.type);
  raw.type = *type;
  DUBSAR_ASSIGN(raw.order, parse_byte_order(texts.endian));
  raw.skip = texts.skip;
  options.raw = raw;
  return options;
}

}  // namespace dubsar::app
