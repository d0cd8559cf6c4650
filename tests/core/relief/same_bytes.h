#pragma once
// Lists of numbers that are equal to the last bit.

#include <cstring>
#include <vector>

namespace dubsar::test {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace dubsar::test
