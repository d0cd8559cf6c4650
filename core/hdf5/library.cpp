#include "core/hdf5/library.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

namespace dubsar::hdf5 {
namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// A conversion of the library's own kind: from the 16 bytes that stand for a variable-length string in a file (length,
/// address and index in a heap) to the first four of them, without going to the heap.
herr_t take_length(hid_t from, hid_t to, H5T_cdata_t* data, std::size_t count, std::size_t stride, std::size_t,
                   void* buffer, void*, hid_t) {
  if (data->command == H5T_CONV_FREE) return 0;
  if (data->command == H5T_CONV_INIT) {
    data->need_bkg = H5T_BKG_NO;
    return H5Tis_variable_str(from) > 0 && H5Tget_class(to) == H5T_OPAQUE && H5Tget_size(to) == 4 ? 0 : -1;
  }
  const std::size_t from_step = stride > 0 ? stride : H5Tget_size(from), to_step = stride > 0 ? stride : 4;
  auto* const bytes = static_cast<char*>(buffer);
  for (std::size_t i = 0; i < count; ++i) std::memmove(bytes + i * to_step, bytes + i * from_step, 4);
  return 0;
}

// First of all calls: any other one would have the library close what is open when the program ends, and it falls over
// files that could not be written.
void start_library() {
  H5dont_atexit();
  H5open();
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose), length(H5Tcreate(H5T_OPAQUE, 4), H5Tclose);
  H5Tset_size(text.get(), H5T_VARIABLE);
  H5Tregister(H5T_PERS_SOFT, "string_length", text.get(), length.get(), take_length);
  set_plugin_folder(DUBSAR_HDF5_PLUGIN_DIR);
}

herr_t refuse_external_link(const char*, const char*, const char*, const char*, unsigned int*, hid_t, void*) {
  return -1;
}

Handle access_list(hid_t property_class) {
  Handle list(H5Pcreate(property_class), H5Pclose);
  if (list.ok()) H5Pset_elink_cb(list.get(), refuse_external_link, nullptr);
  return list;
}

}  // namespace

Library::Library() : lock_(library_mutex()) {
  static const bool once = (start_library(), true);
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5Eclear2(H5E_DEFAULT);
}

std::filesystem::path set_plugin_folder(const std::filesystem::path& folder) {
  static std::filesystem::path current;
  unsigned int state = 0;
  H5PLget_loading_state(&state);  // starts the plug-in package
  unsigned int count = 0;
  H5PLsize(&count);
  for (; count > 0; --count) H5PLremove(count - 1);
  H5PLappend(folder.c_str());
  H5PLset_loading_state(0);
  return std::exchange(current, folder);
}

PluginsAllowed::PluginsAllowed(bool allowed) : allowed_(allowed) {
  if (allowed_) H5PLset_loading_state(H5PL_FILTER_PLUGIN);
}

PluginsAllowed::~PluginsAllowed() {
  if (allowed_) H5PLset_loading_state(0);
}

std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned int, const H5E_error2_t* entry, void* out) -> herr_t {
        auto& innermost = *static_cast<std::string*>(out);
        if (innermost.empty() && entry->desc != nullptr) innermost = entry->desc;
        return 0;
      },
      &text);
  // "file write failed: time = ..., error message = 'No space left on device', buf = 0x..."
  constexpr std::string_view kSystem = "error message = '";
  if (const auto begin = text.find(kSystem); begin != std::string::npos) {
    text.erase(0, begin + kSystem.size());
    text.erase(std::min(text.find('\''), text.size()));
  }
  return text.empty() ? "no reason given" : text.substr(0, 200);
}

Handle link_access() { return access_list(H5P_LINK_ACCESS); }

Handle dataset_access() { return access_list(H5P_DATASET_ACCESS); }

hid_t file_type(ScalarType type, ByteOrder order) {
  const bool big = order == ByteOrder::kBig;
  switch (type) {
    case ScalarType::kU8:
      return H5T_STD_U8LE;
    case ScalarType::kI8:
      return H5T_STD_I8LE;
    case ScalarType::kU16:
      return big ? H5T_STD_U16BE : H5T_STD_U16LE;
    case ScalarType::kI16:
      return big ? H5T_STD_I16BE : H5T_STD_I16LE;
    case ScalarType::kU32:
      return big ? H5T_STD_U32BE : H5T_STD_U32LE;
    case ScalarType::kI32:
      return big ? H5T_STD_I32BE : H5T_STD_I32LE;
    case ScalarType::kU64:
      return big ? H5T_STD_U64BE : H5T_STD_U64LE;
    case ScalarType::kI64:
      return big ? H5T_STD_I64BE : H5T_STD_I64LE;
    case ScalarType::kF32:
      return big ? H5T_IEEE_F32BE : H5T_IEEE_F32LE;
    case ScalarType::kF64:
      return big ? H5T_IEEE_F64BE : H5T_IEEE_F64LE;
    case ScalarType::kF16:
      break;
  }
  return -1;
}

std::optional<Selection> select(hid_t dataset, std::span<const std::uint64_t> offset,
                                std::span<const std::uint64_t> count) {
  const std::vector<hsize_t> start(offset.begin(), offset.end());
  const std::vector<hsize_t> size(count.begin(), count.end());
  Selection selection{Handle(H5Dget_space(dataset), H5Sclose),
                      Handle(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose)};
  if (!selection.file.ok() || !selection.memory.ok()) return std::nullopt;
  if (H5Sget_simple_extent_ndims(selection.file.get()) != static_cast<int>(start.size())) return std::nullopt;
  if (H5Sselect_hyperslab(selection.file.get(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) < 0)
    return std::nullopt;
  return selection;
}

Handle string_length_type() { return {H5Tcreate(H5T_OPAQUE, 4), H5Tclose}; }

std::vector<std::string> path_parts(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    if (end > begin && path.compare(begin, end - begin, ".") != 0) parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string child_path(const std::string& group, const std::string& name) {
  return (group == "/" ? "" : group) + "/" + name;
}

}  // namespace dubsar::hdf5
