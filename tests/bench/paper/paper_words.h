#pragma once
// Small numbers in words of 64 or 128 bits, each filled with codes of one length that a selector names: Simple-8b (Anh
// and Moffat 2010) and its wider brother (paper_code.md).

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

enum class PaperWord { k64, k128 };

std::string pack_words(std::span<const std::uint32_t> numbers, PaperWord word);
/// kBadData: the bytes are not those of `count` numbers. `what` names them.
Result<std::vector<std::uint32_t>> unpack_words(std::string_view bytes, std::size_t count, PaperWord word,
                                                std::string_view what);

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
constexpr std::uint32_t folded(std::int32_t v) {
  return (static_cast<std::uint32_t>(v) << 1) ^ static_cast<std::uint32_t>(v >> 31);
}
constexpr std::int32_t unfolded(std::uint32_t v) {
  return static_cast<std::int32_t>(v >> 1) ^ -static_cast<std::int32_t>(v & 1);
}

}  // namespace dubsar
