#pragma once
// What every source of this folder needs of the HDF5 library: its lock, handles, the error text, access that never
// leaves the file. Internal to core/hdf5: nothing outside includes it, and nothing outside sees hdf5.h.

#include <hdf5.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/numbers/scalar_type.h"

namespace dubsar::hdf5 {

/// Every entry into the library holds one of these. The error stack, and with it the switch for printing it, is per
/// thread in the thread-safe build.
class Library {
 public:
  Library();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Replaces the folder that plug-ins come from, and whatever search path the library took from the environment. Under
/// the lock. Returns the folder before.
std::filesystem::path set_plugin_folder(const std::filesystem::path& folder);

/// Plug-ins may be loaded while one of these lives. Under the lock.
class PluginsAllowed {
 public:
  explicit PluginsAllowed(bool allowed);
  ~PluginsAllowed();
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

/// The innermost message of the library's error stack.
std::string reason();

/// Property lists under which no external link is followed.
Handle link_access();
Handle dataset_access();

/// The library's type for a number type; -1 for half floats.
hid_t file_type(ScalarType type, ByteOrder order);

/// A box of a dataset in the file and as packed memory; nullopt when the ranks differ or the library refuses.
struct Selection {
  Handle file, memory;
};
std::optional<Selection> select(hid_t dataset, std::span<const std::uint64_t> offset,
                                std::span<const std::uint64_t> count);

/// Lengths of variable-length strings before they are read: `read` fills a buffer in the memory type it is given (from
/// an attribute or a dataset), here with one std::uint32_t a string. The library itself takes whatever memory a file
/// asks for, and one heap object may be named by any number of elements. Type to read lengths with, see library.cpp.
Handle string_length_type();

/// Parts of a path without empty and "." ones; a child of a group.
std::vector<std::string> path_parts(const std::string& path);
std::string child_path(const std::string& group, const std::string& name);

}  // namespace dubsar::hdf5
