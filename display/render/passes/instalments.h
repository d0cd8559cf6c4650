#pragma once
// Drawing that takes longer than people wait, in pieces: in between the window answers.

#include <epoxy/gl.h>

#include <array>
#include <cstdint>
#include <utility>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "display/render/mesh/gpu_mesh.h"

namespace dubsar {

/// The same steps are gone through in each instalment, in the same order; those that are done are passed over, and what
/// is left when the time is over waits for the next one. States and uniforms are set each time, only what is drawn
/// counts. The buffers that are drawn into must not be used for anything else in between. One GL thread.
class Instalments {
 public:
  Instalments() = default;
  Instalments(const Instalments&) = delete;
  Instalments& operator=(const Instalments&) = delete;
  Instalments(Instalments&& other) noexcept { *this = std::move(other); }
  Instalments& operator=(Instalments&& other) noexcept;
  ~Instalments();

  /// Nothing is done yet.
  void restart() noexcept { done_ = 0; }
  /// An instalment begins, which ends at `end` of the steady clock, or after the first thing that was done. Waits until
  /// the GPU has done what the one before the last asked for.
  void begin(TimestampNs end);
  /// Asks the GPU to do it.
  void finish();
  /// Something is left.
  bool paused() const noexcept { return paused_; }

  /// A step that is not divided.
  template <class Work>
  Result<void> once(Work&& work) {
    if (pass(1) > 0 || paused_) return {};
    DUBSAR_TRY(std::forward<Work>(work)());
    did(1);
    return {};
  }
  /// draw_ranges(), as much of it as there is time for.
  void draw(const TriangleRanges& ranges, GLsizei instances);

 private:
  /// How much of the next `count` is done already.
  std::int64_t pass(std::int64_t count) noexcept;
  void did(std::int64_t count);

  std::int64_t done_ = 0;  ///< of all steps: one for each triangle and for each other step
  std::int64_t at_ = 0;    ///< in this instalment
  TimestampNs end_ = 0;
  bool paused_ = false;
  std::array<GLsync, 2> asked_{};  ///< the one before the last, and the last
};

/// A step that is not divided: of instalments, or of a picture in one go (null).
template <class Work>
Result<void> once(Instalments* pieces, Work&& work) {
  return pieces != nullptr ? pieces->once(std::forward<Work>(work)) : std::forward<Work>(work)();
}

}  // namespace dubsar
