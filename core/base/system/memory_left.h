#pragma once
// What the machine and its limits leave to this process.

#include <cstdint>
#include <string>

namespace dubsar {

/// Bytes of memory this process may still take: MemAvailable, or what the smallest limit of its cgroup and of those
/// around it leaves (versions 1 and 2); 2^64 - 1 where nothing is known. `root` stands before /proc and /sys: empty, or
/// a folder of a test.
std::uint64_t memory_left(const std::string& root);

}  // namespace dubsar
