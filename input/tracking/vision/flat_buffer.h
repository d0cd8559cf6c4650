#pragma once
// Reading FlatBuffers (flatbuffers.dev, "internals") that nobody has checked.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace dubsar {

/// Borrowed bytes. Whatever lies outside of them reads as zero and makes ok() false for good; counts of
/// vectors are limited by the bytes that are there, so that loops over them end.
class FlatBuffer {
 public:
  explicit FlatBuffer(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}
  bool ok() const noexcept { return ok_; }

  struct Table {
    std::uint64_t at = 0, vtable = 0;
    std::uint32_t vtable_bytes = 0;  ///< 0: no such table, all its fields are missing
  };
  struct Vector {
    std::uint64_t at = 0;  ///< of the first element
    std::uint32_t count = 0;
  };

  Table root() { return table_at(number<std::uint32_t>(0)); }

  /// A scalar field, or what its absence means.
  template <class T>
  T value(const Table& table, int field, T absent) {
    const std::uint64_t at = field_at(table, field);
    return at == 0 ? absent : number<T>(at);
  }
  Table table(const Table& parent, int field) {
    const std::uint64_t at = field_at(parent, field);
    return at == 0 ? Table{} : table_at(at + number<std::uint32_t>(at));
  }
  Vector vector(const Table& parent, int field, std::size_t element_bytes) {
    const std::uint64_t at = field_at(parent, field);
    if (at == 0) return {};
    const std::uint64_t start = at + number<std::uint32_t>(at);
    const std::uint64_t count = number<std::uint32_t>(start);
    if (!inside(start, 4) || count * element_bytes > bytes_.size() - start - 4) {
      ok_ = false;
      return {};
    }
    return {start + 4, static_cast<std::uint32_t>(count)};
  }
  template <class T>
  T element(const Vector& vector, std::uint32_t i) {
    return number<T>(vector.at + std::uint64_t{i} * sizeof(T));
  }
  Table element_table(const Vector& vector, std::uint32_t i) {
    const std::uint64_t at = vector.at + std::uint64_t{i} * 4;
    return table_at(at + number<std::uint32_t>(at));
  }
  std::span<const std::byte> bytes_of(const Vector& vector) const noexcept {
    return bytes_.subspan(static_cast<std::size_t>(vector.at), vector.count);  // vector() has checked it
  }

 private:
  bool inside(std::uint64_t at, std::uint64_t count) const noexcept {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }
  template <class T>
  T number(std::uint64_t at) {
    T value{};
    if (inside(at, sizeof(T)))
      std::memcpy(&value, bytes_.data() + at, sizeof(T));
    else
      ok_ = false;
    return value;
  }
  Table table_at(std::uint64_t at) {
    const std::int64_t back = number<std::int32_t>(at);
    const std::int64_t vtable = static_cast<std::int64_t>(at) - back;
    if (!ok_ || vtable < 0) {
      ok_ = false;
      return {};
    }
    Table table{at, static_cast<std::uint64_t>(vtable), number<std::uint16_t>(static_cast<std::uint64_t>(vtable))};
    if (table.vtable_bytes < 4 || !inside(table.vtable, table.vtable_bytes)) {
      ok_ = false;
      return {};
    }
    return table;
  }
  std::uint64_t field_at(const Table& table, int field) {
    const std::uint64_t slot = 4 + 2 * static_cast<std::uint64_t>(field);
    if (slot + 2 > table.vtable_bytes) return 0;
    const std::uint16_t offset = number<std::uint16_t>(table.vtable + slot);
    return offset == 0 ? 0 : table.at + offset;
  }

  std::span<const std::byte> bytes_;
  bool ok_ = true;
};

}  // namespace dubsar
