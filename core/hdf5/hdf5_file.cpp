#include "core/hdf5/hdf5_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "core/base/input_file.h"
#include "core/hdf5/hdf5_api.h"

namespace dubsar {
using namespace hdf5_api;
namespace {

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

bool filter_built_in(int id) { return id >= 1 && id <= 6 && H5Zfilter_avail(id) > 0; }

constexpr std::size_t kMaxFilters = 32;
constexpr std::size_t kMaxLinks = 200000;
constexpr int kMaxLevels = 64;
constexpr hssize_t kMaxAttributeElements = 4096;
constexpr hssize_t kMaxSmallDataset = 65536;
constexpr std::size_t kMaxText = 1 << 16;

// Reads `count` strings of an attribute or dataset; `read` fills a buffer in the given memory type.
std::optional<std::vector<std::string>> read_strings(hid_t type, hid_t space,
                                                     const std::function<herr_t(hid_t, void*)>& read) {
  if (H5Tget_class(type) != H5T_STRING) return std::nullopt;
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  if (points < 1 || points > kMaxAttributeElements) return std::nullopt;
  const auto count = static_cast<std::size_t>(points);
  const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_cset(memory.get(), H5Tget_cset(type));
  std::vector<std::string> texts;
  if (H5Tis_variable_str(type) > 0) {
    H5Tset_size(memory.get(), H5T_VARIABLE);
    std::vector<char*> pointers(count, nullptr);
    const bool good = read(memory.get(), pointers.data()) >= 0;
    for (const char* text : pointers) texts.emplace_back(text != nullptr ? text : "");
    H5Dvlen_reclaim(memory.get(), space, H5P_DEFAULT, pointers.data());
    if (!good) return std::nullopt;
  } else {
    const std::size_t size = H5Tget_size(type);
    if (size == 0 || size > kMaxText || size * count > (kMaxText << 4)) return std::nullopt;
    H5Tset_size(memory.get(), size);
    H5Tset_strpad(memory.get(), H5T_STR_NULLPAD);
    std::vector<char> buffer(size * count);
    if (read(memory.get(), buffer.data()) < 0) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) {
      std::string text(buffer.data() + i * size, size);
      if (const auto end = text.find('\0'); end != std::string::npos) text.resize(end);
      while (!text.empty() && text.back() == ' ') text.pop_back();
      texts.push_back(std::move(text));
    }
  }
  return texts;
}

Handle open_attribute(hid_t file, const std::string& object, const std::string& attribute) {
  const Handle access = link_access();
  const Handle parent(H5Oopen(file, object.c_str(), access.get()), H5Oclose);
  if (!parent.ok() || H5Aexists(parent.get(), attribute.c_str()) <= 0) return {};
  return {H5Aopen(parent.get(), attribute.c_str(), H5P_DEFAULT), H5Aclose};
}

std::vector<std::string> path_parts(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    if (end > begin && path.compare(begin, end - begin, ".") != 0) parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string join(const std::string& group, const std::string& name) { return (group == "/" ? "" : group) + "/" + name; }

// Soft and external link values.
void read_link_value(hid_t file, const std::string& path, const H5L_info_t& info, std::string& target_file,
                     std::string& target_path) {
  if (info.u.val_size == 0 || info.u.val_size > kMaxText) return;
  std::vector<char> value(info.u.val_size + 1, '\0');
  const Handle access = link_access();
  if (H5Lget_val(file, path.c_str(), value.data(), info.u.val_size, access.get()) < 0) return;
  if (info.type == H5L_TYPE_SOFT) {
    target_path = value.data();
  } else {
    unsigned int flags = 0;
    const char* external_file = nullptr;
    const char* external_path = nullptr;
    if (H5Lunpack_elink_val(value.data(), info.u.val_size, &flags, &external_file, &external_path) < 0) return;
    target_file = external_file;
    target_path = external_path;
  }
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
    for (std::size_t i = 0; i < std::min(count, kMaxLinks); ++i)
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
    info.filters.push_back({id, label, Hdf5File::filter_available(id)});
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
  if (info.scalar && H5Pfill_value_defined(creation, &fill) >= 0 && fill == H5D_FILL_VALUE_USER_DEFINED)
    H5Pget_fill_value(creation, H5T_NATIVE_DOUBLE, &info.fill_value);
}

struct OpenDataset {
  Handle id;
  Hdf5DatasetInfo info;
};

Result<OpenDataset> open_with_info(hid_t file, const std::string& path, hid_t access, bool open_sources) {
  OpenDataset opened{Handle(H5Dopen2(file, path.c_str(), access), H5Dclose), {}};
  if (!opened.id.ok())
    return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" cannot be opened ({}); the file is damaged", path,
                reason());
  opened.info.path = path;
  const Handle type(H5Dget_type(opened.id.get()), H5Tclose);
  const Handle creation(H5Dget_create_plist(opened.id.get()), H5Pclose);
  if (!type.ok() || !creation.ok())
    return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" cannot be described ({}); the file is damaged", path,
                reason());
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

}  // namespace

