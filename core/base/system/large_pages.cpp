#include "core/base/system/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace dubsar {

void ask_for_large_pages(void* begin, std::size_t bytes) noexcept {
  constexpr std::uintptr_t kPage = 4096, kLargePage = std::uintptr_t{2} << 20;
  if (bytes < 2 * kLargePage) return;
  const std::size_t before_page = (kPage - reinterpret_cast<std::uintptr_t>(begin) % kPage) % kPage;
  const std::size_t pages = (bytes - before_page) / kPage * kPage;
  (void)::madvise(static_cast<char*>(begin) + before_page, pages, MADV_HUGEPAGE);  // a wish
}

}  // namespace dubsar
