#pragma once
// Options of pictures that say how a style is shaded: mixed with another one, ridges lifted out, colours, legend.

#include <string>

#include "app/cli/arguments.h"
#include "core/image_io/image.h"
#include "display/render/shading.h"

namespace dubsar::app {

struct LookOptions {
  std::string blend;        ///< "STYLE=SHARE"; empty: none
  double radiance = 0.0;    ///< percent
  double strength = 100.0;  ///< percent
  FieldColors colours = FieldColors::kDesigned;
  Hatch hatch = kSepiaHatch;
  bool legend = false, section = false;
};

void add_look_options(Arguments& command, LookOptions& options);

/// kUsage: no such style or share, or a legend of a style whose colours tell no figure.
Result<void> apply(const LookOptions& options, Shading& shading);

/// Puts the legend of the style into the picture's lower left corner where the options say so.
Result<void> add_legend(const LookOptions& options, const Style& style, Image& picture);

}  // namespace dubsar::app
