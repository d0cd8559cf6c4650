#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace dubsar {

/// Bytes of a message seen as text, without a copy.
inline std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace dubsar
