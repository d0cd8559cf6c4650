#include "core/script/line_cuts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace dubsar {
namespace {

constexpr double kCutBin = 0.1;                        // of a head's width
constexpr double kCutClimb = 5.0;                      // degrees
constexpr double kLeastPitch = 2.0, kMostPitch = 8.0;  // widths between lines
constexpr double kPitchNearly = 0.93;  // as clear as the best: the smaller distance is the one, multiples repeat too
constexpr double kCutMove = 0.3;       // of a distance, how far a cut moves

/// How much is written at each height of a side.
struct Profile {
  double low = 0.0, bin = 1.0;
  std::vector<double> sums;
  int bin_of(double v) const {
    return std::clamp(static_cast<int>((v - low) / bin), 0, static_cast<int>(sums.size()) - 1);
  }
};

Profile profile_of(const std::vector<TextBody>& bodies, double slope, double width) {
  Profile p;
  p.bin = kCutBin * width;
  double high = -1e30;
  p.low = 1e30;
  for (const TextBody& b : bodies) {
    p.low = std::min(p.low, b.low - slope * b.along);
    high = std::max(high, b.high - slope * b.along);
  }
  p.low -= width;
  p.sums.assign(static_cast<std::size_t>((high + width - p.low) / p.bin) + 1, 0.0);
  for (const TextBody& b : bodies)
    for (int k = p.bin_of(b.low - slope * b.along); k <= p.bin_of(b.high - slope * b.along); ++k)
      p.sums[static_cast<std::size_t>(k)] += 1.0;
  return p;
}

/// How clearly the profile repeats: the first Fourier coefficient of it folded, over its sum, and where it is least.
double clearness(const Profile& p, double pitch, double& least_at) {
  // Without its mean, or a side that is written on from end to end repeats with its own height.
  std::size_t first = 0, end = p.sums.size();
  while (first < end && !(p.sums[first] > 0.0)) ++first;
  while (end > first && !(p.sums[end - 1] > 0.0)) --end;
  double c = 0.0, s = 0.0, all = 0.0;
  for (std::size_t k = first; k < end; ++k) all += p.sums[k];
  const double mean = all / std::max<double>(1.0, static_cast<double>(end - first));
  for (std::size_t k = first; k < end; ++k) {
    const double phase = 2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) * p.bin / pitch;
    c += (p.sums[k] - mean) * std::cos(phase);
    s += (p.sums[k] - mean) * std::sin(phase);
  }
  least_at = p.low + pitch * (std::atan2(s, c) / (2.0 * std::numbers::pi) + 0.5);
  return all > 0.0 ? std::hypot(c, s) / all : 0.0;
}

double squares_of(const Profile& p) {
  double sum = 0.0;
  for (const double v : p.sums) sum += v * v;
  return sum;
}

}  // namespace

std::vector<int> lines_of(const std::vector<TextBody>& bodies, double width_mm) {
  std::vector<int> out(bodies.size(), 1);
  if (bodies.size() < 2 || !(width_mm > 0.0)) return out;
  double slope = 0.0, best = -1.0;
  for (int k = 0; k <= 40; ++k) {
    const double tried = std::tan(kCutClimb * (k % 2 ? -1.0 : 1.0) * ((k + 1) / 2) / 20.0 * std::numbers::pi / 180.0);
    const double sum = squares_of(profile_of(bodies, tried, width_mm));
    if (sum > 1.002 * best) {
      best = sum;
      slope = tried;
    }
  }
  const Profile p = profile_of(bodies, slope, width_mm);
  const double height = static_cast<double>(p.sums.size()) * p.bin - 2.0 * width_mm;
  std::vector<std::pair<double, double>> tried;  // distance and clearness
  double at = 0.0, most = 0.0;
  for (double pitch = kLeastPitch * width_mm; pitch <= std::min(kMostPitch * width_mm, 1.2 * height); pitch *= 1.01) {
    tried.emplace_back(pitch, clearness(p, pitch, at));
    most = std::max(most, tried.back().second);
  }
  double pitch = 0.0;
  for (std::size_t k = 0; k < tried.size() && pitch == 0.0; ++k) {
    const bool top = (k == 0 || tried[k].second >= tried[k - 1].second) &&
                     (k + 1 == tried.size() || tried[k].second >= tried[k + 1].second);
    if (top && tried[k].second > kPitchNearly * most) pitch = tried[k].first;
  }
  if (pitch == 0.0) return out;
  clearness(p, pitch, at);
  std::vector<double> cuts;
  const double first = at + pitch * std::ceil((p.low - at) / pitch);
  for (double cut = first; cut < p.low + static_cast<double>(p.sums.size()) * p.bin; cut += pitch) {
    int best_bin = p.bin_of(cut);
    const int reach = static_cast<int>(kCutMove * pitch / p.bin);
    double least = 1e30;
    for (int k = -reach; k <= reach; ++k) {
      const int bin = p.bin_of(cut) + k;
      if (bin < 0 || bin >= static_cast<int>(p.sums.size())) continue;
      const double far = static_cast<double>(k) / reach;
      const double cost = p.sums[static_cast<std::size_t>(bin)] + 0.5 * far * far;
      if (cost < least) {
        least = cost;
        best_bin = bin;
      }
    }
    cuts.push_back(p.low + (best_bin + 0.5) * p.bin);
  }
  std::map<int, int> numbers;  // lines from above
  const auto band = [&](const TextBody& b) {
    const double middle = 0.5 * (b.low + b.high) - slope * b.along;
    return -static_cast<int>(std::upper_bound(cuts.begin(), cuts.end(), middle) - cuts.begin());
  };
  for (const TextBody& b : bodies) numbers[band(b)] = 0;
  int line = 0;
  for (auto& [key, number] : numbers) number = ++line;
  for (std::size_t i = 0; i < bodies.size(); ++i) out[i] = numbers[band(bodies[i])];
  return out;
}

}  // namespace dubsar
