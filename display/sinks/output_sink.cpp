#include "display/sinks/output_sink.h"

#include <array>

#include "display/sinks/anaglyph.h"
#include "display/sinks/image.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/lenticular.h"
#include "display/sinks/mono.h"
#include "display/sinks/packed.h"
#include "display/sinks/plugin_sink.h"
#include "display/sinks/quad_buffer.h"
#include "display/sinks/quilt.h"

namespace dubsar {
namespace {

constexpr std::array<SinkBackend, 10> kSinks{{
    {"mono", "one view for any monitor", true, make_mono_sink},
    {"side_by_side", "two views beside each other: half (default), full; left_first (default), right_first", false,
     make_side_by_side_sink},
    {"top_bottom", "two views above each other: half (default), full, frame_packing; left_first (default), right_first",
     false, make_top_bottom_sink},
    {"interlaced", "two views in alternate rows (default), columns, checkerboard or subpixels; left_first, right_first",
     false, make_interlaced_sink},
    {"anaglyph", "two views for coloured glasses: red_cyan_dubois (default) and 13 others", false, make_anaglyph_sink},
    {"lenticular", "lens sheets: PROFILE and/or calibration=FILE; linear (default), nearest, gaussian3, gaussian10",
     false, make_lenticular_sink},
    {"quad_buffer",
     "two views in a quad-buffered window (shutter glasses, zSpace); side_by_side where there is no stereo visual",
     false, make_quad_buffer_sink},
    {"quilt", "all views of a Looking Glass panel as tiles: PROFILE or columns=,rows=,width=,height=,aspect=,cone=",
     false, make_quilt_sink},
    {"image", "one view into files: path=FILE.png, or path=NAME-%.png for numbered ones", false, make_image_sink},
    {"null", "draws nothing, for measuring", false, make_null_sink},
}};

}  // namespace

std::span<const SinkBackend> output_sinks() { return kSinks; }

std::vector<std::pair<std::string, std::string>> parse_sink_options(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> options;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(','));
    const auto equals = word.find('=');
    const std::string_view value = equals == std::string_view::npos ? std::string_view() : word.substr(equals + 1);
    options.emplace_back(word.substr(0, equals), value);
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return options;
}

Result<std::unique_ptr<OutputSink>> make_sink(std::string_view spec, const std::filesystem::path& profile_folder,
                                              std::span<const std::shared_ptr<SinkPlugin>> plugins) {
  const auto colon = spec.find(':');
  for (const auto& plugin : plugins)
    if (plugin->name() == spec.substr(0, colon))
      return plugin->create(colon == std::string_view::npos ? std::string() : std::string(spec.substr(colon + 1)));
  DUBSAR_ASSIGN(const SinkBackend* backend, find_backend(output_sinks(), spec.substr(0, colon), "display"));
  const std::string_view options = colon == std::string_view::npos ? std::string_view() : spec.substr(colon + 1);
  return backend->create({parse_sink_options(options), profile_folder});
}

}  // namespace dubsar
