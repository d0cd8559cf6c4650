#pragma once
// Paths of objects inside an HDF5 file: "/group/data".

#include <string>

namespace dubsar {

/// The group that holds the object; "/" for objects at the top.
inline std::string hdf5_parent(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos || slash == 0 ? "/" : path.substr(0, slash);
}

/// The path of `name` seen from a group; a name that begins with "/" is a path of its own.
inline std::string hdf5_child(const std::string& group, const std::string& name) {
  if (!name.empty() && name.front() == '/') return name;
  return (group == "/" ? "" : group) + "/" + name;
}

}  // namespace dubsar
