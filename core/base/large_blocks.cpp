#include "core/base/large_blocks.h"

#include <malloc.h>

namespace dubsar {

void return_large_blocks() noexcept {
  constexpr int kLargeBytes = 256 * 1024;
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);
}

}  // namespace dubsar
