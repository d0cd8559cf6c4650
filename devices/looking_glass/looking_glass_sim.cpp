#include "devices/looking_glass/looking_glass_sim.h"

#include <algorithm>
#include <vector>

namespace dubsar {
namespace {

std::vector<std::byte> memory_of(const std::string& json, bool blank) {
  std::vector<std::byte> memory(4);
  for (std::size_t i = 0; i < 4; ++i) memory[i] = static_cast<std::byte>(json.size() >> (24 - 8 * i) & 0xFFU);
  for (const char c : json) memory.push_back(static_cast<std::byte>(c));
  if (blank) std::fill(memory.begin(), memory.end(), std::byte{0xFF});
  return memory;
}

}  // namespace

LookingGlassSim::LookingGlassSim(std::string json, LookingGlassManners manners) {
  struct State {
    std::vector<std::byte> memory;
    LookingGlassManners manners;
    LookingGlassPage previous;
  };
  auto state = std::make_shared<State>(State{memory_of(json, manners.blank), manners, {}});
  const auto send = [device = device_.get(), split = manners.split](const LookingGlassPage& page) {
    const auto report = format_looking_glass(page);
    if (!split) return device->send(report);
    device->send(std::span(report).first(kLookingGlassPageBytes));
    device->send(std::span(report).subspan(kLookingGlassPageBytes));
  };
  SimBehaviour behaviour;
  behaviour.on_set_feature = [state, send](std::span<const std::byte> request) -> Result<void> {
    if (request.size() != kLookingGlassReportBytes || request[0] != std::byte{0})
      return fail(ErrorKind::kIo, "simulated Looking Glass: feature report of {} bytes refused", request.size());
    if (state->manners.ignored_requests-- > 0) return {};
    LookingGlassPage page;
    page.number =
        static_cast<std::uint16_t>(std::to_integer<unsigned>(request[2]) << 8 | std::to_integer<unsigned>(request[3]));
    page.data.fill(std::byte{0xFF});
    const std::size_t from = std::size_t{page.number} * kLookingGlassPageBytes;
    for (std::size_t i = 0; i < kLookingGlassPageBytes && from + i < state->memory.size(); ++i)
      page.data[i] = state->memory[from + i];
    if (page.number != state->previous.number)
      for (int i = 0; i < state->manners.stale_pages; ++i) send(state->previous);
    send(page);
    state->previous = page;
    return {};
  };
  device_->set_behaviour(std::move(behaviour));
}

}  // namespace dubsar
