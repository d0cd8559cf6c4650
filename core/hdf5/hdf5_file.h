#pragma once
// HDF5 files through our own small types. Only hdf5_api.h includes hdf5.h; every call into the library holds one mutex,
// so that all functions here may be called from any thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/result.h"
#include "core/base/scalar_type.h"

namespace dubsar {

constexpr int kHdf5MaxRank = 8;  ///< arrays with more axes are listed, but not read

enum class Hdf5Layout { kCompact, kContiguous, kChunked, kVirtual };

struct Hdf5Filter {
  int id = 0;
  std::string name;        ///< as stored in the file
  bool available = false;  ///< built in, or found in the plug-in folder
};

/// A part of a dataset that lies in another file (H5Pset_external).
struct Hdf5ExternalPart {
  std::string file;
  std::int64_t offset = 0;
  std::uint64_t bytes = 0;
};

/// What is known of a dataset without reading it.
struct Hdf5DatasetInfo {
  std::string path;
  std::vector<std::uint64_t> dims;   ///< slowest axis first; empty for a scalar, and for a virtual dataset
  std::string type_text;             ///< "uint16", "float32", "compound", "string", "enum", ...
  std::optional<ScalarType> scalar;  ///< set for integers and floats of 8 to 64 bits
  bool plain_scalar = false;         ///< all bits used, IEEE float, little or big endian: bytes can be decoded by us
  ByteOrder order = ByteOrder::kLittle;
  Hdf5Layout layout = Hdf5Layout::kContiguous;
  std::vector<std::uint64_t> chunk;  ///< only for kChunked
  std::vector<Hdf5Filter> filters;   ///< in the order of writing
  std::uint64_t storage_bytes = 0;   ///< bytes allocated in the file
  std::int64_t file_offset = -1;     ///< of a contiguous dataset from the first byte of the file; -1: none
  double fill_value = 0.0;
  std::vector<Hdf5ExternalPart> external;
  std::vector<std::string> virtual_files;  ///< source files of a virtual dataset
  std::uint64_t address = 0;               ///< identity: hard links to one dataset share it

  std::uint64_t element_bytes() const noexcept {
    return scalar ? static_cast<std::uint64_t>(scalar_bytes(*scalar)) : 0;
  }
};

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

/// One stored chunk of a dataset.
struct Hdf5Chunk {
  std::array<std::uint64_t, kHdf5MaxRank> origin{};
  std::int64_t file_offset = -1;  ///< -1: never written
  std::uint64_t bytes = 0;
  std::uint32_t filter_mask = 0;  ///< bit i set: filter i was skipped for this chunk
};

class Hdf5File;

/// An open dataset. Lives no longer than its file.
class Hdf5Dataset {
 public:
  Hdf5Dataset(Hdf5Dataset&& other) noexcept;
  Hdf5Dataset& operator=(Hdf5Dataset&&) = delete;
  ~Hdf5Dataset();

  const Hdf5DatasetInfo& info() const noexcept { return info_; }

  /// Reads a box through the library in the stored type and byte order (info().plain_scalar); `out` holds exactly the
  /// bytes of the box. kBadData when the stored data cannot be decoded.
  Result<void> read_stored(std::span<const std::uint64_t> offset, std::span<const std::uint64_t> count,
                           std::span<std::byte> out) const;
  /// The same with the library's conversion to double; for odd number types and small arrays.
  Result<void> read_doubles(std::span<const std::uint64_t> offset, std::span<const std::uint64_t> count,
                            std::span<double> out) const;

  /// Number of chunks that were written.
  Result<std::uint64_t> written_chunks() const;
  /// The chunk at `origin`, which is a multiple of the chunk size.
  Result<Hdf5Chunk> chunk_at(std::span<const std::uint64_t> origin) const;
  /// The stored (still filtered) bytes of a chunk, through the library.
  Result<void> read_chunk(const Hdf5Chunk& chunk, std::span<std::byte> out) const;

 private:
  friend class Hdf5File;
  Hdf5Dataset() = default;
  std::int64_t id_ = -1;
  bool needs_plugin_ = false;
  Hdf5DatasetInfo info_;
};

/// An HDF5 file, read only. Never opens another file: external links are reported, not followed.
class Hdf5File {
 public:
  /// Errors: kNoInput, kPermission, kBadData (a folder, a device, no HDF5, damaged, truncated).
  static Result<Hdf5File> open(const std::filesystem::path& path);
  /// Whether the first bytes (or those behind a user block) are the HDF5 signature.
  static bool has_signature(const std::filesystem::path& path);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  const std::filesystem::path& path() const noexcept { return path_; }
  /// Bytes in front of the HDF5 data; chunk offsets are not to be used when there are some.
  std::uint64_t user_block() const noexcept { return user_block_; }

  /// Every link below `group`, depth first, names in rising order; a group is entered once. kBadData beyond 200,000
  /// links or 64 levels.
  Result<std::vector<Hdf5Link>> list(const std::string& group = "/") const;
  Result<Hdf5Target> resolve(const std::string& path) const;

