#pragma once
// A camera of one kind over any transport. The program asks the device which kind it is (make_leap_camera()).

#include <memory>
#include <utility>

#include "devices/leap/lmc1_driver.h"
#include "devices/leap/rigel_driver.h"

namespace dubsar {

inline std::unique_ptr<StereoCamera> lmc1_camera(OpenTransport open, const Lmc1Options& options, const Clock& clock) {
  return make_stereo_camera(
      std::move(open),
      [options](Transport&) -> Result<std::unique_ptr<StereoCameraKind>> { return lmc1_kind(options); }, clock);
}

inline std::unique_ptr<StereoCamera> rigel_camera(OpenTransport open, const RigelOptions& options, const Clock& clock) {
  return make_stereo_camera(
      std::move(open),
      [options](Transport&) -> Result<std::unique_ptr<StereoCameraKind>> { return rigel_kind(options); }, clock);
}

}  // namespace dubsar
