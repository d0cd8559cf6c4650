#pragma once
// Automatic parameters from the histogram: noise, signal-to-noise ratio and threshold (paper sections 3.1 and 3.2).

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/filter/histogram.h"
#include "core/volume/slab_source.h"

namespace dubsar {

enum class ThresholdMethod {
  kAuto,  ///< half way between the peaks; where noise is there, 3 sigma below the upper one, at least kLeastOfContrast
  kValley,   ///< the paper's rule alone: up from the valley to `factor` times its density
  kSigmas,   ///< the paper's alternative: `factor` sigma below the upper peak
  kHalf,     ///< half way between the peaks
  kOtsu,     ///< maximal variance between two classes
  kMixture,  ///< equal posterior of the two upper components of a Gaussian mixture
};

inline constexpr EnumName<ThresholdMethod> kThresholdMethods[] = {
    {ThresholdMethod::kAuto, "auto"}, {ThresholdMethod::kValley, "valley"}, {ThresholdMethod::kSigmas, "sigmas"},
    {ThresholdMethod::kHalf, "half"}, {ThresholdMethod::kOtsu, "otsu"},     {ThresholdMethod::kMixture, "mixture"},
};
static_assert(names_all(kThresholdMethods, static_cast<std::size_t>(ThresholdMethod::kMixture) + 1));

struct EstimateOptions {
  ThresholdMethod method = ThresholdMethod::kAuto;
  double factor = 0.0;                           ///< 0: the paper's, 2 for the valley rule and 3 for the sigmas
  std::optional<float> left_out = std::nullopt;  ///< value of voxels that are no measurement (core/volume/unmeasured.h)
};

/// Ways to tell air from material in a histogram, in the order in which kAuto tries them.
enum class SplitWay { kPeaks, kMixture, kOtsu };

/// Air and material as one way sees them.
struct Split {
  double m_lo = 0.0, m_hi = 0.0;  ///< grey values
  double sigma = 0.0;             ///< of the noise in the material; 0: the way says nothing about it
  double threshold = 0.0;
  double threshold_valley = 0.0;  ///< see Estimates
  double material_fraction = 0.0;
};

/// Why a way was taken or not.
enum class SplitVerdict {
  kTaken,
  kOnePeak,        ///< the histogram has one peak
  kShallowValley,  ///< two peaks that run into each other
  kNoSlope,        ///< a peak without a slope to measure
  kOneClass,       ///< nearly all voxels on one side
  kNoFit,          ///< no mixture of Gaussians describes the histogram
  kNotApart,       ///< Otsu's classes are those of a single Gaussian
};

/// One way that was tried.
struct SplitAttempt {
  SplitWay way = SplitWay::kPeaks;
  SplitVerdict verdict = SplitVerdict::kTaken;
  std::optional<Split> split;  ///< when it was taken
  std::string reason;          ///< for people
};

struct Estimates {
  double m_lo = 0.0, m_hi = 0.0;       ///< grey values of air and material (modes)
  double sigma = 0.0;                  ///< standard deviation of the noise in the material
  double snr_db = 0.0;                 ///< 20 log10((m_hi - m_lo) / sigma)
  double snr_alt_db = 0.0;             ///< 10 log10((m_hi - m_lo) / sigma), the other reading of the paper's figures
  double threshold = 0.0;              ///< isovalue; meaningless with a refusal
  double threshold_valley = 0.0;       ///< what the paper's rule alone says; 0 without two peaks
  double material_fraction = 0.0;      ///< of all voxels, above the threshold
  std::vector<SplitAttempt> attempts;  ///< in the order in which they were made; the last one was taken or none
  std::string path;                    ///< their reasons, one sentence
  std::string refusal;                 ///< why no threshold can be given; empty when there is one
};

/// Least automatic threshold, in parts of the way from m_lo to m_hi: within 0.1 voxel of the true surface.
inline constexpr double kLeastOfContrast = 0.45;

/// The attempt that was taken; nullptr with a refusal.
const SplitAttempt* taken(const Estimates& estimates) noexcept;

/// Estimates from a histogram (2,048 bins). `laplacian_sigma` is used where the histogram says nothing about the noise
/// (0: not known; see laplacian_noise). Never fails: `refusal` says when no threshold can be given.
Estimates estimate(const Histogram& histogram, double laplacian_sigma, const EstimateOptions& options = {});

/// The same from counts of all voxels of `source`, which is read only where the Laplacian noise is needed. Errors:
/// those of the source, kCancelled, and kBadData without a finite voxel.
Result<Estimates> estimate(const ValueCounts& counts, SlabSource& source, const EstimateOptions& options,
                           Progress& progress);

/// Counts the source and estimates; measures the Laplacian noise, in a second pass, only where it is needed.
/// Errors: those of the source, kCancelled, and kBadData for a source without voxels.
Result<Estimates> estimate(SlabSource& source, const EstimateOptions& options, Progress& progress);

/// The threshold, or kBadData with the refusal as text.
Result<double> automatic_threshold(const Estimates& estimates);

/// Noise from the median absolute Laplacian of the slices: 1.4826 median |L| / sqrt(20) with the 5-point kernel. Edges
/// hardly count. Exact for white noise; correlated noise comes out too small. When most residuals are 0 (a masked
/// background) the others count, and so it is around voxels of the value `left_out`. At most 65 slices are read, of at
/// least 3x3 voxels; smaller ones give 0.
Result<double> laplacian_noise(SlabSource& source, Progress& progress, std::optional<float> left_out = std::nullopt);

}  // namespace dubsar
