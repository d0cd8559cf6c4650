#pragma once
// A scan of one dataset, for tests that read it.

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "core/hdf5/hdf5_writer.h"

namespace dubsar::test {

/// The file as the program's own writer makes it, `axis_order` beside the dataset unless it is empty.
inline void write_scan(const std::string& path, const std::string& dataset, const Hdf5Storage& storage,
                       std::span<const float> values, const std::string& axis_order = {}) {
  auto writer = Hdf5Writer::create(path);
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_TRUE(writer->write<float>(dataset, storage, values));
  if (!axis_order.empty()) {
    ASSERT_TRUE(writer->set_attribute(dataset, "axis_order", axis_order));
  }
  ASSERT_TRUE(writer->commit());
}

}  // namespace dubsar::test
