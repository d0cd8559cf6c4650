#pragma once
// A naive visitor's minute before the program's own mapping, and what came of it.

#include <array>
#include <optional>

#include "input/simulated/gallery.h"

namespace dubsar::test {

struct NaiveVisit {
  std::optional<double> turned_s;  ///< after arriving: the object first followed an attempt to turn it
  std::optional<double> zoomed_s;
  int unwanted = 0;   ///< movements that began while the visitor wanted nothing
  int takeovers = 0;  ///< movements by somebody else's hand while the visitor was there
  double minutes = 0.0;
};
NaiveVisit visit(const GalleryOptions& room);

struct NaiveFigures {
  int visitors = 0, turned = 0, zoomed = 0, unwanted = 0, takeovers = 0;
  double minutes = 0.0;
  void add(const NaiveVisit& visit);
};

inline constexpr std::array kNaiveKinds{NaiveKind::kWaves, NaiveKind::kPokes, NaiveKind::kPushes, NaiveKind::kGrabsFar,
                                        NaiveKind::kImitates};

}  // namespace dubsar::test
