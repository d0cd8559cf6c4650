#include "input/tracking/vision/model_files.h"

#include <array>

namespace dubsar {
namespace {

constexpr std::array<ModelFile, 3> kFiles{kFaceModel, kPalmModel, kHandModel};

}  // namespace

std::span<const ModelFile> model_files() { return kFiles; }

bool model_is_here(const std::filesystem::path& folder, const ModelFile& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(folder / file.name, error);
  return !error && static_cast<std::int64_t>(size) == file.bytes;
}

}  // namespace dubsar
