#pragma once
// One slice, as an exact value at its border divides it into what lies outside and a region.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dubsar {

struct BorderLook {
  std::int64_t outside = 0, pixels = 0;
  std::int64_t dents = 0;  ///< pixels outside that the convex hull of the region has, too
  /// Grey values of the region: of its second and third pixel from what is outside, of the fifth to the eighth, and
  /// samples of all.
  std::vector<float> rim, behind, inner;

  bool blank() const noexcept { return outside == pixels; }
  bool beside() const noexcept;  ///< a share of the slice worth the name
  bool convex() const noexcept;  ///< the region, but for a tenth of what is outside
};

constexpr std::size_t kMostSliceSamples = 40'000;  ///< of a slice
constexpr double kLeastOutside = 0.005;            ///< share of slices
constexpr double kMostDents = 0.1;                 ///< of what is outside

/// Looks at `values` of `width` x `height` pixels, which outlive it. NaN and Inf count as one value. Memory: a byte a
/// pixel, while it looks some more.
class SliceBorder {
 public:
  SliceBorder(std::span<const float> values, std::int64_t width, std::int64_t height);

  /// Values that a hundredth of the border has.
  std::vector<float> values() const;
  /// All finite whole numbers of the border, ascending, where it has no others.
  std::vector<float> whole_values() const;

  /// What is joined to the border by pixels of these values; without values the border itself.
  BorderLook look(std::span<const float> values);

  /// The only value of values() beside which the region is convex, or that fills the slice; nothing where two are.
  std::optional<float> padding();

 private:
  static constexpr std::uint8_t kUnknown = 0, kOutside = 255;

  template <class Visit>
  void each_at_border(const Visit& visit) const;
  template <class Visit>
  void each_beside(std::int64_t at, const Visit& visit) const;
  std::int64_t dents() const;
  void gather(BorderLook& result) const;

  std::span<const float> values_;
  std::int64_t width_, height_;
  std::vector<std::uint8_t> steps_;
};

}  // namespace dubsar
