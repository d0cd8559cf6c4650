#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "input/tracking/face/face_detector.h"
#include "input/tracking/vision/network.h"
#include "input/tracking/vision/ssd_anchors.h"

namespace dubsar {
namespace {

constexpr int kInput = kFaceModel.size_px;
constexpr std::size_t kPoints = 6;  // right eye, left eye, nose tip, mouth, right ear, left ear
constexpr double kLeastScore = 0.5, kMostOverlap = 0.3;
constexpr double kCropSides = 2.0;  // of the face's box, for the second pass

class NetworkFaceDetector final : public FaceDetector {
 public:
  explicit NetworkFaceDetector(Network network)
      : network_(std::move(network)),
        anchors_(make_anchors(std::array{AnchorGrid{16, 2}, AnchorGrid{8, 6}})),
        planes_(3 * kInput * kInput) {}

  std::string_view name() const noexcept override { return "network"; }

  Result<std::vector<FaceSeen>> find(const PictureView& picture) override {
    return look(picture, whole_picture(picture));
  }

  Result<std::optional<FaceSeen>> refine(const PictureView& picture, const FaceSeen& near) override {
    DUBSAR_ASSIGN(const auto found, look(picture, {near.centre_px, kCropSides * near.size_px, 0.0}));
    std::optional<FaceSeen> best;
    for (const FaceSeen& face : found) {
      const double off = glm::length(face.centre_px - near.centre_px) / near.size_px;
      if (off < 0.5 && face.size_px > 0.5 * near.size_px && face.size_px < 2.0 * near.size_px &&
          (!best || face.score > best->score))
        best = face;
    }
    return best;
  }

 private:
  Result<std::vector<FaceSeen>> look(const PictureView& picture, const SquareCrop& crop) {
    sampler_.sample(picture, crop, kInput, 2.0f / 255.0f, -1.0f, planes_);
    DUBSAR_TRY(network_.run(planes_, outputs_));
    if (outputs_.size() != 2 || outputs_[0].size() != anchors_.size() * (4 + 2 * kPoints) ||
        outputs_[1].size() != anchors_.size())
      return fail(ErrorKind::kBadData, "face network: its outputs are not those of BlazeFace short range");
    std::vector<FaceSeen> faces;
    for (const SsdDetection& found : merge_overlapping(
             decode_ssd(outputs_[0], outputs_[1], anchors_, kPoints, kInput, kLeastScore), kMostOverlap)) {
      FaceSeen face;
      face.score = found.score;
      face.centre_px = crop.to_picture(found.centre());
      face.size_px = found.width() * crop.side_px;
      face.right_eye_px = crop.to_picture(found.points[0]);
      face.left_eye_px = crop.to_picture(found.points[1]);
      face.nose_px = crop.to_picture(found.points[2]);
      faces.push_back(face);
    }
    return faces;
  }

  Network network_;
  std::vector<glm::dvec2> anchors_;
  PictureSampler sampler_;
  std::vector<float> planes_;
  std::vector<std::vector<float>> outputs_;
};

}  // namespace

Result<std::unique_ptr<FaceDetector>> make_network_face_detector(const std::filesystem::path& folder) {
  DUBSAR_ASSIGN(Network network, Network::read(folder, kFaceModel));
  return std::make_unique<NetworkFaceDetector>(std::move(network));
}

}  // namespace dubsar
