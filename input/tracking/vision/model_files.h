#pragma once
// The networks' files: which there are, where they come from, whether they are here.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace dubsar {

struct ModelFile {
  std::string_view name;     ///< of the file
  std::string_view what;     ///< what it is for
  std::string_view package;  ///< where it comes from, with its version
  std::int64_t bytes = 0;
};

inline constexpr std::string_view kFaceModel = "face_detection_short_range.tflite";
inline constexpr std::string_view kPalmModel = "palm_detection_lite.tflite";
inline constexpr std::string_view kHandModel = "hand_landmark_lite.tflite";

/// What fetches them; they are never part of the program.
inline constexpr std::string_view kModelCommand = "./do models";

/// All of them. Apache-2.0, Google's MediaPipe.
std::span<const ModelFile> model_files();

/// True when the file is in this folder and has the right size. Its content was checked when it was fetched.
bool model_is_here(const std::filesystem::path& folder, const ModelFile& file);

}  // namespace dubsar
