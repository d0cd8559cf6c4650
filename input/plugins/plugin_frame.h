#pragma once
// From what a plug-in tells to an InputFrame: placed, checked and bounded.

#include <vector>

#include "input/input_source.h"
#include "input/plugins/source_plugin_abi.h"

namespace dubsar {

/// Collects one read() of a plug-in. One thread.
class PluginFrame {
 public:
  static constexpr std::size_t kMaxHeads = 16, kMaxKeys = 256;

  explicit PluginFrame(const Pose& screen_from_device) : place_(screen_from_device) {}

  /// What read() is given; valid as long as this is.
  dubsar_source_sink sink() noexcept;
  void begin(TimestampNs now);
  /// Moves what was told into `frame`: heads and hands replace the old ones, keys are appended.
  void finish(InputFrame& frame);
  std::uint64_t dropped() const noexcept { return dropped_; }  ///< too many in one read
  std::uint64_t refused() const noexcept { return refused_; }  ///< not finite, too far, too short, no quaternion

 private:
  void add_head(const dubsar_source_head* given) noexcept;
  void add_hand(const dubsar_source_hand* given) noexcept;
  void add_space_mouse(const dubsar_source_puck* given) noexcept;
  void add_key(const dubsar_source_key* given) noexcept;
  TimestampNs host_time(std::int64_t told) noexcept;
  bool placed(const double* position_m, glm::dvec3& out) const noexcept;
  bool placed(const dubsar_source_pose& given, Pose& out) const noexcept;

  Pose place_;
  TimestampNs now_ = 0, newest_ = 0;
  std::vector<HeadFrame> heads_;
  std::vector<HandFrame> hands_;
  std::optional<SpaceMouseMotion> space_mouse_;
  std::vector<InputEvent> keys_;
  std::uint64_t dropped_ = 0, refused_ = 0;
};

}  // namespace dubsar
