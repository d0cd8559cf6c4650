#pragma once
// The one interface behind which every display stands. A sink says which views it wants, the renderer fills a view
// array, the sink puts them together for its panel. The order of calls: configure (again whenever the window or the
// screen changes), views (every picture), compose (every picture, and each field of it; GL thread).

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "display/headset/headset.h"
#include "display/optics/off_axis.h"
#include "display/optics/optics.h"
#include "display/optics/view.h"
#include "display/render/images/surface.h"

namespace dubsar {

class ViewArray;

/// Whose turn it is on a display that shows its eyes one after the other; other displays know only kFirst.
enum class Field : int { kFirst = 0, kSecond = 1 };

struct SinkTraits {
  std::string_view name;
  int views = 1;               ///< layers of the view array
  PixelSize view{};            ///< pixels of one layer
  PixelSize output{};          ///< pixels of the composed picture
  bool tracked = false;        ///< follows the viewer's eyes
  bool own_pixels = false;     ///< output is the panel's or the file's: a screen's pixels do not matter
  bool own_size = false;       ///< so are millimetres
  double aspect = 0.0;         ///< of what is seen, width / height; 0: that of `output`
  ViewFocus focus{};           ///< views of pictures that exist already are to be taken so (focus_source())
  bool exact_pixels = false;   ///< works only unscaled, at a known place on the panel
  bool stereo_visual = false;  ///< needs a quad-buffered context
  /// Pictures that take turns, one at each refresh of the monitor, for as long as anything is shown: 1, or 2 for
  /// shutters. Which one is due, FieldCadence says (display/sinks/field_cadence.h).
  int fields = 1;
  /// On a head: cameras are the wearer's own and new for every picture, whose turn the display waits for; objects stand
  /// in life size, and nothing lies over them.
  bool worn = false;
  bool see_through = false;   ///< what is not covered shows the room: the background is nothing
  std::string file_suffix{};  ///< what files of this picture carry before the extension, e.g. "_qs8x6a0.75"
};

class OutputSink {
 public:
  virtual ~OutputSink() = default;
  /// Valid after configure().
  virtual SinkTraits traits() const noexcept = 0;
  virtual Result<void> configure(const Screen& screen) = 0;
  /// The cameras for this viewer, traits().views of them; world is the screen frame. No GL. The span is good until the
  /// next call.
  virtual std::span<const View> views(const Observer& viewer) = 0;
  /// Draws the panel's picture from the layers; nothing is kept between fields. GL thread, with the context current
  /// that the sink is destroyed in.
  virtual Result<void> compose(const ViewArray& views, const Surface& target, Field field) = 0;
  /// For displays whose picture has one field.
  Result<void> compose(const ViewArray& views, const Surface& target) { return compose(views, target, Field::kFirst); }
  /// Of worn displays: who wears it, at the moment that the newest views() are for, in the screen frame.
  virtual std::optional<WearerFrame> wearer() const { return std::nullopt; }
  /// Of worn displays: "before me" is where the wearer looks now.
  virtual void recentre() {}
  /// Why nothing reaches anybody's eyes at the moment; empty: something does.
  virtual std::string note() const { return {}; }
  /// Of worn displays: another headset came, traits() hold after the next configure() only.
  virtual bool outdated() const { return false; }
  /// Of worn displays: the runtime shows none of our pictures now; the layers may stay as they are.
  virtual bool hidden() const { return false; }
  /// Of worn displays: the wearer chose to end; another session begins 10 s later.
  virtual bool ended() const { return false; }
  /// Where the panel's lenses send the light of what was composed last; nothing for displays without lenses.
  virtual std::optional<PanelLight> light() const { return std::nullopt; }
};

}  // namespace dubsar
