#include "core/base/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace dubsar {

void ask_for_large_pages(void* begin, std::size_t bytes) noexcept {
  constexpr std::uintptr_t kPage = 4096, kLargePage = std::uintptr_t{2} << 20;
  const auto from = (reinterpret_cast<std::uintptr_t>(begin) + kPage - 1) / kPage * kPage;
  const auto to = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / kPage * kPage;
  if (bytes < 2 * kLargePage || to <= from) return;
  (void)::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);  // a wish
}

}  // namespace dubsar