// ---------------------------------------------------------------------------------------------------- Hdf5Dataset

Hdf5Dataset::Hdf5Dataset(Hdf5Dataset&& other) noexcept
    : id_(std::exchange(other.id_, -1)), needs_plugin_(other.needs_plugin_), info_(std::move(other.info_)) {}

Hdf5Dataset::~Hdf5Dataset() {
  if (id_ < 0) return;
  const Library library;
  H5Dclose(id_);
}

Result<void> Hdf5Dataset::read_stored(std::span<const std::uint64_t> offset, std::span<const std::uint64_t> count,
                                      std::span<std::byte> out) const {
  DUBSAR_CHECK(info_.plain_scalar);
  std::uint64_t bytes = info_.element_bytes();
  for (const std::uint64_t n : count) bytes *= n;
  DUBSAR_CHECK(bytes == out.size());
  const Library library;
  const PluginsAllowed plugins(needs_plugin_);
  const Handle type(H5Dget_type(id_), H5Tclose);
  const auto selection = select(id_, offset, count);
  if (!selection ||
      H5Dread(id_, type.get(), selection->memory.get(), selection->file.get(), H5P_DEFAULT, out.data()) < 0)
    return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" cannot be read ({}); the file is damaged", info_.path,
                reason());
  return {};
}

Result<void> Hdf5Dataset::read_doubles(std::span<const std::uint64_t> offset, std::span<const std::uint64_t> count,
                                       std::span<double> out) const {
  std::uint64_t elements = 1;
  for (const std::uint64_t n : count) elements *= n;
  DUBSAR_CHECK(elements == out.size());
  const Library library;
  const PluginsAllowed plugins(needs_plugin_);
  const auto selection = select(id_, offset, count);
  if (!selection ||
      H5Dread(id_, H5T_NATIVE_DOUBLE, selection->memory.get(), selection->file.get(), H5P_DEFAULT, out.data()) < 0)
    return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" cannot be read ({}); the file is damaged", info_.path,
                reason());
  return {};
}

Result<std::uint64_t> Hdf5Dataset::written_chunks() const {
  const Library library;
  hsize_t count = 0;
  const Handle space(H5Dget_space(id_), H5Sclose);
  if (H5Dget_num_chunks(id_, space.get(), &count) < 0)
    return fail(ErrorKind::kBadData, "import_hdf5: the chunk index of \"{}\" cannot be read ({}); the file is damaged",
                info_.path, reason());
  return count;
}

Result<Hdf5Chunk> Hdf5Dataset::chunk_at(std::span<const std::uint64_t> origin) const {
  DUBSAR_CHECK(origin.size() <= kHdf5MaxRank);
  const Library library;
  Hdf5Chunk chunk;
  std::copy(origin.begin(), origin.end(), chunk.origin.begin());
  const std::vector<hsize_t> offset(origin.begin(), origin.end());
  unsigned int mask = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t bytes = 0;
  if (H5Dget_chunk_info_by_coord(id_, offset.data(), &mask, &address, &bytes) < 0)
    return fail(ErrorKind::kBadData, "import_hdf5: the chunk index of \"{}\" cannot be read ({}); the file is damaged",
                info_.path, reason());
  if (address != HADDR_UNDEF && address <= static_cast<haddr_t>(INT64_MAX)) {
    chunk.file_offset = static_cast<std::int64_t>(address);
    chunk.bytes = bytes;
    chunk.filter_mask = mask;
  }
  return chunk;
}

