#pragma once
// Datasets of an HDF5 file: what they are, and their numbers. Every call into the library holds one lock, so that all
// functions here may be called from any thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/numbers/scalar_type.h"
#include "core/base/result.h"

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

/// What stands where nothing was written.
struct Hdf5Fill {
  bool defined = false;  ///< by whoever made the dataset
  double value = 0.0;
  std::array<std::byte, 8> stored{};  ///< the same as a stored number (plain_scalar)
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
  Hdf5Fill fill;
  std::vector<Hdf5ExternalPart> external;
  std::vector<std::string> virtual_files;  ///< source files of a virtual dataset
  std::uint64_t address = 0;               ///< identity: hard links to one dataset share it

  std::uint64_t element_bytes() const noexcept {
    return scalar ? static_cast<std::uint64_t>(scalar_bytes(*scalar)) : 0;
  }
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
  /// The stored (still filtered) bytes of the chunk at `origin`, which is a multiple of the chunk size, with the mask
  /// of the filters that were skipped for it (bit i: filter i). nullopt when it was never written. kBadData when it has
  /// more than `most_bytes`. About a microsecond beside the time to read.
  Result<std::optional<std::uint32_t>> read_chunk(std::span<const std::uint64_t> origin, std::uint64_t most_bytes,
                                                  std::vector<std::byte>& out) const;

 private:
  friend class Hdf5File;
  Hdf5Dataset() = default;
  std::int64_t id_ = -1;
  bool needs_plugin_ = false;
  Hdf5DatasetInfo info_;
};

}  // namespace dubsar
