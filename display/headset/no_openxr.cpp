// For builds without the OpenXR loader.

#include "display/headset/headset.h"

namespace dubsar {
namespace {
constexpr const char* kWhy =
    "this build has no OpenXR: install libopenxr-dev and libopenxr-loader1 (./do deps), configure and build again";
}

Result<std::unique_ptr<Headset>> make_headset(const HeadsetWish&) {
  return fail(ErrorKind::kUnavailable, "display openxr: {}", kWhy);
}

HeadsetFacts headset_facts() { return {false, kWhy}; }

}  // namespace dubsar
