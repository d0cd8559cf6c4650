#pragma once
// HID devices through hidapi (hidraw): opening one node. Real devices only; hid_listing.h finds them.

#include <memory>
#include <string>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// Opens one node for reading and writing. kUnavailable: not there; kPermission: not allowed, with the udev rule that
/// mends it; kIo: busy or refused by the kernel. The transport is lost when the node disappears: a read that finds
/// nothing for 250 ms looks whether the node is still the one that was opened, because hidraw may stay silent for ever.
/// `id` is what enumeration said; the transport tells it to the protocol.
Result<std::unique_ptr<Transport>> open_hid(const std::string& path, const Clock& clock, UsbId id = {});

}  // namespace dubsar
