#include "display/sinks/catalog/sink_catalog.h"

#include <array>

#include "core/base/text/near_word.h"
#include "display/sinks/anaglyph.h"
#include "display/sinks/catalog/plugin_sink.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/lenticular.h"
#include "display/sinks/mono.h"
#include "display/sinks/openxr.h"
#include "display/sinks/packed.h"
#include "display/sinks/quad_buffer.h"
#include "display/sinks/quilt.h"
#include "display/sinks/shutter.h"
#include "display/sinks/single_image.h"

namespace dubsar {
namespace {

constexpr std::array<SinkBackend, 12> kSinks{{
    {"mono", "one view for any monitor", make_mono_sink},
    {"side_by_side", "two views beside each other: half (default), full; left_first (default), right_first",
     make_side_by_side_sink},
    {"top_bottom", "two views above each other: half (default), full, frame_packing; left_first (default), right_first",
     make_top_bottom_sink},
    {"interlaced",
     "two views in alternate rows (default), columns, checkerboard or subpixels; left_first, right_first; "
     "rows and squares are counted from the top (default) or bottom",
     make_interlaced_sink},
    {"anaglyph", "two views for coloured glasses: red_cyan_dubois (default) and 13 others; left_first, right_first",
     make_anaglyph_sink},
    {"lenticular",
     "lens sheets: PROFILE and/or calibration=FILE; of many views linear (default), nearest, gaussian3, gaussian10, "
     "focus=, zoom=; of two tracked ones left_first, right_first",
     make_lenticular_sink},
    {"quad_buffer",
     "two views in a quad-buffered window (shutter glasses, zSpace); left_first, right_first; side_by_side where there "
     "is no "
     "stereo visual",
     make_quad_buffer_sink},
    {"shutter",
     "two views in turn, one at each refresh, for projectors and glasses of 100 Hz and more: left_first "
     "(default), right_first",
     make_shutter_sink},
    {"openxr",
     "head-mounted displays through OpenXR, life size on a table before the wearer: distance=, height=, "
     "blend=opaque|alpha|additive, graphics=gl|vulkan|any",
     make_openxr_sink, false},
    {"quilt",
     "all views of a Looking Glass panel as tiles: PROFILE or columns=,rows=,width=,height=,aspect=,cone=,"
     "focus=,zoom=",
     make_quilt_sink},
    {"image", "one view into files: path=FILE.png, or path=NAME-%.png for numbered ones", make_image_sink, false},
    {"null", "draws nothing, for measuring", make_null_sink, false},
}};

}  // namespace

std::span<const SinkBackend> output_sinks() { return kSinks; }

SinkCatalog::SinkCatalog() : SinkCatalog(built_in_panels()) {}

SinkCatalog::SinkCatalog(PanelSet panels, std::vector<std::shared_ptr<SinkPlugin>> plugins)
    : panels_(std::move(panels)), plugins_(std::move(plugins)) {}

Result<std::unique_ptr<OutputSink>> SinkCatalog::make(const SinkSpec& spec) const {
  std::string names;
  for (const SinkBackend& sink : kSinks) {
    if (sink.name == spec.name) return sink.make(SinkOptions(spec, panels_));
    names += (names.empty() ? "" : ", ") + std::string(sink.name);
  }
  for (const auto& plugin : plugins_) {
    if (plugin->name() == spec.name) return plugin->create(spec.options_text());
    names += ", " + std::string(plugin->name());
  }
  return fail(ErrorKind::kUsage, "no display is called \"{}\", expected one of: {}{}", spec.name, names,
              did_you_mean(spec.name, names));
}

std::vector<SinkSpec> SinkCatalog::offered() const {
  std::vector<SinkSpec> out;
  for (const SinkBackend& sink : kSinks)
    if (sink.offered) out.push_back({std::string(sink.name)});
  for (const PanelProfile& panel : panels_.profiles)
    if (panel.sheet || panel.optics) out.push_back({"lenticular", {{panel.name}}});
  for (const auto& plugin : plugins_) out.push_back({std::string(plugin->name())});
  return out;
}

Result<std::unique_ptr<OutputSink>> SinkCatalog::make(std::string_view text) const {
  DUBSAR_ASSIGN(const SinkSpec spec, parse_sink_spec(text));
  return make(spec);
}

}  // namespace dubsar
