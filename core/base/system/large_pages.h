#pragma once
// Large arrays on large pages: filling one costs the system a fault for 2 MiB instead of one for 4 KiB.

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

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

/// `size` items on large pages that nobody has written yet, not even what a T has from the start: for what is filled by
/// all threads.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  LargeArray() = default;
  explicit LargeArray(std::size_t size) : items_(static_cast<T*>(::operator new(size * sizeof(T)))), size_(size) {
    ask_for_large_pages(items_.get(), size * sizeof(T));
  }
  T* data() noexcept { return items_.get(); }
  const T* data() const noexcept { return items_.get(); }
  T& operator[](std::size_t i) noexcept { return items_[i]; }
  const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  T* begin() noexcept { return items_.get(); }
  T* end() noexcept { return items_.get() + size_; }
  const T* begin() const noexcept { return items_.get(); }
  const T* end() const noexcept { return items_.get() + size_; }

 private:
  struct Free {
    void operator()(T* items) const noexcept { ::operator delete(items); }
  };
  std::unique_ptr<T[], Free> items_;
  std::size_t size_ = 0;
};

}  // namespace dubsar
