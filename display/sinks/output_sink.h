#pragma once
// The one interface behind which every display stands. A sink says which views it wants, the renderer fills a view
// array, the sink puts them together for its panel. The order of calls: configure (again whenever the window or the
// screen changes), views (every frame), compose (every frame, GL thread).

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/registry.h"
#include "core/base/result.h"
#include "display/optics/off_axis.h"
#include "display/optics/optics.h"
#include "display/optics/view.h"

namespace dubsar {

class SinkPlugin;
class ViewArray;

struct PixelSize {
  int width = 0, height = 0;
  friend bool operator==(const PixelSize&, const PixelSize&) = default;
};

struct SinkTraits {
  std::string_view name;
  int views = 1;               ///< layers of the view array
  PixelSize view{};            ///< pixels of one layer
  PixelSize output{};          ///< pixels of the composed picture
  bool tracked = false;        ///< follows the viewer's eyes
  bool exact_pixels = false;   ///< works only unscaled, at a known place on the panel
  bool stereo_visual = false;  ///< needs a quad-buffered context
  std::string file_suffix{};   ///< what files of this picture carry before the extension, e.g. "_qs8x6a0.75"
};

/// Where compose() draws: a GL frame buffer (0: the window) of SinkTraits::output pixels. Bytes are sRGB-coded.
struct Surface {
  unsigned framebuffer = 0;
  int width = 0, height = 0;
  /// Draw buffers of the left and the right eye (GL_BACK_LEFT and GL_BACK_RIGHT, or two colour attachments); 0: the
  /// surface holds one picture.
  std::array<unsigned, 2> eye_buffers{0, 0};
};

class OutputSink {
 public:
  virtual ~OutputSink() = default;
  /// Valid after configure().
  virtual SinkTraits traits() const noexcept = 0;
  virtual Result<void> configure(const Screen& screen) = 0;
  /// The cameras for this viewer, traits().views of them; world is the screen frame. No GL. The span is good until the
  /// next call.
  virtual std::span<const View> views(const Viewer& viewer) = 0;
  /// Draws the panel's picture from the layers. GL thread, with the context current that the sink is destroyed in.
  virtual Result<void> compose(const ViewArray& views, const Surface& target) = 0;
  /// Where the panel's lenses send the light of what was composed last; nothing for displays without lenses.
  virtual std::optional<PanelLight> light() const { return std::nullopt; }
};

/// What the part after "NAME:" said, and where to look for data.
struct SinkConfig {
  std::vector<std::pair<std::string, std::string>> options;  ///< "key=value"; a bare word has an empty value
  std::filesystem::path profile_folder;                      ///< the user's panel profiles; may be missing
};

using SinkBackend = Backend<OutputSink, SinkConfig>;

/// All sinks, in the order in which they are offered.
std::span<const SinkBackend> output_sinks();

/// Makes the sink that "NAME[:word,key=value,...]" names. kUsage with the names there are, or with what the sink's
/// options are. Names of plug-ins (display/sinks/plugin_sink.h) count, too.
Result<std::unique_ptr<OutputSink>> make_sink(std::string_view spec, const std::filesystem::path& profile_folder = {},
                                              std::span<const std::shared_ptr<SinkPlugin>> plugins = {});

/// Splits "word,key=value" (empty text: no options).
std::vector<std::pair<std::string, std::string>> parse_sink_options(std::string_view text);

}  // namespace dubsar
