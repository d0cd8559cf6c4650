#pragma once
// What several threads find, in the order in which one would.

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/system/parallel.h"

namespace dubsar {

/// Calls find(begin, end, list) for ranges of [0, count) and returns all lists one after another.
template <class Item, class Find>
std::vector<Item> parallel_gather(std::int64_t count, std::int64_t grain, const Find& find) {
  using Items = std::vector<Item>;
  return parallel_reduce<Items>(
      count, grain, {},
      [&](std::int64_t begin, std::int64_t end) {
        Items part;
        find(begin, end, part);
        return part;
      },
      [](Items all, const Items& part) {
        all.insert(all.end(), part.begin(), part.end());
        return all;
      });
}

}  // namespace dubsar
