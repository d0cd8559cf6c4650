#pragma once
// The one place that includes hdf5.h, for the two sources that speak to the library: hdf5_file.cpp reads,
// hdf5_writer.cpp writes. Nothing else includes this header.

#include <hdf5.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/scalar_type.h"

namespace dubsar::hdf5_api {

inline std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

inline std::filesystem::path& plugin_folder_ref() {
  static std::filesystem::path folder = DUBSAR_HDF5_PLUGIN_DIR;
  return folder;
}

// Replaces whatever search path the library took from the environment, and closes the door to plug-ins.
inline void restrict_plugins() {
  unsigned int state = 0;
  H5PLget_loading_state(&state);  // starts the plug-in package
  unsigned int count = 0;
  H5PLsize(&count);
  for (; count > 0; --count) H5PLremove(count - 1);
  H5PLappend(plugin_folder_ref().c_str());
  H5PLset_loading_state(0);
}

// Every entry into the library holds one of these. The error stack, and with it the switch for printing it, is per
// thread in the thread-safe build.
class Library {
 public:
  Library() : lock_(library_mutex()) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    static const bool once = (H5dont_atexit(), H5open(), restrict_plugins(), true);
    static_cast<void>(once);
    H5Eclear2(H5E_DEFAULT);
  }

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

// Plug-ins may be loaded while one of these lives (under the library mutex).
class PluginsAllowed {
 public:
  explicit PluginsAllowed(bool allowed) : allowed_(allowed) {
    if (allowed_) H5PLset_loading_state(H5PL_FILTER_PLUGIN);
  }
  ~PluginsAllowed() {
    if (allowed_) H5PLset_loading_state(0);
  }
  PluginsAllowed(const PluginsAllowed&) = delete;
  PluginsAllowed& operator=(const PluginsAllowed&) = delete;

 private:
  bool allowed_;
};

class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const noexcept { return id_; }
  hid_t release() noexcept { return std::exchange(id_, -1); }
  bool ok() const noexcept { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

// The innermost message of the library's error stack.
inline std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned int, const H5E_error2_t* entry, void* out) -> herr_t {
        auto& innermost = *static_cast<std::string*>(out);
        if (innermost.empty() && entry->desc != nullptr) innermost = entry->desc;
        return 0;
      },
      &text);
  return text.empty() ? "no reason given" : text.substr(0, 200);
}

inline herr_t refuse_external_link(const char*, const char*, const char*, const char*, unsigned int*, hid_t, void*) {
  return -1;
}

inline Handle access_list(hid_t property_class) {
  Handle list(H5Pcreate(property_class), H5Pclose);
  if (list.ok()) H5Pset_elink_cb(list.get(), refuse_external_link, nullptr);
  return list;
}
inline Handle link_access() { return access_list(H5P_LINK_ACCESS); }
inline Handle dataset_access() { return access_list(H5P_DATASET_ACCESS); }

inline hid_t file_type(ScalarType type, ByteOrder order) {
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

struct Selection {
  Handle file, memory;
};

inline std::optional<Selection> select(hid_t dataset, std::span<const std::uint64_t> offset,
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

}  // namespace dubsar::hdf5_api
