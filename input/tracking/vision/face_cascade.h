#pragma once
// Faces without networks: a cascade of Haar features (Viola, Jones 2001), OpenCV's.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

struct FaceBox {
  int x = 0, y = 0, width = 0, height = 0;
};

class FaceCascade {
 public:
  /// An OpenCV cascade file; Debian's package opencv-data has them in /usr/share/opencv4/haarcascades.
  /// kNoInput, kBadData.
  static Result<FaceCascade> read(const std::filesystem::path& path);
  FaceCascade(FaceCascade&&) noexcept;
  FaceCascade& operator=(FaceCascade&&) noexcept;
  ~FaceCascade();

  /// `gray`: rows without gaps. Faces of at least `least_px`. One thread at a time; about 26 ms for 320 x
  /// 240.
  std::vector<FaceBox> find(const std::uint8_t* gray, int width, int height, int least_px);

 private:
  struct Impl;
  explicit FaceCascade(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dubsar
