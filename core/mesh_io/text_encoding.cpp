#include "core/mesh_io/text_encoding.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

namespace dubsar {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
constexpr std::string_view kUtf32Little("\xFF\xFE\0\0", 4), kUtf32Big("\0\0\xFE\xFF", 4);
constexpr std::size_t kLooked = 64;  // bytes at the beginning

void append_utf8(std::string& out, std::uint32_t code) {
  const auto byte = [&](std::uint32_t value) { out.push_back(static_cast<char>(value)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0 | code >> 6);
  } else {
    if (code < 0x10000) {
      byte(0xE0 | code >> 12);
    } else {
      byte(0xF0 | code >> 18);
      byte(0x80 | (code >> 12 & 0x3F));
    }
    byte(0x80 | (code >> 6 & 0x3F));
  }
  byte(0x80 | (code & 0x3F));
}

std::string from_utf16(std::string_view bytes, bool big) {
  std::string out;
  out.reserve(bytes.size() / 2);
  const auto unit = [&](std::size_t at) {
    const auto a = static_cast<std::uint8_t>(bytes[at]), b = static_cast<std::uint8_t>(bytes[at + 1]);
    return static_cast<std::uint32_t>(big ? a << 8 | b : b << 8 | a);
  };
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    if (code >= 0xD800 && code < 0xE000) {
      const std::uint32_t low = code < 0xDC00 && at + 3 < bytes.size() ? unit(at + 2) : 0;
      if (low >= 0xDC00 && low < 0xE000) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        at += 2;
      } else {
        code = 0xFFFD;
      }
    }
    append_utf8(out, code);
  }
  return out;
}

std::string from_utf32(std::string_view bytes, bool big) {
  std::string out;
  out.reserve(bytes.size() / 4);
  for (std::size_t at = 0; at + 3 < bytes.size(); at += 4) {
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < 4; ++i) code = code << 8 | static_cast<std::uint8_t>(bytes[at + (big ? i : 3 - i)]);
    append_utf8(out, code > 0x10FFFF || (code >= 0xD800 && code < 0xE000) ? 0xFFFD : code);
  }
  return out;
}

/// Text of one-byte letters, each with a 0 behind it (or before it).
bool every_other_zero(std::string_view bytes, std::size_t first) {
  if (bytes.size() < 8 || bytes.size() % 2 != 0) return false;
  const std::size_t end = std::min(bytes.size(), kLooked);
  for (std::size_t i = 0; i < end; ++i)
    if ((bytes[i] == '\0') != (i % 2 == first)) return false;
  return true;
}

}  // namespace

std::string utf8_bytes(std::string bytes) {
  const std::string_view all(bytes);
  if (all.starts_with(kUtf8Mark)) return bytes.substr(kUtf8Mark.size());
  if (all.starts_with(kUtf32Little)) return from_utf32(all.substr(4), false);
  if (all.starts_with(kUtf32Big)) return from_utf32(all.substr(4), true);
  if (all.starts_with("\xFF\xFE")) return from_utf16(all.substr(2), false);
  if (all.starts_with("\xFE\xFF")) return from_utf16(all.substr(2), true);
  if (every_other_zero(all, 1)) return from_utf16(all, false);
  if (every_other_zero(all, 0)) return from_utf16(all, true);
  return bytes;
}

bool is_web_page(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || bytes[first] != '<') return false;
  std::string begin(bytes.substr(first, kLooked));
  std::transform(begin.begin(), begin.end(), begin.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view mark :
       {"<!doctype", "<html", "<head", "<body", "<?xml", "<!--", "<script", "<svg", "<meta"})
    if (begin.starts_with(mark)) return true;
  return false;
}

}  // namespace dubsar
