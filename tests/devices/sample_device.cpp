#include "tests/devices/sample_device.h"

#include <array>
#include <cmath>

#include "devices/device_list.h"
#include "devices/driver.h"
#include "devices/transport/sim_transport.h"

namespace dubsar::test {
namespace {

class SimulatedWand final : public PacedDevice {
 public:
  explicit SimulatedWand(const Simulation& simulation) : PacedDevice(simulation) {}
  Result<std::unique_ptr<Transport>> open() override { return device_.open(); }

 private:
  void say(const SimulatedPerson& person, bool fresh) override {
    if (!fresh) return;
    const glm::dvec3 push = person.cap().twist;  // the hand moves sideways and up
    std::array<std::byte, 4> report{std::byte{'W'}};
    for (int i = 0; i < 3; ++i)
      report[static_cast<std::size_t>(i) + 1] = static_cast<std::byte>(std::lround(100 * push[i]));
    device_.send(report);
  }
  SimDevice device_{"simulated wand"};
};

}  // namespace

bool WandProtocol::accept(std::span<const std::byte> report, TimestampNs now) {
  if (report.size() != 4 || report[0] != std::byte{'W'}) return false;
  SpaceMouseSample sample;
  sample.time = now;
  for (int i = 0; i < 3; ++i) {
    const int share = static_cast<std::int8_t>(report[static_cast<std::size_t>(i) + 1]);
    if (std::abs(share) > 100) return false;
    sample.translation[i] = 0.01 * share;
  }
  newest_ = sample;
  return true;
}

std::unique_ptr<SimulatedDevice> simulate_wand(const Simulation& simulation) {
  return std::make_unique<SimulatedWand>(simulation);
}

DriverTable wand_table() {
  static constexpr std::array<DeviceId, 1> kIds{{{kWandVendor, kWandProduct, "Wand"}}};
  static const std::array<DriverEntry, 1> kTable{
      {{.name = "wand",
        .summary = "a wand",
        .bus = Bus::kHid,
        .ids = kIds,
        .gives = Gives::kSpaceMouse,
        .input = {.source = "wand", .taken_unasked = true},
        .open = [](const DriverEntry& self, OptionReader&, const Clock& clock) -> Result<OpenTransport> {
          return OpenTransport([&self, &clock] { return open_hid_device(self, clock); });
        },
        .drive = [](OpenTransport open, OptionReader&, const Clock* stamps) -> std::unique_ptr<DeviceDriver> {
          return std::make_unique<Driver<WandProtocol>>(std::move(open), WandProtocol(), stamps);
        },
        .simulate = simulate_wand}}};
  return kTable;
}

}  // namespace dubsar::test
