#include "core/base/numbers/measurements.h"

#include <algorithm>

#include "core/base/numbers/quantile.h"

namespace dubsar {

void Measurements::add(double value) {
  largest_ = count_ == 0 ? value : std::max(largest_, value);
  ++count_;
  if (kept_.size() < kMost) {
    kept_.push_back(value);
    return;
  }
  const std::size_t place = std::uniform_int_distribution<std::size_t>(0, count_ - 1)(random_);
  if (place < kMost) kept_[place] = value;
}

double Measurements::quantile(double p) const { return p >= 1.0 ? largest_ : dubsar::quantile(kept_, p); }

}  // namespace dubsar
