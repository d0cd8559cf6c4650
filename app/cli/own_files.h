#pragma once
// What a file that is already there is, before another one takes its place: the program's own, or somebody's.

#include <filesystem>
#include <string>

namespace dubsar::app {

enum class FileFormat { kOther, kJson, kExa, kMesh, kPicture, kPhantom, kEdition, kPictureOrMesh };

/// What would be lost if a file of `format` took the place of `path`: "a TIFF volume of 48 slices", "a PLY mesh that
/// dubsar did not write". Empty: nothing; there is no such file, it is empty, or dubsar wrote it as that format, which
/// its content says: the software that a picture names, the maker that a mesh names, "made_by" of JSON, the magic
/// number of EXA, the creator of a phantom. Reads the head of the file, of TIFF its pages.
std::string what_would_be_lost(const std::filesystem::path& path, FileFormat format);

}  // namespace dubsar::app
