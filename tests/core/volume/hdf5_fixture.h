#pragma once
// HDF5 files of other programs, made with the C library and not with our own writer: an independent oracle, and the
// source of everything our writer refuses to make.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/numbers/scalar_type.h"

namespace dubsar::testing_tools {

using Shape = std::vector<std::uint64_t>;

struct Packing {
  Shape chunk = {};  ///< empty: contiguous
  int deflate = 0;
  bool shuffle = false;
  bool fletcher32 = false;
  bool nbit = false;
  bool compact = false;
  int foreign_filter = 0;  ///< an id under which a dummy filter writes (32000: LZF literals), unknown to readers
};

/// Closed by the destructor. Values pass through the library's conversion from double.
class Hdf5Fixture {
 public:
  explicit Hdf5Fixture(const std::filesystem::path& path, std::uint64_t user_block = 0);
  Hdf5Fixture(const Hdf5Fixture&) = delete;
  Hdf5Fixture& operator=(const Hdf5Fixture&) = delete;
  ~Hdf5Fixture();

  void group(const std::string& path);
  void array(const std::string& path, ScalarType type, ByteOrder order, const Shape& shape,
             const std::vector<double>& values, const Packing& packing = {});
  void array(const std::string& path, const Shape& shape, const std::vector<double>& values) {
    array(path, ScalarType::kF32, ByteOrder::kLittle, shape, values);
  }
  /// 12 significant bits in 16: no plain number type.
  void twelve_bits(const std::string& path, const Shape& shape, const std::vector<double>& values);
  void unwritten(const std::string& path, const Shape& shape, const Shape& chunk);
  /// Only the first `written` entries of the slowest axis exist.
  void half_written(const std::string& path, const Shape& shape, const Shape& chunk, std::uint64_t written);
  void compound(const std::string& path, const Shape& shape);
  void strings(const std::string& path, const Shape& shape);
  void text(const std::string& path, const std::string& text);
  void external_storage(const std::string& path, const Shape& shape, const std::string& file, std::int64_t offset);
  void virtual_dataset(const std::string& path, const Shape& shape, const std::string& file, const std::string& source);
  void external_link(const std::string& path, const std::string& file, const std::string& target);
  void soft_link(const std::string& path, const std::string& target);
  void hard_link(const std::string& path, const std::string& target);
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, const std::vector<double>& values);
  /// Variable-length strings, as h5py writes them.
  void attribute(const std::string& object, const std::string& name, const std::vector<std::string>& texts);

  void integers(const std::string& object, const std::string& name, const std::vector<int>& values);
  /// A text as an array of single characters, as Imaris writes them.
  void characters(const std::string& object, const std::string& name, const std::string& text);
  /// Makes `scale` the coordinates of one axis of a dataset (CLASS, NAME and REFERENCE_LIST).
  void dimension_scale(const std::string& scale, const std::string& dataset, int axis);

 private:
  std::int64_t id_ = -1;
  std::vector<int> filters_;
};

}  // namespace dubsar::testing_tools