Result<void> Hdf5Dataset::read_chunk(const Hdf5Chunk& chunk, std::span<std::byte> out) const {
  DUBSAR_CHECK(chunk.bytes <= out.size());
  const Library library;
  std::uint32_t mask = 0;
  const std::vector<hsize_t> offset(chunk.origin.begin(), chunk.origin.end());
  if (H5Dread_chunk(id_, H5P_DEFAULT, offset.data(), &mask, out.data()) < 0)
    return fail(ErrorKind::kBadData, "import_hdf5: a chunk of \"{}\" cannot be read ({}); the file is damaged",
                info_.path, reason());
  return {};
}

// ------------------------------------------------------------------------------------------------------- Hdf5File

bool Hdf5File::filter_available(int filter_id) {
  const Library library;
  const PluginsAllowed plugins(plugin_allowed(filter_id));
  return filter_built_in(filter_id) || (plugin_allowed(filter_id) && H5Zfilter_avail(filter_id) > 0);
}

bool Hdf5File::plugin_allowed(int filter_id) noexcept {
  constexpr std::array<int, 6> kAllowed{307, 32000, 32001, 32004, 32008, 32013};
  return std::find(kAllowed.begin(), kAllowed.end(), filter_id) != kAllowed.end();
}

void Hdf5File::set_plugin_folder(const std::filesystem::path& folder) {
  const Library library;
  plugin_folder_ref() = folder;
  restrict_plugins();
}

std::filesystem::path Hdf5File::plugin_folder() {
  const Library library;
  return plugin_folder_ref();
}

bool Hdf5File::has_signature(const std::filesystem::path& path) {
  static constexpr std::array<unsigned char, 8> kSignature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  const auto file = InputFile::open(path);
  if (!file) return false;
  for (std::int64_t offset = 0; offset + 8 <= file->size(); offset = offset == 0 ? 512 : offset * 2) {
    std::array<unsigned char, 8> bytes{};
    if (!file->read_at(offset, std::as_writable_bytes(std::span(bytes)))) return false;
    if (bytes == kSignature) return true;
  }
  return false;
}

Result<Hdf5File> Hdf5File::open(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const InputFile probe, InputFile::open(path));
  if (!has_signature(path))
    return fail(ErrorKind::kBadData, "import_hdf5: {} is not an HDF5 file, its signature is missing", path.string());
  const Library library;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.get(), true, true);  // read-only media and network shares have no locks
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  H5Pset_elink_file_cache_size(access.get(), 0);
  Handle id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!id.ok())
    return fail(ErrorKind::kBadData,
                "import_hdf5: {} ({} bytes) is damaged, truncated or still being written ({}); copy it again",
                path.string(), probe.size(), reason());
  Hdf5File file;
  const Handle creation(H5Fget_create_plist(id.get()), H5Pclose);
  hsize_t user_block = 0;
  H5Pget_userblock(creation.get(), &user_block);
  file.user_block_ = user_block;
  file.path_ = path;
  file.id_ = id.release();
  return file;
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : id_(std::exchange(other.id_, -1)), user_block_(other.user_block_), path_(std::move(other.path_)) {}

Hdf5File::~Hdf5File() {
  if (id_ < 0) return;
  const Library library;
  H5Fclose(id_);
}

