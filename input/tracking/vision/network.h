#pragma once
// A network that runs: pictures in, rows of numbers out. OpenCV's dnn behind it.

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "input/tracking/vision/model_files.h"

namespace dubsar {

class Network {
 public:
  /// Reads one of model_files() in this folder; OpenCV sees it only when its bytes are the known ones. kNoInput,
  /// kPermission, kBadData.
  static Result<Network> read(const std::filesystem::path& folder, const ModelFile& file);

  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;
  ~Network();

  /// `planes`: three of ModelFile::size_px x size_px, channel after channel. `outputs`: in the order of the file,
  /// values in the order that its shapes say; lends its memory, so keep handing in the same object. One thread at a
  /// time, and only one is used for the work, so that results do not depend on the machine. kInternal: OpenCV refused.
  Result<void> run(std::span<const float> planes, std::vector<std::vector<float>>& outputs);

 private:
  struct Impl;
  explicit Network(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dubsar
