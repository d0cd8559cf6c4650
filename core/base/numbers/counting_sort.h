#pragma once
// Sorting by small whole numbers, such as the ids of vertices.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dubsar {

/// Stable; `key` of each item lies below `keys`. O(items + keys), 4 bytes a key and the items once more.
template <class Item, class Key>
void counting_sort(std::vector<Item>& items, std::size_t keys, const Key& key) {
  std::vector<std::uint32_t> place(keys + 1, 0);
  for (const Item& item : items) ++place[key(item) + std::size_t{1}];
  for (std::size_t k = 1; k < place.size(); ++k) place[k] += place[k - 1];
  std::vector<Item> sorted(items.size());
  for (const Item& item : items) sorted[place[key(item)]++] = item;
  items.swap(sorted);
}

}  // namespace dubsar
