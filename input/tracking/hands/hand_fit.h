#pragma once
// A hand of round cones fitted to the silhouettes in both eyes: position, turn and tilt, size, bend of each
// finger.

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "devices/leap/hand_model.h"
#include "input/tracking/hands/eye_samples.h"
#include "input/tracking/hands/hand_fit_kernels.h"

namespace dubsar {

/// What is believed before the picture is looked at: `pose` with these standard deviations.
struct HandPrior {
  HandPose pose{};
  double scale_sd = 0.1, tilt_sd_rad = 0.14, flexion_sd = 0.15, spread_sd = 0.3, wrist_sd_rad = 0.1, shape_sd = 0.04;
};

struct HandFitResult {
  HandPose pose{};
  double cost = 0.0;        ///< half the sum of squares: samples and prior, in variances
  double mean_error = 0.0;  ///< RMS difference of skin share per sample, 0..1
};

struct HandFitStep {
  double blur_m = 0.004;  ///< the model's edge rises from 0 to 1 over twice this
  int iterations = 4;
  std::size_t stride = 1;    ///< only every stride-th tile is looked at, and weighs as much more
  double shape_trust = 1.0;  ///< weight of the prior of everything but place, turn and size
};

/// Minimises the squared difference between the skin shares of all samples and those of the model, whose
/// outline is smoothed by blur_m, by Levenberg-Marquardt with the motion of the nearest outline point as the
/// derivative. Work grows with samples * cones near them; one thread per object.
class HandFit {
 public:
  HandFitResult fit(std::span<const EyeSamples> eyes, const HandPrior& prior, const HandPose& start,
                    std::span<const HandFitStep> steps);

  static constexpr std::size_t kParameters = kernels::kHandParameters;
  using Vector = std::array<double, kParameters>;

 private:
  struct Normal {
    double cost = 0.0, squares = 0.0;
    int samples = 0;
    std::array<double, kParameters * kParameters> matrix{};
    Vector gradient{};
  };
  void assemble(std::span<const EyeSamples> eyes, const HandPrior& prior, const HandPose& pose, const HandFitStep& step,
                Normal& normal);

  struct Best {
    alignas(64) std::array<float, EyeRays::kLanes> depth;
    alignas(64) std::array<float, EyeRays::kLanes> cone;
  };
  std::vector<Best> best_;
  std::array<kernels::ConeSlopes, kHandConeCount> slopes_{};
};

}  // namespace dubsar
