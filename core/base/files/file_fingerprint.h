#pragma once
// Whether a file is the one that something was made of, without reading all of it.

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// The number of bytes and a hash (FNV-1a, 64 bits) of 64 pieces of 4096 bytes spread evenly over the file, its first
/// and its last among them: "2147483648-9c1f0d0b52a3e7f4". Copies have the same, whatever their name; a file that was
/// changed in a few bytes between the pieces has it, too. Errors of InputFile.
Result<std::string> file_fingerprint(const std::filesystem::path& path);

/// The number of bytes and a hash (64 bits) of all of them: "830742-9c1f0d0b52a3e7f4". It tells files apart that were
/// not made to be mistaken for each other. Errors of InputFile.
Result<std::string> file_checksum(const std::filesystem::path& path);
/// The same of bytes in memory.
std::string bytes_checksum(std::string_view bytes);

}  // namespace dubsar
