#include <algorithm>
#include <glm/geometric.hpp>

#include "input/tracking/face/face_detector.h"
#include "input/tracking/vision/face_cascade.h"

namespace dubsar {
namespace {

constexpr int kWidth = 320;  // of the picture that is searched: 26 ms instead of 59 at 640
constexpr int kLeastFace = 40;
// where the pupils are in the cascade's box: means over six photographed faces at eleven sizes each, pupils
// 40 to 90 pixels apart; the distance had a sd of 0.021
constexpr double kEyeHeight = 0.39, kEyeDistance = 0.38;

class CascadeFaceDetector final : public FaceDetector {
 public:
  explicit CascadeFaceDetector(FaceCascade cascade) : cascade_(std::move(cascade)) {}
  std::string_view name() const noexcept override { return "cascade"; }

  Result<std::vector<FaceSeen>> find(const PictureView& picture) override {
    const int factor = std::max(1, picture.width / kWidth);
    const auto scale = static_cast<double>(factor);
    const int width = picture.width / factor, height = picture.height / factor;
    if (width < kLeastFace || height < kLeastFace) return std::vector<FaceSeen>{};
    make_gray(picture, factor, width, height);
    std::vector<FaceSeen> faces;
    for (const FaceBox& box : cascade_.find(gray_.data(), width, height, kLeastFace)) {
      FaceSeen face;
      face.score = 0.5;
      face.centre_px = scale * glm::dvec2(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
      face.size_px = scale * box.width;
      const glm::dvec2 between = face.centre_px + glm::dvec2(0.0, (kEyeHeight - 0.5) * face.size_px);
      const glm::dvec2 half(0.5 * kEyeDistance * face.size_px, 0.0);
      face.right_eye_px = between - half;
      face.left_eye_px = between + half;
      faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end(), [](const FaceSeen& a, const FaceSeen& b) { return a.size_px > b.size_px; });
    return faces;
  }
  /// The cascade has no second look: the whole picture is searched again.
  Result<std::optional<FaceSeen>> refine(const PictureView& picture, const FaceSeen& near) override {
    DUBSAR_ASSIGN(const auto faces, find(picture));
    std::optional<FaceSeen> best;
    for (const FaceSeen& face : faces)
      if (glm::length(face.centre_px - near.centre_px) < 0.5 * near.size_px && !best) best = face;
    return best;
  }

 private:
  void make_gray(const PictureView& picture, int factor, int width, int height) {
    gray_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        int sum = 0;
        for (int dy = 0; dy < factor; ++dy) {
          const std::uint8_t* pixel =
              picture.rgb + (static_cast<std::size_t>(y * factor + dy) * static_cast<std::size_t>(picture.width) +
                             static_cast<std::size_t>(x * factor)) *
                                3;
          for (int dx = 0; dx < factor; ++dx, pixel += 3)
            sum += 77 * pixel[0] + 150 * pixel[1] + 29 * pixel[2];  // Rec. 601
        }
        gray_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
            static_cast<std::uint8_t>(sum / (256 * factor * factor));
      }
  }
  FaceCascade cascade_;
  std::vector<std::uint8_t> gray_;
};

}  // namespace

Result<std::unique_ptr<FaceDetector>> make_cascade_face_detector(const std::filesystem::path& cascade) {
  DUBSAR_ASSIGN(FaceCascade read, FaceCascade::read(cascade));
  return std::make_unique<CascadeFaceDetector>(std::move(read));
}

}  // namespace dubsar
