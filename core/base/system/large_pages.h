#pragma once
// Large arrays on large pages: filling one costs the system a fault for 2 MiB instead of one for 4 KiB.

#include <cstddef>

namespace dubsar {

/// Asks the system for large pages behind the memory [begin, begin + bytes) that was not used yet; no error where it
/// has none. Small blocks stay as they are.
void ask_for_large_pages(void* begin, std::size_t bytes) noexcept;

/// An empty vector becomes one of `size` items on large pages.
template <class Vector>
void resize_large(Vector& items, std::size_t size) {
  items.reserve(size);
  ask_for_large_pages(items.data(), size * sizeof(items[0]));
  items.resize(size);
}

/// A vector of `size` items on large pages.
template <class Vector>
Vector large_array(std::size_t size) {
  Vector items;
  resize_large(items, size);
  return items;
}

}  // namespace dubsar
