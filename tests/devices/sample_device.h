#pragma once
// A device that the program does not know, added as one would add a real one: its protocol, its simulator, its row.

#include <optional>
#include <span>
#include <utility>

#include "devices/drivers.h"
#include "devices/spacemouse/spacemouse_sample.h"

namespace dubsar::test {

inline constexpr std::uint16_t kWandVendor = 0x1209, kWandProduct = 0x57a0;

/// Four bytes: 'W', then the push along x, y and z as signed shares of 100.
class WandProtocol {
 public:
  using Sample = SpaceMouseSample;
  Result<void> start(Transport&, TimestampNs) { return {}; }
  Result<void> keep_up(Transport&, TimestampNs) { return {}; }
  bool accept(std::span<const std::byte> report, TimestampNs now);
  std::optional<Sample> newest() { return std::exchange(newest_, std::nullopt); }

 private:
  std::optional<Sample> newest_;
};

std::unique_ptr<SimulatedDevice> simulate_wand(const Simulation& simulation);

/// The table with this one row.
DriverTable wand_table();

}  // namespace dubsar::test
