#pragma once
// All bytes into an open file, however many calls that takes.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "core/base/result.h"

namespace dubsar {

/// From byte `offset` on. Any thread, as long as ranges do not overlap. The errors of pwrite(2), with the `name`.
Result<void> write_all(int descriptor, std::span<const std::byte> bytes, std::int64_t offset,
                       const std::filesystem::path& name);

}  // namespace dubsar
