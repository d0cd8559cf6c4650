#include "core/hdf5/hdf5_filters.h"

#include <algorithm>
#include <array>

#include "core/hdf5/library.h"

namespace dubsar {

bool hdf5_plugin_allowed(int filter_id) noexcept {
  constexpr std::array<int, 6> kAllowed{307, 32000, 32001, 32004, 32008, 32013};
  return std::find(kAllowed.begin(), kAllowed.end(), filter_id) != kAllowed.end();
}

bool hdf5_filter_available(int filter_id) {
  const hdf5::Library library;
  const bool allowed = hdf5_plugin_allowed(filter_id);
  const hdf5::PluginsAllowed plugins(allowed);
  const bool built_in = filter_id >= 1 && filter_id <= 6;
  return (built_in || allowed) && H5Zfilter_avail(filter_id) > 0;
}

std::filesystem::path set_hdf5_plugin_folder(const std::filesystem::path& folder) {
  const hdf5::Library library;
  return hdf5::set_plugin_folder(folder);
}

}  // namespace dubsar
