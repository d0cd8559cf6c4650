#pragma once
// What the screen says to visitors, in their language. A museum may change every sentence by a file of its own.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar::app {

/// One short sentence each, read from 1.5 m.
enum class Line : std::uint8_t {
  kInvite,        ///< nobody is there
  kShowHand,      ///< somebody is there, without a hand
  kGrab,          ///< an open hand
  kTurn,          ///< a closed one that does not move
  kTwoHands,      ///< how to come nearer
  kSwipe,         ///< how to see another side
  kRest,          ///< how to open the envelope
  kRestTour,      ///< how an open hand begins the tour
  kNearer,        ///< the hand is too far from the sensor
  kOpenFirst,     ///< a fist came in, which cannot take hold
  kSomebodyElse,  ///< another person holds the object
  kTouch,         ///< nobody is there, and there is a touch panel and no hand sensor
  kNoTracker,     ///< there is neither
  kNoPanel,       ///< the display is not the one that was set up
  kNoObject,      ///< the object cannot be shown
  kTourSealed,    ///< titles of the tour that any tablet has, and what is said below them
  kTourSealedText,
  kTourSeals,
  kTourSealsText,
  kTourPeel,
  kTourPeelText,
  kTourTablet,
  kTourTabletText,
  kTourBare,  ///< a tablet without an envelope
  kTourBareText,
  kTourLine,
  kTourLineText,
};
inline constexpr std::size_t kLineCount = 27;

/// Name of a line in files of words: "show_hand".
std::string_view line_name(Line line) noexcept;

/// Any thread once made.
class Words {
 public:
  /// The program's own sentences.
  Words();
  /// With the changes of a JSON text {"de": {"grab": "..."}, "ar": {...}}: languages are codes of two or three small
  /// letters, sentences have 1 to 120 letters. A language that the program does not speak must have every line but
  /// "rest_tour", which came later and is said as "rest" where it is missing.
  /// kConfig, by language and name, for anything else.
  static Result<Words> parse(std::string_view json_text, std::string_view source);

  bool has(std::string_view language) const;
  std::vector<std::string> languages() const;
  /// In English where the language is unknown.
  const std::string& say(Line line, std::string_view language) const;
  /// Whether it is written from right to left.
  static bool right_to_left(std::string_view language) noexcept;

 private:
  std::map<std::string, std::array<std::string, kLineCount>, std::less<>> languages_;
};

}  // namespace dubsar::app
