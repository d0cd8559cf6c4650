#pragma once
// A room with an object in it: a naive visitor before the panel, others beside him, sun and reflections; and what a
// hand tracker and perhaps a camera make of it.

#include <memory>
#include <vector>

#include "input/input_source.h"
#include "tests/people/naive_visitor.h"

namespace dubsar {

struct GalleryOptions {
  NaiveKind kind = NaiveKind::kImitates;
  std::uint64_t seed = 1;
  double arrives_s = 1.0, leaves_s = 60.0;
  int bystanders = 0;        ///< they lean in, wave, point, and close their hands
  bool camera = true;        ///< heads are seen too
  bool sun = false;          ///< at times it blinds the tracker
  bool reflections = false;  ///< things that look like hands for a moment
  double rate_hz = 0.0;      ///< of the hand tracker; 0: 60 to 115, as they come
};
/// A room as they come: crowds of up to four, a camera in half of them, sun in a fifth, reflections in a seventh.
GalleryOptions draw_gallery(NaiveKind kind, std::uint64_t seed);

class Gallery {
 public:
  explicit Gallery(const GalleryOptions& options);
  ~Gallery();
  Gallery(const Gallery&) = delete;
  Gallery& operator=(const Gallery&) = delete;

  /// The people look at the display, and the tracker says what it sees; false: nothing new since the last call. Rising
  /// times, from the session's start.
  bool step(double t_s, const SeenScreen& seen, InputFrame& frame);

  const NaiveVisitor& visitor() const noexcept;
  bool visitor_is_here(double t_s) const noexcept;
  /// Whether a hand of a frame is the visitor's.
  static bool is_the_visitors(std::uint32_t id) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace dubsar
