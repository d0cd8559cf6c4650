#pragma once
// HDF5 files: links, attributes, and the datasets they lead to. Every call into the library holds one lock, so that all
// functions here may be called from any thread.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/files/input_file.h"
#include "core/base/result.h"
#include "core/hdf5/hdf5_dataset.h"

namespace dubsar {

/// One link seen by Hdf5File::list().
struct Hdf5Link {
  enum class Kind { kGroup, kDataset, kSoft, kExternal, kOther };
  std::string path;
  Kind kind = Kind::kOther;
  std::string target_file, target_path;  ///< of a soft (path only) or an external link
};

/// Where a path leads, followed link by link. External links are never followed by this class.
struct Hdf5Target {
  enum class Kind { kMissing, kGroup, kDataset, kExternal, kOther };
  Kind kind = Kind::kMissing;
  std::string path;                          ///< without soft links; for kMissing the part that is missing
  std::string external_file, external_path;  ///< for kExternal, with the rest of the path appended
};

/// An HDF5 file, read only. Never opens another file: external links are reported, not followed.
class Hdf5File {
 public:
  /// Errors: kNoInput, kPermission, kBadData (a folder, a device, no HDF5, damaged, truncated).
  static Result<Hdf5File> open(const std::filesystem::path& path);
  /// Whether the first bytes (or those behind a user block) are the HDF5 signature.
  static bool has_signature(const std::filesystem::path& path);
  static bool has_signature(const InputFile& file);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  const std::filesystem::path& path() const noexcept { return path_; }

  /// Every link below `group`, depth first, names in rising order; a group is entered once. kBadData beyond 200,000
  /// links or 64 levels.
  Result<std::vector<Hdf5Link>> list(const std::string& group = "/") const;
  Result<Hdf5Target> resolve(const std::string& path) const;

  /// `path` must resolve to a dataset (see resolve()). The library opens the source files of a virtual dataset when it
  /// is asked for its shape: only with `open_sources` are the dims of such a dataset filled in.
  Result<Hdf5DatasetInfo> inspect(const std::string& path, bool open_sources = false) const;
  Result<Hdf5Dataset> open_dataset(const std::string& path, bool open_sources = false) const;

  /// Attributes of a group or dataset; nullopt when absent or of another kind (numbers: integers and floats, strings:
  /// fixed or variable length), longer than 4096 elements, or texts of more than 64 KiB each or 1 MiB together.
  std::optional<std::vector<double>> numbers(const std::string& object, const std::string& attribute) const;
  std::optional<std::vector<std::string>> strings(const std::string& object, const std::string& attribute) const;
  /// Whether an attribute has floats.
  bool is_float(const std::string& object, const std::string& attribute) const;
  /// A dimension scale: which axes of which objects (Hdf5DatasetInfo::address) it belongs to; at most 4096.
  struct ScaledAxis {
    std::uint64_t address = 0;
    int axis = 0;
  };
  std::vector<ScaledAxis> scaled_axes(const std::string& scale) const;
  /// The first string, or nullopt.
  std::optional<std::string> string(const std::string& object, const std::string& attribute) const;

  /// Contents of a small numeric or string dataset (at most 65536 elements); nullopt when absent or of another kind.
  std::optional<std::vector<double>> number_dataset(const std::string& path) const;
  std::optional<std::string> string_dataset(const std::string& path) const;

 private:
  Hdf5File() = default;
  std::int64_t id_ = -1;
  std::filesystem::path path_;
};

}  // namespace dubsar
