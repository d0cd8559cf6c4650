#pragma once
// A dataset with what is known of it without reading it. Internal to core/hdf5.

#include <string>

#include "core/base/result.h"
#include "core/hdf5/hdf5_dataset.h"
#include "core/hdf5/library.h"

namespace dubsar::hdf5 {

struct OpenDataset {
  Handle id;
  Hdf5DatasetInfo info;
};

/// Under the lock. The library opens the source files of a virtual dataset when it is asked for its shape: only with
/// `open_sources` are its dims filled in.
Result<OpenDataset> open_with_info(hid_t file, const std::string& path, hid_t access, bool open_sources);

}  // namespace dubsar::hdf5
