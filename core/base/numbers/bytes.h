#pragma once
// Bytes to numbers and back, with the byte order in the name and the end of the buffer in view.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace dubsar {

static_assert(std::endian::native == std::endian::little, "dubsar runs on little-endian machines");

template <class T>
T byte_swapped(T value) noexcept {
  static_assert(std::is_trivially_copyable_v<T>);
  unsigned char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Reads numbers from borrowed bytes. Reading past the end gives zeros and makes ok() false for good, so that a parser
/// checks once per record.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) noexcept : bytes_(bytes) {}

  template <class T>
  T little() noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    const std::string_view from = take(sizeof(T));
    if (!from.empty()) std::memcpy(&value, from.data(), sizeof(T));
    return value;
  }
  template <class T>
  T big() noexcept {
    return byte_swapped(little<T>());
  }
  /// The next `count` bytes; empty, and ok() false, when fewer are left.
  std::string_view take(std::size_t count) noexcept {
    if (count > left()) {
      ok_ = false;
      position_ = bytes_.size();
      return {};
    }
    const std::string_view taken = bytes_.substr(position_, count);
    position_ += count;
    return taken;
  }
  std::size_t left() const noexcept { return bytes_.size() - position_; }
  std::size_t position() const noexcept { return position_; }
  bool ok() const noexcept { return ok_; }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

/// Appends the little-endian bytes of a number.
template <class T>
void append_little(std::string& out, T value) {
  static_assert(std::is_trivially_copyable_v<T>);
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

inline std::span<const std::byte> as_bytes(std::string_view text) noexcept {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace dubsar
