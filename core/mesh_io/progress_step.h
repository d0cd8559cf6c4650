#pragma once

#include <cstddef>

namespace dubsar {

/// Lines, vertices or faces between two looks at `progress`, for readers and writers of meshes.
inline constexpr std::size_t kProgressStep = std::size_t{1} << 14;

}  // namespace dubsar
