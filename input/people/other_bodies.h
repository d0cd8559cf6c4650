#pragma once
// Where those stand who are not kept, as far as their hands tell.

#include <vector>

#include "core/base/system/clock.h"

namespace dubsar {

/// One thread; rising times (a clock that was set back forgets them).
class OtherBodies {
 public:
  /// A hand tells of a body `x_m` to the right of the panel's middle.
  void see(TimestampNs now, double x_m);
  /// Whether hands told for 0.3 s or more, in the last 20 s, of a body no further from `x_m` than `within_m`.
  bool near(TimestampNs now, double x_m, double within_m) const;

 private:
  struct Body {
    double x_m = 0.0;
    TimestampNs seen = 0, for_ns = 0;
  };
  std::vector<Body> bodies_;
};

}  // namespace dubsar
