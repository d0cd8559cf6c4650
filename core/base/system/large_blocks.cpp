#include "core/base/system/large_blocks.h"

#include <malloc.h>

#include <limits>

namespace dubsar {

void keep_large_blocks() noexcept {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

void return_large_blocks() noexcept {
  constexpr int kLargeBytes = 1 << 20, kSpareBytes = 16 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);
  mallopt(M_TRIM_THRESHOLD, kSpareBytes);
}

}  // namespace dubsar
