#pragma once
// Measured values of a run that may last for days.

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace dubsar {

/// Counts all values and keeps at most kMost of them: all until then, afterwards a sample in which each value is with
/// the same chance, the same in every run. One thread.
class Measurements {
 public:
  static constexpr std::size_t kMost = 16'384;
  void add(double value);
  /// Of all that were added, kept or not.
  std::size_t size() const noexcept { return count_; }
  bool empty() const noexcept { return count_ == 0; }
  /// The value below or at which a share p, 0..1, of those kept are (by rank); that of p = 1 is the largest of all. 0
  /// of none.
  double quantile(double p) const;
  std::size_t kept() const noexcept { return kept_.size(); }

 private:
  std::size_t count_ = 0;
  double largest_ = 0.0;
  std::vector<double> kept_;
  std::minstd_rand random_;
};

}  // namespace dubsar
