#pragma once
// The ICC profile that says "these numbers are sRGB", for file formats that have no short way to say it.

#include <cstddef>
#include <span>

namespace dubsar {

/// A display profile of ICC version 2.4, about 2.6 kB, always the same bytes. Any thread.
std::span<const std::byte> srgb_profile();

}  // namespace dubsar
