// A tour of any tablet, made from nothing but its home view and its parts.

#include <glm/gtc/quaternion.hpp>

#include "app/document/document.h"
#include "app/kiosk/tour.h"
#include "core/base/numbers/angle.h"

namespace dubsar::app {
namespace {

constexpr LightPlace kEven{315.0, 35.0}, kLow{285.0, 9.0}, kLowOther{20.0, 9.0}, kReading{300.0, 14.0},
    kPeelLight{285.0, 8.0};
// Where the first lines of a tablet stand that fills the window at zoom 1: above its middle, by heights of the window.
constexpr double kWhole = 0.86, kWholeUp = 0.05;  // there is room for words below it
constexpr double kLineUp = 0.24, kLineAside = 0.15, kLineZoom = 2.4;

// The envelope goes up by 1.1 heights of the object from the tablet, and both are drawn smaller by 1 / (1 + 1.1 unpack)
// meanwhile (app/stage/shown_document.cpp). The camera undoes that, and stays on the strip of writing below the
// envelope's edge, which goes from kEdgeFrom to kEdgeTo (above the middle, by heights of the window): out of the
// picture.
// kShown: of the window's height, what an object at zoom 1 takes beside words (gallery_room()).
constexpr double kLift = 1.1, kShown = 0.6, kPeelZoom = 1.6, kEdgeFrom = -0.28, kEdgeTo = 0.62;

/// Keyframes from the home view of a document.
class Maker {
 public:
  Maker(const Document& document, const Words& words) : document_(document), words_(words) {}

  TourStep step(Line title, Line text, double stays_s, std::vector<Keyframe> keys) const {
    TourStep out;
    for (const std::string& language : words_.languages()) {
      out.title[language] = words_.say(title, language);
      out.text[language] = words_.say(text, language);
    }
    out.stays_s = stays_s;
    out.keyframes = std::move(keys);
    return out;
  }
  /// Turned from home about the upright and the horizontal axis.
  Keyframe key(double time_s, double aside_deg, double up_deg, double zoom, LightPlace light) const {
    Keyframe out;
    out.time_s = time_s;
    out.camera.rotation =
        glm::normalize(glm::angleAxis(up_deg * kRadPerDeg, glm::dvec3(1, 0, 0)) *
                       glm::angleAxis(aside_deg * kRadPerDeg, glm::dvec3(0, 1, 0)) * document_.home.rotation);
    out.camera.zoom = kWhole * zoom;
    out.camera.pan = {0.0, kWholeUp};
    out.light = light;
    for (const Part& part : document_.parts) out.parts.push_back({part.name, 1.0, part.offset_mm});
    return out;
  }
  Keyframe peeled(double time_s, double unpack) const {
    const double edge = kEdgeFrom + (kEdgeTo - kEdgeFrom) * unpack;  // of the envelope
    Keyframe out = key(time_s, 0, 0, kPeelZoom / kWhole * (1.0 + kLift * unpack), kPeelLight);
    out.camera.pan = {0.0, edge - kShown * kPeelZoom * (0.5 * kLift * unpack - 0.5)};
    out.unpack = unpack;
    return out;
  }
  static Keyframe without_envelope(Keyframe key) {
    for (KeyedPart& part : key.parts)
      if (part.name == "envelope") part.opacity = 0.0;
    return key;
  }
  static Keyframe moved(Keyframe key, const glm::dvec2& pan) {
    key.camera.pan = pan;
    return key;
  }

 private:
  const Document& document_;
  const Words& words_;
};

}  // namespace

Tour default_tour(const Document& document, const Words& words) {
  const Maker make(document, words);
  const bool enclosed = can_unpack(document);
  const auto bare = [&](Keyframe key) { return enclosed ? Maker::without_envelope(std::move(key)) : key; };
  Tour tour;
  if (enclosed) {
    tour.steps.push_back(make.step(Line::kTourSealed, Line::kTourSealedText, 1.0,
                                   {make.key(2.5, -18, 8, 1.0, kEven), make.key(7.0, 18, 8, 1.0, kEven)}));
    tour.steps.push_back(make.step(Line::kTourSeals, Line::kTourSealsText, 1.0,
                                   {make.key(2.5, 0, 0, 1.5, kLow), make.key(6.0, 0, -40, 1.5, kLowOther),
                                    make.key(10.0, 0, -110, 1.4, kLow), make.key(14.0, 0, -180, 1.3, kLow)}));
    tour.steps.push_back(make.step(Line::kTourPeel, Line::kTourPeelText, 5.0,
                                   {make.peeled(3.5, 0.0), make.peeled(4.0, 0.0), make.peeled(10.0, 1.0)}));
    tour.steps.back().says_s = 9.5;  // nothing is read while the writing appears
    tour.steps.push_back(make.step(Line::kTourTablet, Line::kTourTabletText, 3.0,
                                   {bare(make.peeled(1.0, 1.0)), bare(make.key(3.5, 0, 0, 1.1, kEven)),
                                    bare(make.key(8.5, 30, 10, 1.1, kEven)), bare(make.key(11.5, 0, 0, 1.1, kEven))}));
  } else {
    tour.steps.push_back(make.step(Line::kTourBare, Line::kTourBareText, 1.0,
                                   {make.key(2.5, 0, 0, 1.0, kEven), make.key(6.0, 0, -60, 1.1, kEven),
                                    make.key(9.0, 0, -120, 1.1, kEven), make.key(12.5, 0, -180, 1.0, kEven)}));
  }
  const double up = -kLineZoom * kLineUp, aside = kLineZoom * kLineAside;
  tour.steps.push_back(
      make.step(Line::kTourLine, Line::kTourLineText, 2.0,
                {Maker::moved(bare(make.key(3.5, 0, 0, kLineZoom / kWhole, kReading)), {aside, up}),
                 Maker::moved(bare(make.key(10.5, 0, 0, kLineZoom / kWhole, kReading)), {-aside, up})}));
  return tour;
}

}  // namespace dubsar::app
