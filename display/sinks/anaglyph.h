#pragma once
// Two views for coloured glasses: out = left_matrix * left + right_matrix * right, in linear light, clamped.

#include <array>
#include <glm/mat3x3.hpp>
#include <span>
#include <string_view>

#include "core/image_io/image.h"
#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

struct AnaglyphVariant {
  std::string_view name;   ///< e.g. "red_cyan_dubois"
  glm::dmat3 left, right;  ///< for column vectors (r, g, b)
};

/// Red-cyan, green-magenta and amber-blue, each as dubois, full, half and mono; red_green and red_blue as mono.
/// Dubois: least squares in the glasses' own spectra (Dubois, ICASSP 2001). Full: the glasses' channels as they are.
/// Half: the left eye's channels become its luminance. Mono: all channels become luminance (Rec. 709 weights).
std::span<const AnaglyphVariant> anaglyph_variants();

/// Options: a variant's name, and left_first or right_first: which eye the first colour of that name is for.
Result<std::unique_ptr<OutputSink>> make_anaglyph_sink(SinkOptions options);

}  // namespace dubsar
