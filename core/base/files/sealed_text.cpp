#include "core/base/files/sealed_text.h"

#include <algorithm>
#include <cctype>

#include "core/base/files/file_fingerprint.h"

namespace dubsar {
namespace {

constexpr std::string_view kSealBegins = "sum_";
constexpr std::size_t kSealReach = 4096;

std::string seal_of(std::string_view unsealed) {
  const std::string sum = bytes_checksum(unsealed);  // bytes-hash
  return std::string(kSealBegins) + sum.substr(sum.rfind('-') + 1);
}

/// Where the first seal, or place for one, begins.
std::size_t find_seal(std::string_view text) {
  for (std::size_t at = text.find(kSealBegins); at < std::min(text.size(), kSealReach);
       at = text.find(kSealBegins, at + 1)) {
    const std::string_view digits = text.substr(at, kUnsealed.size()).substr(kSealBegins.size());
    if (digits.size() + kSealBegins.size() == kUnsealed.size() &&
        std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isxdigit(c) != 0; }))
      return at;
  }
  return std::string_view::npos;
}

}  // namespace

std::string sealed_text(std::string text) {
  const std::size_t at = find_seal(text);
  if (at == std::string::npos || text.compare(at, kUnsealed.size(), kUnsealed) != 0) return text;
  text.replace(at, kUnsealed.size(), seal_of(text));
  return text;
}

bool is_sealed_text(std::string_view text) {
  const std::size_t at = find_seal(text);
  if (at == std::string_view::npos) return false;
  std::string unsealed(text);
  unsealed.replace(at, kUnsealed.size(), kUnsealed);
  return text.substr(at, kUnsealed.size()) == seal_of(unsealed);
}

}  // namespace dubsar
