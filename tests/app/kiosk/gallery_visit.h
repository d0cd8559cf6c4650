#pragma once
// A naive visitor's minute before the kiosk as it is: its guide, its tutorials, its marks and its mapping; and what
// came of it.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/people/gallery.h"

namespace dubsar::app::test {

/// One thing that a visitor tried, and what the session made of it.
struct GalleryAttempt {
  double from_s = 0.0;
  Intention wants = Intention::kNone;
  std::string tries;
  int moments = 0, seen = 0, kept = 0, held = 0;  ///< his better hand: by the tracker, as the owner's, as holding
  int swipes = 0;
  glm::dvec3 at_m{0.0};                                    ///< of the hand, last
  double closed = 0.0;                                     ///< at most
  double turned_deg = 0.0, along_deg = 0.0, zoomed = 0.0;  ///< of the view; along: the way he meant
};

struct GalleryVisit {
  std::optional<double> turned_s;  ///< after arriving: the object first followed an attempt to turn it
  std::optional<double> zoomed_s;
  std::optional<double> opened_s;  ///< the hidden tablet was first to be seen
  int unwanted = 0;                ///< movements, and openings, that began while the visitor wanted nothing
  int takeovers = 0;               ///< movements by somebody else's hand while the visitor was there
  double minutes = 0.0;
  std::vector<GalleryAttempt> attempts;
  std::string causes;  ///< one line for each that was unwanted or of somebody else
};
GalleryVisit visit(const GalleryOptions& room);

struct GalleryFigures {
  int visitors = 0, turned = 0, zoomed = 0, opened = 0, unwanted = 0, takeovers = 0;
  double minutes = 0.0;
  void add(const GalleryVisit& visit);
};

inline constexpr std::array kNaiveKinds{NaiveKind::kWaves, NaiveKind::kPokes, NaiveKind::kPushes, NaiveKind::kGrabsFar,
                                        NaiveKind::kImitates};

}  // namespace dubsar::app::test
