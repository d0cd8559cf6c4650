#pragma once
// The light of an X-ray tube behind clay, as a flat panel sees it.

#include <vector>

#include "core/phantom/scanner/scanner_options.h"

namespace dubsar::phantom {

/// Mass attenuation in cm2/g at an energy in keV, 20 to 300: tables of [Hubbell 1995], mixed by
/// mass and interpolated between the logarithms. kClay: kaolinite with 5 % of Fe2O3 and `lime` of calcite.
double clay_attenuation(double kev, double lime);
double copper_attenuation(double kev);
double csi_attenuation(double kev);
double water_attenuation(double kev);

/// Spectrum: Kramers' photons per keV ~ (E0/E - 1) with the K lines of tungsten (a tenth of those above 30 keV at 150
/// kV), through copper; the panel (.6 mm of CsI) weighs each photon that it stops by its energy. Steps of 1 keV from 15
/// keV.
class Beam {
 public:
  explicit Beam(const BeamOptions& options);

  /// Signal behind so many mm of clay as a share of the open beam's.
  double transmission(double clay_mm) const;
  /// <E^2> / <E>^2 of the photons that are stopped behind it: how much noisier they are than as many of one energy.
  double excess(double clay_mm) const;
  /// Attenuation of the first millimetre, 1/mm.
  double clay_per_mm() const;
  double water_per_mm() const;

 private:
  struct Line {
    double kev, photons, clay_per_mm, water_per_mm;
  };
  double mean_slope(double Line::*material) const;
  std::vector<Line> lines_;
  double open_ = 0.0;  ///< signal of the open beam
};

/// The two curves by the thickness, interpolated.
class BeamTable {
 public:
  BeamTable(const Beam& beam, double longest_mm);
  float transmission(float clay_mm) const noexcept { return look_up(transmission_, clay_mm); }
  float excess(float clay_mm) const noexcept { return look_up(excess_, clay_mm); }

 private:
  float look_up(const std::vector<float>& table, float mm) const noexcept;
  float per_mm_;
  std::vector<float> transmission_, excess_;
};

}  // namespace dubsar::phantom
