#pragma once
// Two-class splits of histograms without two clear peaks: Otsu's threshold and Gaussian mixtures by EM. Internal to
// core/volume.

#include <vector>

#include "core/filter/histogram.h"

namespace dubsar {

/// Otsu (1979): the threshold with the largest variance between the classes.
struct OtsuSplit {
  double threshold = 0.0;
  double mean_lo = 0.0, mean_hi = 0.0;
  double share_hi = 0.0;      ///< of the mass in the bins
  double separability = 0.0;  ///< variance between the classes / total variance; 2 / pi for a single Gaussian
};
OtsuSplit otsu_split(const Histogram& histogram);

/// Gaussians, and a plateau of partial-volume voxels between the lowest and the highest of them.
struct Mixture {
  struct Component {
    double weight = 0.0, mean = 0.0, sigma = 0.0;
  };
  std::vector<Component> components;  ///< rising means
  double plateau = 0.0;               ///< weight of the plateau
};

/// Expectation maximisation on the bins, started from Otsu's classes, 100 steps. Deterministic. At least two bins.
Mixture fit_mixture(const Histogram& histogram, int components);

/// Weighted density of a component.
double density(const Mixture::Component& component, double x);

/// Distance of two components in units of their width (Ashman's D); below 2 they are not two.
double separation(const Mixture::Component& a, const Mixture::Component& b);

/// Value between the means where both components are equally likely; their middle when one covers the other.
double equal_posterior(const Mixture::Component& low, const Mixture::Component& high);

}  // namespace dubsar
