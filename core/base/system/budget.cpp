#include "core/base/system/budget.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>

#include "core/base/numbers/units.h"
#include "core/base/system/large_blocks.h"
#include "core/base/system/memory_left.h"

namespace dubsar {
namespace {
__extension__ using Uint128 = unsigned __int128;

std::atomic<std::uint64_t> g_limit{0};  // 0: none

/// Of this process, now.
std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

std::uint64_t available_memory_bytes() {
  const std::uint64_t left = memory_left({}), limit = g_limit;
  if (limit == 0) return left + std::min(spare_heap_bytes(), std::numeric_limits<std::uint64_t>::max() - left);
  const std::uint64_t used = resident_bytes();
  return std::min(left, limit - std::min(limit, used));
}

void set_memory_limit(std::uint64_t bytes) noexcept { g_limit = bytes; }

std::uint64_t memory_limit() noexcept { return g_limit; }

void keep_below_limit() noexcept {
  if (memory_limit() > 0) return_free_memory();
}

std::uint64_t Budget::limit_bytes() const {
  return memory_bytes > 0 ? memory_bytes : available_memory_bytes() / 10 * 8;
}

Result<std::int64_t> check_dims(std::string_view what, std::span<const std::uint64_t> dims, std::uint64_t element_bytes,
                                const Budget& budget) {
  Uint128 product = 1;
  for (const std::uint64_t dim : dims) {
    if (dim == 0) return fail(ErrorKind::kBadData, "{}: one dimension is 0, expected at least 1", what);
    if (dim > budget.max_dimension)
      return fail(ErrorKind::kBadData, "{}: dimension {} found, expected at most {}", what, dim, budget.max_dimension);
    product *= dim;
    if (product > budget.max_voxels)
      return fail(ErrorKind::kBadData, "{}: more than 2^36 elements announced, expected at most {}", what,
                  budget.max_voxels);
  }
  if (product * element_bytes > static_cast<Uint128>(std::numeric_limits<std::int64_t>::max()))
    return fail(ErrorKind::kBadData, "{}: the size in bytes does not fit 63 bits", what);
  return static_cast<std::int64_t>(product);
}

Result<void> check_count(std::string_view what, std::uint64_t count, std::uint64_t item_bytes,
                         std::uint64_t bytes_left) {
  if (static_cast<Uint128>(count) * item_bytes > bytes_left)
    return fail(ErrorKind::kBadData, "{}: {} items of {} bytes announced, but only {} bytes are left in the file", what,
                count, item_bytes, bytes_left);
  return {};
}

Result<void> check_memory(std::string_view what, std::uint64_t bytes, const Budget& budget) {
  const std::uint64_t limit = budget.limit_bytes();
  if (bytes > limit)
    return fail(ErrorKind::kTryAgain, "{}: {:.0f} MiB of memory needed, {:.0f} MiB allowed", what, mib_of(bytes),
                mib_of(limit));
  return {};
}

}  // namespace dubsar
