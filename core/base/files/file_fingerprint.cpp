#include "core/base/files/file_fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/files/input_file.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPieces = 64, kPieceBytes = 4096;
constexpr std::uint64_t kFnvStart = 14695981039346656037ULL, kFnvPrime = 1099511628211ULL;

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

}  // namespace dubsar
