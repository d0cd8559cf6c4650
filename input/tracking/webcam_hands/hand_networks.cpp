#include "input/tracking/webcam_hands/hand_networks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "input/tracking/vision/model_files.h"
#include "input/tracking/vision/network.h"
#include "input/tracking/vision/ssd_anchors.h"

namespace dubsar {
namespace {

constexpr int kPalmInput = kPalmModel.size_px, kHandInput = kHandModel.size_px;
constexpr std::size_t kPalmPoints = 7;  // wrist, knuckles of index, middle, ring and little finger, two of the thumb
constexpr double kLeastScore = 0.5, kMostOverlap = 0.3;
// the square about a hand, from its palm's box and from its landmarks: what the networks were trained with
constexpr double kPalmSides = 2.6, kPalmShift = 0.5, kHandSides = 2.0, kHandShift = 0.1;

/// Turn of a square whose upper edge is where this direction points.
double turn_towards(const glm::dvec2& direction) {
  return 0.5 * std::numbers::pi - std::atan2(-direction.y, direction.x);
}

glm::dvec2 up_of(double turn_rad) { return {std::sin(turn_rad), -std::cos(turn_rad)}; }

class Networks final : public HandNetworks {
 public:
  Networks(Network palm, Network hand)
      : palm_(std::move(palm)),
        hand_(std::move(hand)),
        anchors_(make_anchors(std::array{AnchorGrid{24, 2}, AnchorGrid{12, 6}})),
        palm_planes_(3 * kPalmInput * kPalmInput),
        hand_planes_(3 * kHandInput * kHandInput) {}

  Result<std::vector<SquareCrop>> find_palms(const PictureView& picture) override {
    const SquareCrop whole = whole_picture(picture);
    sampler_.sample(picture, whole, kPalmInput, 1.0f / 255.0f, 0.0f, palm_planes_);
    DUBSAR_TRY(palm_.run(palm_planes_, outputs_));
    if (outputs_.size() != 2 || outputs_[0].size() != anchors_.size() * (4 + 2 * kPalmPoints) ||
        outputs_[1].size() != anchors_.size())
      return fail(ErrorKind::kBadData, "palm network: its outputs are not those of palm_detection_lite");
    std::vector<SquareCrop> crops;
    for (const SsdDetection& palm : merge_overlapping(
             decode_ssd(outputs_[0], outputs_[1], anchors_, kPalmPoints, kPalmInput, kLeastScore), kMostOverlap)) {
      const double side_px = whole.side_px * std::max(palm.width(), palm.most.y - palm.least.y);
      const double turn = turn_towards(palm.points[2] - palm.points[0]);
      crops.push_back(
          {whole.to_picture(palm.centre()) + kPalmShift * side_px * up_of(turn), kPalmSides * side_px, turn});
    }
    return crops;
  }

  Result<HandSeen> place_landmarks(const PictureView& picture, const SquareCrop& crop) override {
    sampler_.sample(picture, crop, kHandInput, 1.0f / 255.0f, 0.0f, hand_planes_);
    DUBSAR_TRY(hand_.run(hand_planes_, outputs_));
    if (outputs_.size() != 4 || outputs_[0].size() != 3 * kLandmarks || outputs_[1].size() != 1 ||
        outputs_[2].size() != 1 || outputs_[3].size() != 3 * kLandmarks)
      return fail(ErrorKind::kBadData, "hand network: its outputs are not those of hand_landmark_lite");
    HandSeen hand;
    hand.presence = outputs_[1][0];
    hand.right = outputs_[2][0];
    hand.crop = crop;
    const double c = std::cos(crop.turn_rad), s = std::sin(crop.turn_rad);
    for (std::size_t i = 0; i < kLandmarks; ++i) {
      const float *point = &outputs_[0][3 * i], *shape = &outputs_[3][3 * i];
      hand.points_px[i] = crop.to_picture(glm::dvec2(point[0], point[1]) / static_cast<double>(kHandInput));
      hand.shape_m[i] = {c * shape[0] - s * shape[1], s * shape[0] + c * shape[1], shape[2]};
    }
    return hand;
  }

 private:
  Network palm_, hand_;
  std::vector<glm::dvec2> anchors_;
  PictureSampler sampler_;
  std::vector<float> palm_planes_, hand_planes_;
  std::vector<std::vector<float>> outputs_;
};

}  // namespace

SquareCrop HandSeen::next_crop() const noexcept {
  const glm::dvec2 knuckles = 0.5 * (0.5 * (points_px[5] + points_px[13]) + points_px[9]);
  const double turn = turn_towards(knuckles - points_px[0]);
  const glm::dvec2 up = up_of(turn), across(-up.y, up.x);
  // the box of the palm and the lower halves of the fingers, along the square's axes
  glm::dvec2 least(1e30), most(-1e30);
  for (const std::size_t i : {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18}) {
    const glm::dvec2 at(glm::dot(points_px[i], across), glm::dot(points_px[i], up));
    least = glm::min(least, at);
    most = glm::max(most, at);
  }
  const glm::dvec2 middle = 0.5 * (least + most), size = most - least;
  const double side_px = std::max(size.x, size.y);
  return {middle.x * across + (middle.y + kHandShift * size.y) * up, kHandSides * side_px, turn};
}

Result<std::unique_ptr<HandNetworks>> make_hand_networks(const std::filesystem::path& folder) {
  DUBSAR_ASSIGN(Network palm, Network::read(folder, kPalmModel));
  DUBSAR_ASSIGN(Network hand, Network::read(folder, kHandModel));
  return std::make_unique<Networks>(std::move(palm), std::move(hand));
}

}  // namespace dubsar
