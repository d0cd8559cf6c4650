// Does one wrong thing that a sanitizer has to find; with "nothing" it ends with 3.

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <vector>

namespace {
struct Last {
  ~Last() { std::puts("the last object is gone"); }
} last;
}  // namespace

int main(int count, char** arguments) {
  const std::string_view what = count > 1 ? arguments[1] : "nothing";
  std::vector<int> values(8, count);
  volatile int sum = std::numeric_limits<int>::max() - 1;
  if (what == "overrun") sum = values.data()[values.size() + static_cast<std::size_t>(count)];
  if (what == "overflow") sum = sum + count;
  if (what == "leak") {
    void* volatile lost = std::malloc(77);
    lost = nullptr;
    static_cast<void>(lost);
  }
  std::printf("a line without an end");
  return 3;
}
