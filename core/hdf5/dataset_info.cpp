#include "core/hdf5/dataset_info.h"

#include <algorithm>
#include <set>
#include <vector>

#include "core/hdf5/hdf5_filters.h"

namespace dubsar::hdf5 {
namespace {

constexpr std::size_t kMaxFilters = 32;
constexpr std::size_t kMaxSources = 200000;
constexpr std::size_t kMaxText = 1 << 16;

struct TypeFacts {
  std::string text;
  std::optional<ScalarType> scalar;
  bool plain = false;
  ByteOrder order = ByteOrder::kLittle;
};

TypeFacts type_facts(hid_t type) {
  TypeFacts facts;
  const std::size_t size = H5Tget_size(type);
  const H5T_order_t order = H5Tget_order(type);
  facts.order = order == H5T_ORDER_BE ? ByteOrder::kBig : ByteOrder::kLittle;
  const bool usual_order = order == H5T_ORDER_LE || order == H5T_ORDER_BE;
  switch (H5Tget_class(type)) {
    case H5T_INTEGER: {
      const bool is_signed = H5Tget_sign(type) != H5T_SGN_NONE;
      facts.scalar = parse_scalar_type(fmt::format("{}int{}", is_signed ? "" : "u", size * 8));
      facts.plain = facts.scalar && usual_order && H5Tget_precision(type) == size * 8;
      facts.text = facts.scalar ? std::string(scalar_name(*facts.scalar)) : fmt::format("integer of {} bytes", size);
      break;
    }
    case H5T_FLOAT: {
      facts.scalar = parse_scalar_type(fmt::format("float{}", size * 8));
      if (facts.scalar && usual_order) {
        std::size_t sign = 0, exponent = 0, exponent_bits = 0, mantissa = 0, mantissa_bits = 0;
        H5Tget_fields(type, &sign, &exponent, &exponent_bits, &mantissa, &mantissa_bits);
        const std::size_t ieee_bits = size == 2 ? 5 : size == 4 ? 8 : 11;
        facts.plain = H5Tget_precision(type) == size * 8 && sign == size * 8 - 1 && exponent_bits == ieee_bits &&
                      mantissa == 0 && mantissa_bits == size * 8 - 1 - ieee_bits && exponent == mantissa_bits &&
                      H5Tget_ebias(type) == (std::size_t{1} << (ieee_bits - 1)) - 1;
      }
      facts.text = facts.scalar ? std::string(scalar_name(*facts.scalar)) : fmt::format("float of {} bytes", size);
      break;
    }
    case H5T_STRING:
      facts.text = "string";
      break;
    case H5T_COMPOUND:
      facts.text = "compound";
      break;
    case H5T_ENUM:
      facts.text = "enum";
      break;
    case H5T_BITFIELD:
      facts.text = "bit field";
      break;
    case H5T_OPAQUE:
      facts.text = "opaque";
      break;
    case H5T_REFERENCE:
      facts.text = "reference";
      break;
    case H5T_VLEN:
      facts.text = "variable-length";
      break;
    case H5T_ARRAY:
      facts.text = "array element";
      break;
    default:
      facts.text = "unknown";
      break;
  }
  return facts;
}

void layout_facts(hid_t dataset, hid_t creation, bool open_sources, Hdf5DatasetInfo& info) {
  const H5D_layout_t layout = H5Pget_layout(creation);
  info.layout = layout == H5D_CHUNKED   ? Hdf5Layout::kChunked
                : layout == H5D_COMPACT ? Hdf5Layout::kCompact
                : layout == H5D_VIRTUAL ? Hdf5Layout::kVirtual
                                        : Hdf5Layout::kContiguous;
  std::vector<char> name(kMaxText);
  if (layout == H5D_VIRTUAL) {
    std::size_t count = 0;
    H5Pget_virtual_count(creation, &count);
    std::set<std::string> files;
    for (std::size_t i = 0; i < std::min(count, kMaxSources); ++i)
      if (H5Pget_virtual_filename(creation, i, name.data(), name.size()) >= 0) files.insert(name.data());
    info.virtual_files.assign(files.begin(), files.end());
    if (!open_sources) return;
  }
  const int externals = layout == H5D_CONTIGUOUS ? H5Pget_external_count(creation) : 0;
  for (int i = 0; i < externals; ++i) {
    off_t offset = 0;
    hsize_t bytes = 0;
    name.front() = '\0';
    H5Pget_external(creation, static_cast<unsigned int>(i), name.size() - 1, name.data(), &offset, &bytes);
    info.external.push_back({name.data(), offset, bytes});
  }
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank > 0) {
    std::vector<hsize_t> dims(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
    info.dims.assign(dims.begin(), dims.end());
    if (layout == H5D_CHUNKED) {
      H5Pget_chunk(creation, rank, dims.data());
      info.chunk.assign(dims.begin(), dims.end());
    }
  }
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters && i < static_cast<int>(kMaxFilters); ++i) {
    unsigned int flags = 0, config = 0;
    std::size_t values = 0;
    char label[64] = "";
    const H5Z_filter_t id =
        H5Pget_filter2(creation, static_cast<unsigned int>(i), &flags, &values, nullptr, sizeof label, label, &config);
    info.filters.push_back({id, label, hdf5_filter_available(id)});
  }
  if (info.external.empty()) {
    info.storage_bytes = H5Dget_storage_size(dataset);
    if (layout == H5D_CONTIGUOUS) {
      const haddr_t offset = H5Dget_offset(dataset);
      if (offset != HADDR_UNDEF && offset <= static_cast<haddr_t>(INT64_MAX))
        info.file_offset = static_cast<std::int64_t>(offset);
    }
  }
  H5D_fill_value_t fill = H5D_FILL_VALUE_UNDEFINED;
  if (info.scalar && H5Pfill_value_defined(creation, &fill) >= 0 && fill == H5D_FILL_VALUE_USER_DEFINED) {
    info.fill.defined = true;
    H5Pget_fill_value(creation, H5T_NATIVE_DOUBLE, &info.fill.value);
    const Handle type(H5Dget_type(dataset), H5Tclose);
    if (info.plain_scalar) H5Pget_fill_value(creation, type.get(), info.fill.stored.data());
  }
}

}  // namespace

Result<OpenDataset> open_with_info(hid_t file, const std::string& path, hid_t access, bool open_sources) {
  OpenDataset opened{Handle(H5Dopen2(file, path.c_str(), access), H5Dclose), {}};
  if (!opened.id.ok())
    return fail(ErrorKind::kBadData, "dataset \"{}\" cannot be opened ({}); the file is damaged", path, reason());
  opened.info.path = path;
  const Handle type(H5Dget_type(opened.id.get()), H5Tclose);
  const Handle creation(H5Dget_create_plist(opened.id.get()), H5Pclose);
  if (!type.ok() || !creation.ok())
    return fail(ErrorKind::kBadData, "dataset \"{}\" cannot be described ({}); the file is damaged", path, reason());
  const TypeFacts facts = type_facts(type.get());
  opened.info.type_text = facts.text;
  opened.info.scalar = facts.scalar;
  opened.info.plain_scalar = facts.plain;
  opened.info.order = facts.order;
  H5O_info_t object;
  if (H5Oget_info2(opened.id.get(), &object, H5O_INFO_BASIC) >= 0) opened.info.address = object.addr;
  layout_facts(opened.id.get(), creation.get(), open_sources, opened.info);
  return opened;
}

}  // namespace dubsar::hdf5
