#include "tests/bench/paper/paper_words.h"

#include <algorithm>
#include <array>
#include <bit>

#include "tests/bench/paper/bit_string.h"

namespace dubsar {
namespace {
/// How many numbers of how many bits stand behind each selector of 4 bits.
struct WordForm {
  std::size_t bytes;
  std::array<std::uint8_t, 16> count, bits;
};
constexpr WordForm kForm64{8,
                           {240, 120, 60, 30, 20, 15, 12, 10, 8, 7, 6, 5, 4, 3, 2, 1},
                           {0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 20, 30, 32}};
constexpr WordForm kForm128{16,
                            {240, 124, 62, 41, 31, 24, 20, 17, 15, 13, 12, 11, 10, 8, 6, 3},
                            {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 15, 20, 32}};
const WordForm& form_of(PaperWord word) { return word == PaperWord::k64 ? kForm64 : kForm128; }
}  // namespace

std::string pack_words(std::span<const std::uint32_t> numbers, PaperWord word) {
  const WordForm& form = form_of(word);
  BitWriter out;
  while (!numbers.empty()) {
    // The first selector whose codes are long enough for all the numbers that it takes: the most in one word.
    std::size_t selector = 0, taken = 0;
    for (;; ++selector) {
      taken = std::min<std::size_t>(form.count[selector], numbers.size());
      if (std::all_of(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(taken),
                      [&](std::uint32_t n) { return std::bit_width(n) <= form.bits[selector]; }))
        break;
    }
    out.bits(selector, 4);
    for (const std::uint32_t n : numbers.first(taken)) out.bits(n, form.bits[selector]);
    out.pad_to(form.bytes);
    numbers = numbers.subspan(taken);
  }
  return out.take();
}

Result<std::vector<std::uint32_t>> unpack_words(std::string_view bytes, std::size_t count, PaperWord word,
                                                std::string_view what) {
  const WordForm& form = form_of(word);
  std::vector<std::uint32_t> numbers;
  numbers.reserve(count);
  std::size_t at = 0;
  for (; numbers.size() < count && at + form.bytes <= bytes.size(); at += form.bytes) {
    BitReader in(bytes.substr(at, form.bytes));
    const auto selector = static_cast<std::size_t>(in.bits(4));
    const std::size_t taken = std::min<std::size_t>(form.count[selector], count - numbers.size());
    for (std::size_t i = 0; i < taken; ++i) numbers.push_back(static_cast<std::uint32_t>(in.bits(form.bits[selector])));
  }
  if (numbers.size() != count || at != bytes.size())
    return fail(ErrorKind::kBadData, "exa: {} bytes hold {} {}, {} expected", bytes.size(), numbers.size(), what,
                count);
  return numbers;
}

}  // namespace dubsar
