#include "core/contact/clays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <map>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr int kFromAir = 3;  ///< steps; nearer than that the blur of a surface darkens the clay
/// Sides of the pieces that the contact is divided into, steps; smaller ones where there are too few.
constexpr std::array<float, 3> kPieces{24.0f, 16.0f, 12.0f};
constexpr std::size_t kLeastNodes = 150;  ///< of each layer over a piece
constexpr std::size_t kLeastPieces = 6;
constexpr float kSignificance = 5.0f;
/// Of the difference, noise that is taken for at least: as of a scan of 8 bits. Without any, votes would have no end.
constexpr float kLeastClayNoise = 1.0f / 256.0f;
/// Layers of clay by their height over the patch, in parts of the band's reach: deep in the tablet, in the tablet, in
/// the envelope.
constexpr std::array<std::array<float, 2>, 3> kLayers{{{-0.95f, -0.65f}, {-0.6f, -0.3f}, {0.3f, 0.95f}}};
/// Between the middles of the second and third layer, in parts of that between the first two.
constexpr float kGradientReach = 1.075f / 0.35f;
/// Votes of a node that is one (white) deviation off the middle. Less leaves filled wedges to the patch, more follows
/// the noise: both grow with the area.
constexpr float kVote = 3.0f;

bool air_near(const BitVolume& inside, const glm::ivec3& p) {
  const Dims d = inside.dims();
  for (int axis = 0; axis < 3; ++axis)
    for (int away = -kFromAir; away <= kFromAir; ++away) {
      const glm::ivec3 q = p + away * unit_step(axis);
      if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= d.x || q.y >= d.y || q.z >= d.z || !inside.get(q.x, q.y, q.z))
        return true;
    }
  return false;
}

struct Mean {
  float value = 0.0f, error = 0.0f;  ///< error: standard
};
Mean mean_of(const std::vector<float>& values) {
  double sum = 0.0, squares = 0.0;
  for (const float v : values) sum += static_cast<double>(v);
  const auto n = static_cast<double>(values.size());
  const double mean = sum / n;
  for (const float v : values) squares += (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
  return {static_cast<float>(mean), static_cast<float>(std::sqrt(squares / (n - 1.0) / n))};
}

using Layers = std::array<std::vector<float>, kLayers.size()>;

/// Densities over and under the pieces of the contact. Pieces are cubes of patch around its middle, and what lies over
/// a place of the patch belongs to its piece.
std::vector<Layers> layers_of_pieces(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                                     float side) {
  const glm::vec3 middle = middle_of(band.samples);
  struct Value {
    std::array<std::int16_t, 3> piece;
    std::uint16_t layer;
    float density;
  };
  const std::vector<Value> values = parallel_gather<Value>(
      static_cast<std::int64_t>(band.nodes.size()), 1 << 14,
      [&](std::int64_t begin, std::int64_t end, std::vector<Value>& found) {
        for (std::int64_t n = begin; n < end; ++n) {
          const ContactBand::Node& node = band.nodes[static_cast<std::size_t>(n)];
          if (std::abs(node.height) < 0.8f * node.distance) continue;
          const float height = node.height / band.reach_at(node.height);
          for (std::size_t layer = 0; layer < kLayers.size(); ++layer) {
            if (height < kLayers[layer][0] || height > kLayers[layer][1]) continue;
            if (air_near(inside, {node.x, node.y, node.z})) continue;
            const glm::ivec3 piece(glm::round((band.samples[node.sample].position - middle) / side));
            const auto narrow = [](int at) { return static_cast<std::int16_t>(at); };
            found.push_back({{narrow(piece.x), narrow(piece.y), narrow(piece.z)},
                             static_cast<std::uint16_t>(layer),
                             density.get(node.x, node.y, node.z)});
          }
        }
      });
  std::map<std::array<std::int16_t, 3>, Layers> pieces;
  for (const Value& value : values) pieces[value.piece][value.layer].push_back(value.density);
  std::vector<Layers> enough;
  for (auto& [place, layers] : pieces)
    if (layers[1].size() >= kLeastNodes && layers[2].size() >= kLeastNodes) enough.push_back(std::move(layers));
  return enough;
}

}  // namespace

std::optional<ClayContrast> compare_clays(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                                          float blur_variance) {
  std::vector<Layers> pieces;
  for (const float side : kPieces)
    if (pieces.size() < kLeastPieces) pieces = layers_of_pieces(band, inside, density, side);
  std::vector<float> steps, without_gradient, tablet, envelope, off;
  for (Layers& layers : pieces) {
    const float near = median(layers[1]), beyond = median(layers[2]);
    steps.push_back(beyond - near);
    if (layers[0].size() >= kLeastNodes)
      without_gradient.push_back(beyond - near - kGradientReach * (near - median(layers[0])));
    for (const float v : layers[1]) off.push_back(std::abs(v - near));
    tablet.insert(tablet.end(), layers[1].begin(), layers[1].end());
    envelope.insert(envelope.end(), layers[2].begin(), layers[2].end());
  }
  if (steps.size() < kLeastPieces || without_gradient.size() < kLeastPieces) return std::nullopt;
  const Mean step = mean_of(steps), own = mean_of(without_gradient);
  ClayContrast contrast;
  contrast.deviation = std::max(1.4826f * median(std::move(off)), kLeastClayNoise * std::abs(step.value));
  const bool significant = std::abs(step.value) > kSignificance * step.error &&
                           std::abs(own.value) > 0.5f * kSignificance * own.error &&
                           own.value * step.value > 0.5f * step.value * step.value;
  if (!significant || std::abs(step.value) < contrast.deviation) return std::nullopt;
  // Of all clay at once: a median of some dozen pieces moves by a hundredth of the step when a few of them change.
  contrast.tablet = median(std::move(tablet));
  contrast.envelope = median(std::move(envelope));
  // Noise that was blurred with the scan (not with the extent of its voxels) and with BandDensity's own low pass is
  // shared by so many voxels.
  const float shared = 4.0f * static_cast<float>(M_PI) * (std::max(blur_variance - 1.0f / 12.0f, 0.0f) + 0.5f);
  contrast.white_deviation = contrast.deviation * std::sqrt(shared * std::sqrt(shared));
  return contrast;
}

std::vector<float> clay_votes(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                              const ClayContrast& contrast) {
  std::vector<float> votes(band.nodes.size(), 0.0f);
  const float sense = contrast.step() > 0.0f ? -1.0f : 1.0f;                        // of the tablet's clay
  const float most = 0.5f * std::abs(contrast.step()) + 2.0f * contrast.deviation;  // beyond it are grains and straw
  parallel_for(static_cast<std::int64_t>(votes.size()), 4096, [&](std::int64_t i) {
    const glm::ivec3 p = band.point(static_cast<std::uint32_t>(i));
    if (air_near(inside, p)) return;
    const float off = std::clamp(density.get(p.x, p.y, p.z) - contrast.middle(), -most, most);
    votes[static_cast<std::size_t>(i)] = sense * kVote * off / contrast.white_deviation;
  });
  return votes;
}

}  // namespace dubsar
