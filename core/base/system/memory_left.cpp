#include "core/base/system/memory_left.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace dubsar {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// kUnlimited where the file is missing or says "max".
std::uint64_t read_number(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  return file >> value ? value : kUnlimited;
}

/// Contents of files that are only kept because nobody asked for the memory: a group that has read or written large
/// files is full of them.
std::uint64_t file_pages(const std::string& folder) {
  std::ifstream file(folder + "memory.stat");
  std::string key;
  std::uint64_t value = 0, own = 0, with_children = 0;
  while (file >> key >> value) {
    if (key == "inactive_file" || key == "active_file") own += value;
    if (key == "total_inactive_file" || key == "total_active_file") with_children += value;  // version 1
  }
  return std::max(own, with_children);
}

/// What the limit of one group leaves; a group that is over its limit leaves nothing.
std::uint64_t left_in_group(const std::string& folder, const char* limit_name, const char* used_name) {
  const std::uint64_t limit = read_number(folder + limit_name);
  if (limit == kUnlimited) return kUnlimited;
  const std::uint64_t used = read_number(folder + used_name);
  if (used == kUnlimited) return limit;
  return limit - std::min(limit, used - std::min(used, file_pages(folder)));
}

/// The smallest of what the group at `path` and the groups around it leave; the mount itself is the outermost.
std::uint64_t left_in_groups(const std::string& mount, std::string path, const char* limit_name,
                             const char* used_name) {
  std::uint64_t left = left_in_group(mount + "/", limit_name, used_name);
  while (path.size() > 1) {
    left = std::min(left, left_in_group(mount + path + "/", limit_name, used_name));
    path.resize(path.find_last_of('/'));
  }
  return left;
}

/// Lines of /proc/self/cgroup read ID:CONTROLLERS:PATH; version 2 has no controllers.
std::uint64_t left_in_cgroups(const std::string& root) {
  const std::string mount = root + "/sys/fs/cgroup";
  std::uint64_t left = left_in_group(mount + "/", "memory.max", "memory.current");
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos || line.compare(second + 1, 1, "/") != 0) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const std::string path = line.substr(second + 1);
    if (controllers == ",,") left = std::min(left, left_in_groups(mount, path, "memory.max", "memory.current"));
    if (controllers.find(",memory,") != std::string::npos)
      left = std::min(left, left_in_groups(mount + "/memory", path, "memory.limit_in_bytes", "memory.usage_in_bytes"));
  }
  return left;
}
}  // namespace

std::uint64_t memory_left(const std::string& root) {
  std::uint64_t available = kUnlimited;
  std::ifstream meminfo(root + "/proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kib = 0; meminfo >> key >> kib;) {
    std::getline(meminfo, unit);
    if (key == "MemAvailable:") available = kib * 1024;
  }
  return std::min(available, left_in_cgroups(root));
}

}  // namespace dubsar
