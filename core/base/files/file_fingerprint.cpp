#include "core/base/files/file_fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "core/base/files/input_file.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPieces = 64, kPieceBytes = 4096;
constexpr std::uint64_t kFnvStart = 14695981039346656037ULL, kFnvPrime = 1099511628211ULL;

/// FNV-1a by words of 8 bytes, the last one filled with zeros; the upper half of a product goes into the lower one.
/// Pieces but the last are of a multiple of 8 bytes.
class WordHash {
 public:
  void add(const std::byte* bytes, std::size_t count) {
    count_ += count;
    for (; count > 0; bytes += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      const std::size_t now = std::min(count, sizeof(word));
      std::memcpy(&word, bytes, now);
      hash_ = (hash_ ^ word) * kFnvPrime;
      hash_ ^= hash_ >> 32;
      count -= now;
    }
  }
  std::string text() const { return fmt::format("{}-{:016x}", count_, hash_); }

 private:
  std::uint64_t hash_ = kFnvStart;
  std::size_t count_ = 0;
};

}  // namespace

Result<std::string> file_fingerprint(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(path));
  std::uint64_t hash = kFnvStart;
  std::array<std::byte, kPieceBytes> piece{};
  const std::int64_t last = std::max<std::int64_t>(0, file.size() - kPieceBytes);
  for (std::int64_t i = 0; i < kPieces; ++i) {
    const std::int64_t at = last / (kPieces - 1) * i + last % (kPieces - 1) * i / (kPieces - 1);
    const auto bytes = std::span(piece).first(static_cast<std::size_t>(std::min(kPieceBytes, file.size() - at)));
    DUBSAR_TRY(file.read_at(at, bytes));
    for (const std::byte b : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(b)) * kFnvPrime;
    if (last == 0) break;
  }
  return fmt::format("{}-{:016x}", file.size(), hash);
}

Result<std::string> file_checksum(const std::filesystem::path& path) {
  constexpr std::int64_t kAtOnce = 1 << 20;
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(path));
  std::vector<std::byte> piece(static_cast<std::size_t>(std::min(kAtOnce, file.size())));
  WordHash hash;
  for (std::int64_t at = 0; at < file.size(); at += kAtOnce) {
    const auto bytes = std::span(piece).first(static_cast<std::size_t>(std::min(kAtOnce, file.size() - at)));
    DUBSAR_TRY(file.read_at(at, bytes));
    hash.add(bytes.data(), bytes.size());
  }
  return hash.text();
}

std::string bytes_checksum(std::string_view bytes) {
  WordHash hash;
  const auto all = std::as_bytes(std::span(bytes.data(), bytes.size()));
  hash.add(all.data(), all.size());
  return hash.text();
}

}  // namespace dubsar
