#pragma once
// Tours: what an object is shown as, step by step, with a few words in the visitor's language. Plain values.

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/keyframe.h"
#include "app/kiosk/kiosk_profile.h"
#include "app/kiosk/words.h"

namespace dubsar::app {

struct Document;

/// Words that are pinned to a place of the surface while a step is shown.
struct TourLabel {
  Texts text;
  std::string part{};  ///< that it lies on and moves with; empty: none of them
  glm::dvec3 at_mm{0.0}, normal{0.0, 0.0, 1.0};
  friend bool operator==(const TourLabel&, const TourLabel&) = default;
};

/// From wherever things are, the object goes through the keyframes, whose times count from the step's beginning, and
/// stays at the last one.
struct TourStep {
  Texts title{}, text{};
  std::vector<TourLabel> labels{};
  double stays_s = 6.0;
  double says_s = 0.0;                ///< the text waits for so long, from the step's beginning
  std::vector<Keyframe> keyframes{};  ///< at least one; times above 0, rising
  friend bool operator==(const TourStep&, const TourStep&) = default;
};

struct Tour {
  std::vector<TourStep> steps;
  friend bool operator==(const Tour&, const Tour&) = default;
};

/// {"format": "dubsar tour", "version": 1, "steps": [...]} (docs/kiosk.md). What a keyframe does not say is as in the
/// one before; the first one's is the front view. kBadData in one sentence for what is no tour, unknown, missing or out
/// of range.
Result<Tour> parse_tour(std::string_view json_text, std::string_view source);
/// kNoInput, kPermission, kBadData.
Result<Tour> read_tour(const std::filesystem::path& path);
/// The same as text, everything said.
std::string format_tour(const Tour& tour);

/// A tour of any tablet, from its home view: the sealed envelope, its seals in low light, the envelope lifted, the
/// tablet alone, one of its lines from left to right; without an envelope the tablet, its sides and a line. In every
/// language of `words`.
Tour default_tour(const Document& document, const Words& words);

/// How long a step takes, from its beginning to the next one's.
double step_length_s(const TourStep& step);

}  // namespace dubsar::app
