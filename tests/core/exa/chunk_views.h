#pragma once
// Coded chunks as their readers take them.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar {

inline std::vector<std::string_view> views_of(const std::vector<std::string>& chunks) {
  return {chunks.begin(), chunks.end()};
}

inline std::size_t bytes_of(const std::vector<std::string>& chunks) {
  std::size_t bytes = 0;
  for (const std::string& chunk : chunks) bytes += chunk.size();
  return bytes;
}

}  // namespace dubsar
