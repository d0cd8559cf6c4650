#pragma once
// HDF5 files that appear whole or not at all. One thread.

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/files/atomic_file.h"
#include "core/base/numbers/scalar_type.h"
#include "core/base/result.h"

namespace dubsar {

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
/// no time stamps are stored. Groups on the way to a path are created. After the first error (kIo: disk full) every
/// further call fails, and the library keeps its few buffers until the program ends. Whole layers of compressed chunks
/// of three-dimensional datasets are compressed by all threads.
class Hdf5Writer {
 public:
  /// kCannotCreate, kPermission, kIo.
  static Result<Hdf5Writer> create(const std::filesystem::path& path);

  Hdf5Writer(Hdf5Writer&& other) noexcept;
  Hdf5Writer& operator=(Hdf5Writer&&) = delete;
  ~Hdf5Writer();

  Result<void> create_dataset(const std::string& path, const Hdf5Storage& storage);

  /// Writes entries [first, first + count) of the slowest axis: all bytes of count * dims[1] * dims[2] ... numbers.
  template <class T>
  Result<void> write_slab(const std::string& path, std::uint64_t first, std::span<const T> values) {
    return write_slab_bytes(path, first, scalar_type_of<T>(), std::as_bytes(values));
  }

  /// One chunk as encode_chunk() of the same coding made it (chunk_encoder.h), at a multiple of the size of chunks.
  Result<void> write_encoded_chunk(const std::string& path, std::span<const std::uint64_t> origin,
                                   std::span<const std::byte> stored);

  /// A dataset in one call.
  template <class T>
  Result<void> write(const std::string& path, const Hdf5Storage& storage, std::span<const T> values) {
    DUBSAR_TRY(create_dataset(path, storage));
    return write_slab<T>(path, 0, values);
  }

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
  struct Dataset {
    std::int64_t id = -1;
    Hdf5Storage storage;
  };
  /// Whole layers of chunks, compressed by us.
  Result<void> write_layers(const Dataset& dataset, const std::string& path, std::uint64_t first,
                            std::span<const std::byte> bytes);
  Result<void> write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                               std::int64_t count, const void* values);
  tl::unexpected<Error> give_up(const std::string& what);
  bool flush_and_close() noexcept;
  void abandon() noexcept;

  AtomicFile file_;
  std::int64_t id_ = -1;
  std::map<std::string, Dataset> datasets_;  ///< open until close()
};

}  // namespace dubsar
