#include "display/sinks/anaglyph.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include "display/optics/srgb.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/two_view_sink.h"

namespace dubsar {
namespace {

constexpr GLint kLeftLocation = 0, kRightLocation = 1;  // shaders/anaglyph.frag

glm::dmat3 rows(glm::dvec3 r, glm::dvec3 g, glm::dvec3 b) { return glm::transpose(glm::dmat3(r, g, b)); }

const glm::dvec3 kNone(0), kLuminance(0.2126, 0.7152, 0.0722);
const glm::dvec3 kR(1, 0, 0), kG(0, 1, 0), kB(0, 0, 1);

// Rows of the output; the matrices of Dubois are those he published for the usual glasses.
const std::array<AnaglyphVariant, 14> kVariants{{
    {"red_cyan_dubois", rows({.437, .449, .164}, {-.062, -.062, -.024}, {-.048, -.050, -.017}),
     rows({-.011, -.032, -.007}, {.377, .761, .009}, {-.026, -.093, 1.234})},
    {"green_magenta_dubois", rows({-.062, -.158, -.039}, {.284, .668, .143}, {-.015, -.027, .021}),
     rows({.529, .705, .024}, {-.016, -.015, -.065}, {.009, .075, .937})},
    {"amber_blue_dubois", rows({1.062, -.205, .299}, {-.026, .908, .068}, {-.038, -.173, .022}),
     rows({-.016, -.123, -.017}, {.006, .062, -.017}, {.094, .185, .911})},
    {"red_cyan_full", rows(kR, kNone, kNone), rows(kNone, kG, kB)},
    {"green_magenta_full", rows(kNone, kG, kNone), rows(kR, kNone, kB)},
    {"amber_blue_full", rows(kR, kG, kNone), rows(kNone, kNone, kB)},
    {"red_cyan_half", rows(kLuminance, kNone, kNone), rows(kNone, kG, kB)},
    {"green_magenta_half", rows(kNone, kLuminance, kNone), rows(kR, kNone, kB)},
    {"amber_blue_half", rows(kLuminance, kLuminance, kNone), rows(kNone, kNone, kB)},
    {"red_cyan_mono", rows(kLuminance, kNone, kNone), rows(kNone, kLuminance, kLuminance)},
    {"green_magenta_mono", rows(kNone, kLuminance, kNone), rows(kLuminance, kNone, kLuminance)},
    {"amber_blue_mono", rows(kLuminance, kLuminance, kNone), rows(kNone, kNone, kLuminance)},
    {"red_green_mono", rows(kLuminance, kNone, kNone), rows(kNone, kLuminance, kNone)},
    {"red_blue_mono", rows(kLuminance, kNone, kNone), rows(kNone, kNone, kLuminance)},
}};

class AnaglyphSink : public TwoViewSink {
 public:
  AnaglyphSink(const AnaglyphVariant& variant, bool right_first)
      : TwoViewSink({.name = "anaglyph"}, right_first), variant_(variant) {}

  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    DUBSAR_TRY(pass_.begin(target, views.coded()));
    const glm::mat3 left(right_first() ? variant_.right : variant_.left),
        right(right_first() ? variant_.left : variant_.right);
    glUniformMatrix3fv(kLeftLocation, 1, GL_FALSE, glm::value_ptr(left));
    glUniformMatrix3fv(kRightLocation, 1, GL_FALSE, glm::value_ptr(right));
    return pass_.draw();
  }

 private:
  AnaglyphVariant variant_;
  ComposePass pass_{"anaglyph.frag"};
};

}  // namespace

std::span<const AnaglyphVariant> anaglyph_variants() { return kVariants; }

Result<std::unique_ptr<OutputSink>> make_anaglyph_sink(SinkOptions options) {
  const bool right_first = options.eyes_swapped();
  std::vector<std::string_view> names;
  std::string known;
  for (const AnaglyphVariant& variant : anaglyph_variants()) {
    known += (names.empty() ? "one of: " : ", ") + std::string(variant.name);
    names.push_back(variant.name);
  }
  const int variant = options.choice(names);
  DUBSAR_TRY(options.finish(known + "; left_first or right_first"));
  return std::make_unique<AnaglyphSink>(kVariants[static_cast<std::size_t>(variant)], right_first);
}

}  // namespace dubsar