Result<std::vector<Hdf5Link>> Hdf5File::list(const std::string& group) const {
  const Library library;
  const Handle access = link_access();
  std::vector<Hdf5Link> links;
  std::set<haddr_t> entered;
  const auto too_much = [&] {
    return fail(ErrorKind::kBadData,
                "import_hdf5: {} has more than {} links or {} levels of groups, expected fewer; "
                "name the volume with --dataset",
                path_.string(), kMaxLinks, kMaxLevels);
  };
  const std::function<Result<void>(const std::string&, int)> walk = [&](const std::string& at,
                                                                        int level) -> Result<void> {
    const Handle id(H5Gopen2(id_, at.c_str(), access.get()), H5Gclose);
    H5O_info_t self;
    if (!id.ok() || H5Oget_info2(id.get(), &self, H5O_INFO_BASIC) < 0)
      return fail(ErrorKind::kBadData, "import_hdf5: group \"{}\" cannot be opened ({}); the file is damaged", at,
                  reason());
    if (!entered.insert(self.addr).second) return {};
    std::vector<std::string> names;
    const herr_t status = H5Literate(
        id.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
        [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
          auto& found = *static_cast<std::vector<std::string>*>(out);
          found.emplace_back(name);
          return found.size() > kMaxLinks ? 1 : 0;
        },
        &names);
    if (status < 0)
      return fail(ErrorKind::kBadData, "import_hdf5: group \"{}\" cannot be listed ({}); the file is damaged", at,
                  reason());
    if (status > 0 || level > kMaxLevels) return too_much();
    for (const std::string& name : names) {
      if (links.size() >= kMaxLinks) return too_much();
      Hdf5Link link;
      link.path = join(at, name);
      H5L_info_t info;
      if (H5Lget_info(id.get(), name.c_str(), &info, access.get()) < 0) continue;
      if (info.type == H5L_TYPE_HARD) {
        H5O_info_t object;
        if (H5Oget_info_by_name2(id.get(), name.c_str(), &object, H5O_INFO_BASIC, access.get()) >= 0) {
          if (object.type == H5O_TYPE_GROUP) link.kind = Hdf5Link::Kind::kGroup;
          if (object.type == H5O_TYPE_DATASET) link.kind = Hdf5Link::Kind::kDataset;
        }
      } else if (info.type == H5L_TYPE_SOFT || info.type == H5L_TYPE_EXTERNAL) {
        link.kind = info.type == H5L_TYPE_SOFT ? Hdf5Link::Kind::kSoft : Hdf5Link::Kind::kExternal;
        read_link_value(id_, link.path, info, link.target_file, link.target_path);
      }
      const bool descend = link.kind == Hdf5Link::Kind::kGroup;
      links.push_back(link);
      if (descend) DUBSAR_TRY(walk(link.path, level + 1));
    }
    return {};
  };
  DUBSAR_TRY(walk(group, 0));
  return links;
}

Result<Hdf5Target> Hdf5File::resolve(const std::string& path) const {
  const Library library;
  const Handle access = link_access();
  Hdf5Target target;
  target.kind = Hdf5Target::Kind::kGroup;
  std::string at = "/";
  std::vector<std::string> parts = path_parts(path);
  for (int links_followed = 0; !parts.empty();) {
    const std::string next = join(at, parts.front());
    parts.erase(parts.begin());
    H5L_info_t info;
    if (target.kind != Hdf5Target::Kind::kGroup || H5Lexists(id_, next.c_str(), access.get()) <= 0 ||
        H5Lget_info(id_, next.c_str(), &info, access.get()) < 0) {
      target.kind = Hdf5Target::Kind::kMissing;
      target.path = next;
      return target;
    }
    if (info.type == H5L_TYPE_HARD) {
      H5O_info_t object;
      if (H5Oget_info_by_name2(id_, next.c_str(), &object, H5O_INFO_BASIC, access.get()) < 0)
        return fail(ErrorKind::kBadData, "import_hdf5: \"{}\" cannot be opened ({}); the file is damaged", next,
                    reason());
      target.kind = object.type == H5O_TYPE_GROUP     ? Hdf5Target::Kind::kGroup
                    : object.type == H5O_TYPE_DATASET ? Hdf5Target::Kind::kDataset
                                                      : Hdf5Target::Kind::kOther;
      at = next;
    } else if (info.type == H5L_TYPE_SOFT) {
      std::string unused, to;
      read_link_value(id_, next, info, unused, to);
      if (++links_followed > 16)
        return fail(ErrorKind::kBadData, "import_hdf5: more than 16 soft links on the way to \"{}\", expected fewer",
                    path);
      std::vector<std::string> front = path_parts(to);
      parts.insert(parts.begin(), front.begin(), front.end());
      if (!to.empty() && to.front() == '/') at = "/";
    } else if (info.type == H5L_TYPE_EXTERNAL) {
      target.kind = Hdf5Target::Kind::kExternal;
      target.path = next;
      read_link_value(id_, next, info, target.external_file, target.external_path);
      for (const std::string& part : parts) target.external_path = join(target.external_path, part);
      return target;
    } else {
      target.kind = Hdf5Target::Kind::kOther;
      at = next;
    }
  }
  target.path = at;
  return target;
}

