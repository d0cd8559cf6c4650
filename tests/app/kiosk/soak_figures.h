#pragma once
// What a long run says of itself: memory over time, recoveries, the longest picture.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/base/numbers/measurements.h"

namespace dubsar::app::test {

/// Memory of this process now, MiB (resident, of Linux).
double resident_mib();

struct MemoryAt {
  double hours, mib;
};
/// Slope of the straight line with the least squares, MiB an hour; 0 for fewer than two times.
double slope_mib_per_h(const std::vector<MemoryAt>& samples);
/// The same without the first quarter, in which caches and pools fill.
double settled_slope_mib_per_h(const std::vector<MemoryAt>& samples);

struct Limits {
  double slope_mib_per_h = 1.0, picture_ms = 250.0, recovery_s = 5.0, hand_ms = 100.0;
};

struct SoakFigures {
  std::vector<MemoryAt> memory;
  std::map<std::string, std::vector<double>> recovery_s;  ///< by the kind of fault, each from its end
  int never_back = 0;                                     ///< faults after which nothing came back before the next one
  int restarts = 0;                                       ///< by a service manager that heard nothing for too long
  double silence_s = 0.0;                                 ///< the longest time in which it heard nothing
  std::int64_t pictures = 0, gl_errors = 0, visits = 0;
  Measurements hand_ms{};   ///< from a hand's first measurement to the presentation of the picture with its ring
  double longest_ms = 0.0;  ///< of a picture after the first, from its beginning to its presentation
};
/// What is printed, and whether all limits hold. `drawn`: pictures were.
std::string describe(const SoakFigures& figures, bool drawn, const Limits& limits = {});
bool holds(const SoakFigures& figures, bool drawn, const Limits& limits = {});

}  // namespace dubsar::app::test
