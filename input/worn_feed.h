#pragma once
// Hands and controllers of who wears a headset: whoever draws for it puts them in, a source takes them out. No OpenXR
// here.

#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include "input/input_source.h"

namespace dubsar {

/// Screen frame, metres; [0] left, [1] right.
struct WornSample {
  struct Controller {
    bool active = false;
    Pose grip{};
    double squeeze = 0.0;  ///< 0..1
    bool select = false;
  };
  TimestampNs time = 0;                             ///< 0: nothing was put in yet
  std::array<std::optional<HandFrame>, 2> hands{};  ///< joints; the rest follows from them
  std::array<Controller, 2> controllers{};
};

/// Any thread; the newest sample wins.
class WornFeed {
 public:
  void put(const WornSample& sample);
  /// Why there is nothing to put in; empty: there is.
  void absent(std::string reason);
  WornSample newest() const;
  std::string reason() const;

 private:
  mutable std::mutex mutex_;  // for all
  WornSample sample_;
  std::string reason_;
};

}  // namespace dubsar
