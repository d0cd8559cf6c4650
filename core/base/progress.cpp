#include "core/base/progress.h"

namespace dubsar {

tl::unexpected<Error> cancelled_error() {
  return fail(ErrorKind::kCancelled, "cancelled: nothing was written, earlier outputs are as they were");
}

double estimate_remaining_s(std::int64_t done, std::int64_t total, double elapsed_s) noexcept {
  if (total <= 0 || done <= 0) return -1.0;
  const double fraction = static_cast<double>(done) / static_cast<double>(total);
  if (fraction < 0.05 && elapsed_s < 3.0) return -1.0;
  return fraction >= 1.0 ? 0.0 : elapsed_s * (1.0 - fraction) / fraction;
}

}  // namespace dubsar
