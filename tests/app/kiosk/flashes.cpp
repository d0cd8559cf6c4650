#include "tests/app/kiosk/flashes.h"

#include <algorithm>

#include "display/optics/srgb.h"

namespace dubsar::app::test {
namespace {

constexpr int kSide = 8;
constexpr double kChange = 0.1, kBright = 0.8, kWindow_s = 1.0;

double luminance(const Image& picture, int left, int top) {
  double sum = 0.0;
  for (int y = top; y < top + kSide; ++y)
    for (int x = left; x < left + kSide; ++x) {
      const std::uint8_t* const p = picture.at(x, y);
      sum += 0.2126 * linear_from_srgb(p[0]) + 0.7152 * linear_from_srgb(p[1]) + 0.0722 * linear_from_srgb(p[2]);
    }
  return sum / (kSide * kSide);
}

}  // namespace

void Flashes::add(double time_s, const Image& picture) {
  const int columns = picture.width / kSide, rows = picture.height / kSide;
  blocks_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<int> counts;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    Block& block = blocks_[i];
    const double now =
        luminance(picture, kSide * (static_cast<int>(i) % columns), kSide * (static_cast<int>(i) / columns));
    if (block.turn < 0) block.turn = now;
    const double change = now - block.turn;
    const int way = change > 0 ? 1 : -1;
    if (way == block.way) {
      block.turn = now;  // it goes on
    } else if (std::abs(change) >= kChange && std::min(now, block.turn) < kBright) {
      if (block.way != 0) block.changes_s.push_back(time_s);
      block.way = way;
      block.turn = now;
    }
    while (!block.changes_s.empty() && time_s - block.changes_s.front() > kWindow_s) block.changes_s.pop_front();
    counts.push_back(static_cast<int>(block.changes_s.size() + 1) / 2);
  }
  std::sort(counts.begin(), counts.end(), std::greater<>());
  if (counts.empty()) return;
  most_in_a_block_ = std::max(most_in_a_block_, counts.front());
  most_in_a_quarter_ = std::max(most_in_a_quarter_, counts[counts.size() / 4]);
}

}  // namespace dubsar::app::test
