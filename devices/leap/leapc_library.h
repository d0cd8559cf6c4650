#pragma once
// Ultraleap's closed libLeapC.so, loaded while the program runs: dubsar neither ships nor links it.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar::leapc {

/// The functions of the library that are used. Results are the codes of leapc_protocol.h.
class Library {
 public:
  /// Loads `path`, or the first of search_paths() when it is empty. kUnavailable: says where it looked, or
  /// what the library lacks (it must be version 5 or newer), and what to do. Any thread. A loaded library
  /// stays in memory until the process ends: it may have threads of its own.
  static Result<std::shared_ptr<const Library>> load(const std::string& path = {});
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library();

  const std::string& path() const noexcept { return path_; }

  using Connection = void*;
  std::uint32_t (*create_connection)(const void* config, Connection* connection) = nullptr;
  std::uint32_t (*open_connection)(Connection) = nullptr;
  std::uint32_t (*poll_connection)(Connection, std::uint32_t timeout_ms, void* message) = nullptr;
  void (*close_connection)(Connection) = nullptr;
  void (*destroy_connection)(Connection) = nullptr;
  std::uint32_t (*set_tracking_mode)(Connection, std::uint32_t mode) = nullptr;
  std::uint32_t (*set_policy_flags)(Connection, std::uint64_t set, std::uint64_t clear) = nullptr;
  std::int64_t (*get_now)() = nullptr;  ///< microseconds

 private:
  Library(void* handle, std::string path) : handle_(handle), path_(std::move(path)) {}
  void* handle_;
  std::string path_;
};

/// Files of the vendor's packages, newest version first; whole paths, so that no folder a user happens to be in counts.
std::vector<std::string> search_paths();

}  // namespace dubsar::leapc
