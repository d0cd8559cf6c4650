#include "input/tracking/vision/model_files.h"

#include <array>

namespace dubsar {
namespace {

constexpr std::array<ModelFile, 3> kFiles{{
    {kFaceModel, "faces from a webcam", "@mediapipe/face_detection 0.4.1646425229", 229032},
    {kPalmModel, "hands from a webcam: where they are", "@mediapipe/hands 0.4.1675469240", 1985440},
    {kHandModel, "hands from a webcam: their joints", "@mediapipe/hands 0.4.1675469240", 2071408},
}};

}  // namespace

std::span<const ModelFile> model_files() { return kFiles; }

bool model_is_here(const std::filesystem::path& folder, const ModelFile& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(folder / file.name, error);
  return !error && static_cast<std::int64_t>(size) == file.bytes;
}

}  // namespace dubsar
