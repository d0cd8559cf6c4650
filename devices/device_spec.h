#pragma once
// Which device is meant, and how devices are reached: the seam at which real ones are replaced by others.

#include <functional>
#include <string>
#include <vector>

#include "core/base/system/clock.h"
#include "core/base/text/option_list.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// A device by its driver's name, with the options that its row of the table of drivers reads (drivers.h).
struct DeviceSpec {
  std::string driver;
  std::vector<Option> options{};
};

/// Finds out how the chosen device is opened; opens nothing yet. kUsage: no such driver, an impossible
/// choice. The clock outlives all transports and may be read in any thread.
using DeviceOpener = std::function<Result<OpenTransport>(const DeviceSpec& spec, const Clock& clock)>;

}  // namespace dubsar
