#pragma once
// The HID side of a Looking Glass in memory: pages of calibration text, with the real one's bad manners.

#include <memory>
#include <string>

#include "devices/looking_glass/calibration_pages.h"
#include "devices/transport/sim_transport.h"

namespace dubsar {

struct LookingGlassManners {
  bool split = true;         ///< reports arrive as 64 and 4 bytes, as through hidraw
  int stale_pages = 0;       ///< so many copies of the page asked for before come first
  int ignored_requests = 0;  ///< the first requests are not answered
  bool blank = false;        ///< memory never written: all ones
};

class LookingGlassSim {
 public:
  LookingGlassSim(std::string json, LookingGlassManners manners);
  SimDevice& device() noexcept { return *device_; }

 private:
  std::unique_ptr<SimDevice> device_ = std::make_unique<SimDevice>("simulated Looking Glass");
};

}  // namespace dubsar
