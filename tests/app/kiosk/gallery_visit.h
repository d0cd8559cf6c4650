#pragma once
// A naive visitor's minute before the kiosk as it is: its guide, its lessons, its marks and its mapping; and what came
// of it.

#include <array>
#include <optional>
#include <string>

#include "input/simulated/gallery.h"

namespace dubsar::app::test {

struct GalleryVisit {
  std::optional<double> turned_s;  ///< after arriving: the object first followed an attempt to turn it
  std::optional<double> zoomed_s;
  std::optional<double> opened_s;  ///< the hidden tablet was first to be seen
  int unwanted = 0;                ///< movements, and openings, that began while the visitor wanted nothing
  int takeovers = 0;               ///< movements by somebody else's hand while the visitor was there
  double minutes = 0.0;
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
