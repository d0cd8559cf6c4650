#pragma once
// The ramp of filtered backprojection, on views whose columns are contiguous.

#include <span>
#include <vector>

#include "core/phantom/scanner/columns.h"
#include "core/phantom/scanner/scanner_options.h"

namespace dubsar::phantom {

class RampFilter {
 public:
  /// For views of `columns` pixels that are `pitch_mm` wide.
  RampFilter(std::int64_t columns, double pitch_mm, Window window);

  /// Twice as many: at every half pixel, the last one beyond the last pixel.
  std::int64_t columns_out() const noexcept { return 2 * columns_; }

  /// `view` and `out`: columns of `stride` floats, a multiple of 16; those of `out` at every half pixel. One thread
  /// each; needs 64 times the padded width of floats.
  void apply(const float* view, std::int64_t stride, float* out) const;

 private:
  std::int64_t columns_, length_;
  std::vector<float> cosine_, sine_, cosine2_, sine2_;  ///< of the padded width, and of twice that
  std::vector<float> gain_;                             ///< by frequency, 0 to length / 2
  std::vector<std::int64_t> from_, to_;                 ///< bit-reversed places of a frequency in both transforms
};

}  // namespace dubsar::phantom
