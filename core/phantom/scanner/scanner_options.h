#pragma once
// What scans a phantom: the beam, the panel, the turn and the file that the scanner writes.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/text/enum_names.h"

namespace dubsar::phantom {

struct BeamOptions {
  double kv = 160.0;        ///< voltage of the tube
  double copper_mm = 1.5;   ///< filter before it
  double mono_kev = 0.0;    ///< all photons of this energy instead; 0: the tube's spectrum
  double clay_g_cm3 = 1.8;  ///< density of dry clay
  double lime = 0.15;       ///< share of calcite in it by mass
};

struct PanelOptions {
  double photons = 5e5;      ///< to a pixel and view in the open beam; 0: no noise
  double electronic = 20.0;  ///< standard deviation of the reading, photons
  double scatter = 0.01;     ///< behind the middle of the panel, mean over the turn, of the open beam
  double spread_mm = 25.0;   ///< standard deviation of scatter on the panel
  double glare = 0.0;        ///< share of the light that strays within the panel
  double rings = 0.0005;     ///< standard deviation of the pixels' gains after the flat field
  double bad = 0.0;          ///< share of pixels that are off by ten times that, or by 1 % at least
  double blur_vox = 0.4;     ///< standard deviation of focal spot, motion and panel together, at the object
};

/// Of the ramp filter; only the last two vanish where the samples end, so that a single bad pixel does not ring.
enum class Window : std::uint8_t { kNone, kShepp, kCosine, kHann };
inline constexpr EnumName<Window> kWindows[] = {
    {Window::kNone, "none"}, {Window::kShepp, "shepp"}, {Window::kCosine, "cosine"}, {Window::kHann, "hann"}};
static_assert(names_all(kWindows, static_cast<std::size_t>(Window::kHann) + 1));

struct TurnOptions {
  bool full = true;              ///< else half a turn: 180 degrees, and the fan's angle in a cone
  int views = 0;                 ///< 0: by the next
  double views_per_voxel = 1.5;  ///< of the wider side
  double cone_deg = 5.0;   ///< from the middle plane to the end of the volume, seen from the source; 0: parallel rays
  double axis_px = 0.0;    ///< how far the axis of rotation lies from where the reconstruction takes it, pixels
  double start_deg = 0.0;  ///< direction to the source in the first view, from x to y
  Window window = Window::kCosine;
};

enum class ScanFile : std::uint8_t { kFloat, kUint16, kHu };
inline constexpr EnumName<ScanFile> kScanFiles[] = {
    {ScanFile::kFloat, "float"}, {ScanFile::kUint16, "uint16"}, {ScanFile::kHu, "hu"}};
static_assert(names_all(kScanFiles, static_cast<std::size_t>(ScanFile::kHu) + 1));

/// What stands outside the scanner's circle.
enum class Pad : std::uint8_t { kNone, kLeast, kNan, kValue };

struct FileOptions {
  ScanFile type = ScanFile::kFloat;  ///< 1/mm; uint16 with scale_factor and add_offset; int16, water 0, air -1000
  Pad pad = Pad::kNone;              ///< kNone: what the reconstruction gives
  double pad_value = 0.0;            ///< of Pad::kValue, as the file stores it
  int blank = 0;                     ///< slices without data at either end: 0, or the value of the circle
};

struct ScannerOptions {
  BeamOptions beam;
  PanelOptions panel;
  TurnOptions turn;
  FileOptions file;
  std::string text;  ///< that they were read from
};

/// "[good|mild|medium|strong|ideal][,key=value...]"; the word stands first, without one it is good. Behind the longest
/// ray of a tablet of 59 mm the four keep 12, 10, 8 and 5 % of the light, and scatter adds .05, .2, .5 and 2 times as
/// much.
/// - good: 160 kV behind 1.5 mm of copper, the panel far away and the beam collimated (1 % scatter), fresh flat fields
/// - mild: 150 kV, 1 mm; 3 % scatter, gains known to .2 %, the axis to .1 pixel
/// - medium: 130 kV, .5 mm, 1.25 views a voxel; 6 % scatter, .5 %, .25 pixel, a fifth of the photons
/// - strong: 120 kV, .5 mm, 1 view a voxel; dense clay near the panel; 20 % scatter, 1 %, .5 pixel, a tenth of the
///   photons
/// - ideal: 80 keV, no noise, scatter, rings: what the reconstruction alone does
/// Keys: kv, filter (mm of copper), mono (keV), clay (g/cm3), lime, photons, electronic, scatter, spread (mm), glare,
/// rings, bad, blur (voxels), turn=half|full, views, cone (degrees), axis (pixels), start (degrees),
/// window=none|shepp|cosine|hann, file=float|uint16|hu, pad=none|min|nan|NUMBER, blank (slices).
/// kUsage with what was found and what is expected.
Result<ScannerOptions> parse_scanner(std::string_view text);

}  // namespace dubsar::phantom
