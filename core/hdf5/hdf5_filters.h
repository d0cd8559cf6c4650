#pragma once
// Filters of chunks that the library may use.

#include <filesystem>

namespace dubsar {

/// Filters that may be loaded from the plug-in folder: bzip2 307, lzf 32000, blosc 32001, lz4 32004, bitshuffle 32008,
/// zfp 32013.
bool hdf5_plugin_allowed(int filter_id) noexcept;

/// Built in, or found in the plug-in folder and allowed. Any thread.
bool hdf5_filter_available(int filter_id);

/// Folder of the filter plug-ins. Only this folder is searched, whatever the environment says. Returns the
/// folder that it was before. For tests.
std::filesystem::path set_hdf5_plugin_folder(const std::filesystem::path& folder);

}  // namespace dubsar