Result<Hdf5DatasetInfo> Hdf5File::inspect(const std::string& path, bool open_sources) const {
  const Library library;
  const Handle access = dataset_access();
  DUBSAR_ASSIGN(OpenDataset opened, open_with_info(id_, path, access.get(), open_sources));
  return std::move(opened.info);
}

Result<Hdf5Dataset> Hdf5File::open_dataset(const std::string& path, std::uint64_t chunk_cache_bytes,
                                           bool open_sources) const {
  const Library library;
  const Handle access = dataset_access();
  H5Pset_chunk_cache(access.get(), 12421, chunk_cache_bytes, 1.0);
  DUBSAR_ASSIGN(OpenDataset opened, open_with_info(id_, path, access.get(), open_sources));
  Hdf5Dataset dataset;
  dataset.info_ = std::move(opened.info);
  dataset.needs_plugin_ = std::any_of(dataset.info_.filters.begin(), dataset.info_.filters.end(),
                                      [](const Hdf5Filter& filter) { return plugin_allowed(filter.id); });
  dataset.id_ = opened.id.release();
  return dataset;
}

std::optional<std::vector<double>> Hdf5File::numbers(const std::string& object, const std::string& attribute) const {
  const Library library;
  const Handle id = open_attribute(id_, object, attribute);
  if (!id.ok()) return std::nullopt;
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  const Handle space(H5Aget_space(id.get()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || count < 1 || count > kMaxAttributeElements) return std::nullopt;
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Aread(id.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) return std::nullopt;
  return values;
}

std::optional<std::vector<std::string>> Hdf5File::strings(const std::string& object,
                                                          const std::string& attribute) const {
  const Library library;
  const Handle id = open_attribute(id_, object, attribute);
  if (!id.ok()) return std::nullopt;
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  const Handle space(H5Aget_space(id.get()), H5Sclose);
  return read_strings(type.get(), space.get(), [&](hid_t memory, void* out) { return H5Aread(id.get(), memory, out); });
}

std::optional<std::string> Hdf5File::string(const std::string& object, const std::string& attribute) const {
  auto texts = strings(object, attribute);
  if (!texts) return std::nullopt;
  return std::move(texts->front());
}

std::optional<std::vector<double>> Hdf5File::number_dataset(const std::string& path) const {
  const Library library;
  const auto target = resolve(path);
  if (!target || target->kind != Hdf5Target::Kind::kDataset) return std::nullopt;
  const auto opened = open_dataset(target->path);
  if (!opened || !opened->info().scalar || opened->info().layout == Hdf5Layout::kVirtual ||
      !opened->info().external.empty())
    return std::nullopt;
  std::uint64_t count = 1;
  for (const std::uint64_t n : opened->info().dims)
    if (n > static_cast<std::uint64_t>(kMaxSmallDataset) || (count *= n) > static_cast<std::uint64_t>(kMaxSmallDataset))
      return std::nullopt;
  const PluginsAllowed plugins(opened->needs_plugin_);
  std::vector<double> values(count);
  if (values.empty() || H5Dread(opened->id_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return std::nullopt;
  return values;
}

std::optional<std::string> Hdf5File::string_dataset(const std::string& path) const {
  const Library library;
  const auto target = resolve(path);
  if (!target || target->kind != Hdf5Target::Kind::kDataset) return std::nullopt;
  const auto opened = open_dataset(target->path);
  if (!opened || opened->info().type_text != "string" || opened->info().layout == Hdf5Layout::kVirtual ||
      !opened->info().external.empty())
    return std::nullopt;
  const Handle type(H5Dget_type(opened->id_), H5Tclose);
  const Handle space(H5Dget_space(opened->id_), H5Sclose);
  auto texts = read_strings(type.get(), space.get(), [&](hid_t memory, void* out) {
    return H5Dread(opened->id_, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
  });
  if (!texts) return std::nullopt;
  return std::move(texts->front());
}

}  // namespace dubsar
