#pragma once
// The networks' files: which there are, where they come from, whether they are here.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace dubsar {

/// A network as ONNX, made by tflite_to_onnx.py of what the package holds.
struct ModelFile {
  std::string_view name;      ///< of the file
  std::string_view what;      ///< what it is for
  std::string_view package;   ///< where it comes from, with its version
  int size_px = 0;            ///< rows and columns of the picture that it takes, of three channels
  std::int64_t bytes = 0;     ///< of the file
  std::string_view checksum;  ///< bytes_checksum() of it
};

inline constexpr ModelFile kFaceModel{
    "face_detection_short_range.onnx", "faces from a webcam", "@mediapipe/face_detection 0.4.1646425229", 128, 415380,
    "415380-11aca336e4ac61b5"};
inline constexpr ModelFile kPalmModel{
    "palm_detection_lite.onnx", "hands from a webcam: where they are", "@mediapipe/hands 0.4.1675469240", 192, 3865900,
    "3865900-58d5c19fd9242eed"};
inline constexpr ModelFile kHandModel{
    "hand_landmark_lite.onnx", "hands from a webcam: their joints", "@mediapipe/hands 0.4.1675469240", 224, 4058467,
    "4058467-c1489ee105758c60"};

/// What fetches them; they are never part of the program.
inline constexpr std::string_view kModelCommand = "./do models";

/// All of them. Apache-2.0, Google's MediaPipe.
std::span<const ModelFile> model_files();

/// True when the file is in this folder and has the right size. Its content is checked when it is read.
bool model_is_here(const std::filesystem::path& folder, const ModelFile& file);

}  // namespace dubsar
