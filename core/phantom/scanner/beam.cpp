#include "core/phantom/scanner/beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace dubsar::phantom {
namespace {

struct Entry {
  double kev, cm2_per_g;
};

// Kaolinite, calcite and Fe2O3 are sums of their elements; copper, caesium iodide with its K edges and water stand in
// the database as they are.
constexpr Entry kKaolinite[] = {{15, 4.943}, {20, 2.179},  {30, .7646},  {40, .4210},  {50, .2965}, {60, .2393},
                                {80, .1891}, {100, .1667}, {150, .1404}, {200, .1261}, {300, .1080}};
constexpr Entry kCalcite[] = {{15, 12.91}, {20, 5.697},  {30, 1.8456}, {40, .8816},  {50, .5327}, {60, .3760},
                              {80, .2462}, {100, .1955}, {150, .1485}, {200, .1292}, {300, .1088}};
constexpr Entry kIronOxide[] = {{15, 40.47}, {20, 18.22},  {30, 5.832},  {40, 2.616},  {50, 1.4335}, {60, .9001},
                                {80, .4667}, {100, .3066}, {150, .1783}, {200, .1393}, {300, .1090}};
constexpr Entry kCopper[] = {{15, 74.05}, {20, 33.79},  {30, 10.92},  {40, 4.862},  {50, 2.613}, {60, 1.593},
                             {80, .7630}, {100, .4584}, {150, .2217}, {200, .1559}, {300, .1119}};
constexpr Entry kCsI[] = {{15, 58.15},    {20, 26.86},     {30, 9.045},  {33.168, 6.923}, {33.17, 21.22},
                          {35.98, 17.19}, {35.985, 30.27}, {40, 22.97},  {50, 12.87},     {60, 7.921},
                          {80, 3.677},    {100, 2.035},    {150, .7290}, {200, .3805},    {300, .1818}};
constexpr Entry kWater[] = {{15, 1.673}, {20, .8096},  {30, .3756},  {40, .2683},  {50, .2269}, {60, .2059},
                            {80, .1837}, {100, .1707}, {150, .1505}, {200, .1370}, {300, .1186}};

constexpr double kIron = 0.05;  ///< share of Fe2O3 in clay
constexpr double kCopperDensity = 8.96, kCsIDensity = 4.51, kCsIMm = 0.6;

double interpolate(std::span<const Entry> table, double kev) {
  std::size_t i = 1;
  while (i + 1 < table.size() && table[i].kev < kev) ++i;
  const Entry &a = table[i - 1], &b = table[i];
  const double t = std::log(kev / a.kev) / std::log(b.kev / a.kev);
  return a.cm2_per_g * std::pow(b.cm2_per_g / a.cm2_per_g, t);
}

// K lines of tungsten, keV, and their shares (Kalpha1, Kalpha2, Kbeta).
constexpr std::array<std::pair<double, double>, 3> kTungsten{{{59.32, 0.52}, {57.98, 0.30}, {67.24, 0.18}}};
constexpr double kTungstenEdge = 69.525;

/// Share of the K lines in the photons that leave the tube (above 30 keV): .1 at 150 kV, growing from the edge as the
/// cross section of ionisation does.
double line_share(double kv) {
  return kv <= kTungstenEdge ? 0.0 : 0.1 * std::pow((kv / kTungstenEdge - 1.0) / (150.0 / kTungstenEdge - 1.0), 1.63);
}

}  // namespace

double clay_attenuation(double kev, double lime) {
  return (1.0 - kIron - lime) * interpolate(kKaolinite, kev) + lime * interpolate(kCalcite, kev) +
         kIron * interpolate(kIronOxide, kev);
}
double copper_attenuation(double kev) { return interpolate(kCopper, kev); }
double csi_attenuation(double kev) { return interpolate(kCsI, kev); }
double water_attenuation(double kev) { return interpolate(kWater, kev); }

Beam::Beam(const BeamOptions& o) {
  constexpr double kPerMm = 0.1;  // of 1/cm
  const auto add = [&](double kev, double photons) {
    const double filter = std::exp(-copper_attenuation(kev) * kCopperDensity * kPerMm * o.copper_mm);
    const double stopped = 1.0 - std::exp(-csi_attenuation(kev) * kCsIDensity * kPerMm * kCsIMm);
    lines_.push_back({kev, photons * filter * stopped, clay_attenuation(kev, o.lime) * o.clay_g_cm3 * kPerMm,
                      water_attenuation(kev) * kPerMm});
  };
  if (o.mono_kev > 0.0) {
    lines_.push_back({o.mono_kev, 1.0, clay_attenuation(o.mono_kev, o.lime) * o.clay_g_cm3 * kPerMm,
                      water_attenuation(o.mono_kev) * kPerMm});
  } else {
    double leave = 0.0;
    for (double kev = 15.5; kev < o.kv; kev += 1.0) {
      add(kev, o.kv / kev - 1.0);
      if (kev > 30.0) leave += o.kv / kev - 1.0;
    }
    const double share = line_share(o.kv);
    for (const auto& [kev, part] : kTungsten)
      if (share > 0.0) add(kev, part * leave * share / (1.0 - share));
  }
  for (const Line& line : lines_) open_ += line.photons * line.kev;
}

double Beam::transmission(double clay_mm) const {
  double sum = 0.0;
  for (const Line& line : lines_) sum += line.photons * line.kev * std::exp(-line.clay_per_mm * clay_mm);
  return sum / open_;
}

double Beam::excess(double clay_mm) const {
  double n = 0.0, e = 0.0, e2 = 0.0;
  for (const Line& line : lines_) {
    const double photons = line.photons * std::exp(-line.clay_per_mm * clay_mm);
    n += photons;
    e += photons * line.kev;
    e2 += photons * line.kev * line.kev;
  }
  return n * e2 / (e * e);
}

double Beam::mean_slope(double Line::*material) const {
  double sum = 0.0;
  for (const Line& line : lines_) sum += line.photons * line.kev * line.*material;
  return sum / open_;
}
double Beam::clay_per_mm() const { return mean_slope(&Line::clay_per_mm); }
double Beam::water_per_mm() const { return mean_slope(&Line::water_per_mm); }

BeamTable::BeamTable(const Beam& beam, double longest_mm) {
  constexpr int kEntries = 4096;
  const double step = std::max(longest_mm, 1e-3) / (kEntries - 1);
  per_mm_ = static_cast<float>(1.0 / step);
  for (int i = 0; i < kEntries + 1; ++i) {
    transmission_.push_back(static_cast<float>(beam.transmission(step * i)));
    excess_.push_back(static_cast<float>(beam.excess(step * i)));
  }
}

float BeamTable::look_up(const std::vector<float>& table, float mm) const noexcept {
  const float place = std::clamp(mm * per_mm_, 0.0f, static_cast<float>(table.size() - 2));
  const auto i = static_cast<std::size_t>(place);
  const float t = place - static_cast<float>(i);
  return table[i] + t * (table[i + 1] - table[i]);
}

}  // namespace dubsar::phantom