  /// `path` must resolve to a dataset (see resolve()). The library opens the source files of a virtual dataset when it
  /// is asked for its shape: only with `open_sources` are the dims of such a dataset filled in.
  Result<Hdf5DatasetInfo> inspect(const std::string& path, bool open_sources = false) const;
  /// `chunk_cache_bytes`: memory of the library for decoded chunks.
  Result<Hdf5Dataset> open_dataset(const std::string& path, std::uint64_t chunk_cache_bytes = 1 << 20,
                                   bool open_sources = false) const;

  /// Attributes of a group or dataset; nullopt when absent or of another kind (numbers: integers and floats, strings:
  /// fixed or variable length) or longer than 4096 elements.
  std::optional<std::vector<double>> numbers(const std::string& object, const std::string& attribute) const;
  std::optional<std::vector<std::string>> strings(const std::string& object, const std::string& attribute) const;
  /// The first string, or nullopt.
  std::optional<std::string> string(const std::string& object, const std::string& attribute) const;

  /// Contents of a small numeric or string dataset (at most 65536 elements); nullopt when absent or of another kind.
  std::optional<std::vector<double>> number_dataset(const std::string& path) const;
  std::optional<std::string> string_dataset(const std::string& path) const;

  /// Folder of the filter plug-ins. Only this folder is searched, whatever the environment says. Tests may change it.
  static void set_plugin_folder(const std::filesystem::path& folder);
  static std::filesystem::path plugin_folder();
  /// Filters that may be loaded from that folder: bzip2 307, lzf 32000, blosc 32001, lz4 32004, bitshuffle 32008,
  /// zfp 32013.
  static bool plugin_allowed(int filter_id) noexcept;
  /// Built in, or found in the plug-in folder and allowed.
  static bool filter_available(int filter_id);

 private:
  Hdf5File() = default;
  std::int64_t id_ = -1;
  std::uint64_t user_block_ = 0;
  std::filesystem::path path_;
};

/// How Hdf5Writer stores a dataset.
struct Hdf5Storage {
  ScalarType type = ScalarType::kF32;
  std::vector<std::uint64_t> dims = {};   ///< slowest axis first
  std::vector<std::uint64_t> chunk = {};  ///< empty: contiguous
  int deflate = 0;                        ///< 1..9, needs chunk
  bool shuffle = false;                   ///< byte shuffle before deflate, needs chunk
  ByteOrder order = kNativeOrder;
};

/// Writes a new HDF5 file that appears at its place only on commit() (AtomicFile). The same calls give the same bytes:
/// no time stamps are stored. Groups on the way to a path are created.
class Hdf5Writer {
 public:
  /// kCannotCreate, kPermission, kIo.
  static Result<Hdf5Writer> create(const std::filesystem::path& path);

  Hdf5Writer(Hdf5Writer&& other) noexcept;
  Hdf5Writer& operator=(Hdf5Writer&&) = delete;
  ~Hdf5Writer();

  Result<void> create_group(const std::string& path);
  Result<void> create_dataset(const std::string& path, const Hdf5Storage& storage);

  /// Writes entries [first, first + count) of the slowest axis: all bytes of count * dims[1] * dims[2] ... numbers.
  template <class T>
  Result<void> write_slab(const std::string& path, std::uint64_t first, std::span<const T> values) {
    return write_slab_bytes(path, first, scalar_type_of<T>(), std::as_bytes(values));
  }

  /// A dataset in one call.
  template <class T>
  Result<void> write(const std::string& path, const Hdf5Storage& storage, std::span<const T> values) {
    DUBSAR_TRY(create_dataset(path, storage));
    return write_slab<T>(path, 0, values);
  }

  /// A scalar UTF-8 string dataset, as NeXus fields are.
  Result<void> write_string(const std::string& path, const std::string& text);

  /// float64 table of rows x columns.size(); the names are stored in the attribute "columns".
  Result<void> write_table(const std::string& path, std::span<const std::string> columns,
                           std::span<const double> values);

  /// Attributes of a group or dataset ("/" is the root group).
  Result<void> set_attribute(const std::string& object, const std::string& name, const std::string& text);
  Result<void> set_attribute(const std::string& object, const std::string& name, const char* text) {
    return set_attribute(object, name, std::string(text));
  }
  Result<void> set_attribute(const std::string& object, const std::string& name, double value);
  Result<void> set_attribute(const std::string& object, const std::string& name, std::int64_t value);
  Result<void> set_attribute(const std::string& object, const std::string& name, std::span<const double> values);
  Result<void> set_attribute(const std::string& object, const std::string& name, std::span<const std::string> texts);

  /// Closes the file and puts it in its place. Nothing may be written afterwards.
  Result<void> commit();

 private:
  explicit Hdf5Writer(AtomicFile file) : file_(std::move(file)) {}
  Result<void> write_slab_bytes(const std::string& path, std::uint64_t first, ScalarType type,
                                std::span<const std::byte> bytes);
  Result<void> write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                               std::int64_t count, const void* values);
  void close() noexcept;

  AtomicFile file_;
  std::int64_t id_ = -1;
  std::map<std::string, std::int64_t> datasets_;  ///< open until close()
};

}  // namespace dubsar
