#pragma once
// The values of a PLY body, one after the other.

#include <string_view>

#include "core/base/numbers/bytes.h"
#include "core/mesh_io/ply_header.h"
#include "core/mesh_io/text_scanner.h"

namespace dubsar {

/// Values of a binary body; every type fits a double exactly.
template <bool kBigEndian>
class BinaryValues {
 public:
  explicit BinaryValues(std::string_view body) : reader_(body) {}
  static std::size_t least_bytes(PlyScalar type) noexcept { return ply_scalar_bytes(type); }
  double next(PlyScalar type) noexcept {
    switch (type) {
      case PlyScalar::kI8:
        return get<std::int8_t>();
      case PlyScalar::kU8:
        return get<std::uint8_t>();
      case PlyScalar::kI16:
        return get<std::int16_t>();
      case PlyScalar::kU16:
        return get<std::uint16_t>();
      case PlyScalar::kI32:
        return get<std::int32_t>();
      case PlyScalar::kU32:
        return get<std::uint32_t>();
      case PlyScalar::kF32:
        return static_cast<double>(get<float>());
      case PlyScalar::kF64:
        break;
    }
    return get<double>();
  }
  void skip(PlyScalar type, std::uint64_t count) noexcept { reader_.take(count * ply_scalar_bytes(type)); }
  std::uint64_t left() const noexcept { return reader_.left(); }
  bool ok() const noexcept { return reader_.ok(); }

 private:
  template <class T>
  T get() noexcept {
    return kBigEndian ? reader_.big<T>() : reader_.little<T>();
  }
  ByteReader reader_;
};

class AsciiValues {
 public:
  explicit AsciiValues(std::string_view body) : scanner_(body) {}
  static std::size_t least_bytes(PlyScalar) noexcept { return 1; }
  double next(PlyScalar) noexcept {
    double value = 0.0;
    if (!scanner_.number(value)) ok_ = false;
    return value;
  }
  void skip(PlyScalar type, std::uint64_t count) noexcept {
    for (std::uint64_t i = 0; i < count && ok_; ++i) next(type);
  }
  std::uint64_t left() const noexcept { return scanner_.rest().size(); }
  bool ok() const noexcept { return ok_; }

 private:
  TextScanner scanner_;
  bool ok_ = true;
};

}  // namespace dubsar
