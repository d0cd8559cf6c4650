#pragma once
// The file that lets the person at the machine open the devices of the table of drivers.

#include <string>

#include "devices/drivers.h"

namespace dubsar {

/// The text of devices/70-dubsar.rules: for each row of the table the devices that are opened by node.
std::string udev_rules(DriverTable drivers = driver_table());

}  // namespace dubsar
