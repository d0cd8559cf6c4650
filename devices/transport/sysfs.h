#pragma once
// What the kernel writes into the small files of /sys. Any thread.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace dubsar {

/// At most 8 KiB; empty where the file is not there, or not any more.
std::string sysfs_bytes(const std::filesystem::path& file);

/// The first line, up to 256 characters, in printable ASCII: '?' for what is not.
std::string printable_line(std::string_view text);
std::string sysfs_line(const std::filesystem::path& file);

/// Nothing unless all of the text is a number in hexadecimal.
std::optional<std::uint32_t> hex_number(std::string_view digits);

}  // namespace dubsar
