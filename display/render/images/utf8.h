#pragma once
// Unicode code points as text and back.

#include <string>
#include <string_view>
#include <vector>

namespace dubsar {

inline std::string utf8(unsigned code) {
  std::string out;
  const auto put = [&](unsigned byte) { out += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | code >> 6);
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
    put(0x80 | (code & 0x3F));
  }
  return out;
}

/// Code points of a text; bytes that are no UTF-8 are 0xfffd, one each.
inline std::vector<unsigned> code_points(std::string_view text) {
  std::vector<unsigned> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u; };
    const unsigned first = byte(i);
    const std::size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
    unsigned code = length == 1 ? first : length == 0 ? 0u : first & (0x7fu >> length);
    bool good = length > 0;
    for (std::size_t k = 1; k < length && good; ++k) {
      good = byte(i + k) >> 6 == 2;
      code = code << 6 | (byte(i + k) & 0x3fu);
    }
    out.push_back(good ? code : 0xfffdu);
    i += good ? length : 1;
  }
  return out;
}

}  // namespace dubsar
