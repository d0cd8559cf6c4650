#pragma once
// Sheets of pictures for the documentation.

#include <vector>

#include "core/image_io/image.h"

namespace dubsar::testing {

/// Mean of the pixels under each new one, in steps of 8, which makes files small.
Image scaled(const Image& image, int width, int height);

/// Rows of pictures on white paper; those of a column are equally wide.
Image sheet(const std::vector<std::vector<Image>>& rows);

}  // namespace dubsar::testing
