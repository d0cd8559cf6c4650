#include "core/base/system/large_blocks.h"

#include <malloc.h>

namespace dubsar {

void keep_large_blocks() noexcept {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);  // never; the largest number would be 2 GiB
}

std::uint64_t spare_heap_bytes() noexcept { return mallinfo2().keepcost; }

void share_heaps() noexcept {
  mallopt(M_ARENA_MAX, 2);
  return_large_blocks();
}

void return_free_memory() noexcept { malloc_trim(0); }

void return_large_blocks() noexcept {
  constexpr int kLargeBytes = 1 << 20, kSpareBytes = 16 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);
  mallopt(M_TRIM_THRESHOLD, kSpareBytes);
}

}  // namespace dubsar
