#pragma once
// What to make: size, seed and noise of a phantom.

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/phantom/scanner/scanner_options.h"
#include "core/volume/volume.h"

namespace dubsar::phantom {

/// What lies between tablet and envelope where they touch.
enum class Contact : std::uint8_t {
  kPressed,  ///< the envelope's clay sinks some voxels into the tablet's: no interface, pockets of air deep in wedges
  kPockets,  ///< it lies on the tablet's surface and bridges the wedges: they stay full of air
  kFilled,   ///< it fills the wedges too: nothing of them is in the scan
  kFilm,     ///< it follows the tablet and all its wedges at the thickness of a film of air
};

inline constexpr EnumName<Contact> kContacts[] = {{Contact::kPressed, "pressed"},
                                                  {Contact::kPockets, "pockets"},
                                                  {Contact::kFilled, "filled"},
                                                  {Contact::kFilm, "film"}};
static_assert(names_all(kContacts, static_cast<std::size_t>(Contact::kFilm) + 1));

/// Of a point spread [1 4 1]/6 along each axis: sqrt(1/3), voxels.
inline constexpr double kUsualBlur = 0.57735026918962576;

/// What a scan may have besides, relative to clay; 0: nothing.
struct AddedArtefacts {
  double cupping = 0.0;  ///< how much less clay counts at the axis of rotation
  double streaks = 0.0;  ///< standard deviation of streaks between dense points
  double holder = 0.0;   ///< density of the holder that the lower end stands in
};

/// How the tablet was written on, and the envelope sealed.
struct WritingOptions {
  bool written = true;      ///< false: nobody wrote on the tablet
  bool ruled = true;        ///< lines are ruled; nothing else changes
  double pushed = 0.0;      ///< clay that a later wedge pushes into an earlier one beside it, of its depth
  double seals_lost = 0.0;  ///< share of each band of the envelope whose sealing is worn level or broken away
};

struct PhantomOptions {
  Dims dims{512, 272, 472};
  std::uint64_t seed = 1;
  double snr_db = 17.0;   ///< 20 log10((clay - air) / sigma); infinity: no noise
  double voxel_mm = 0.0;  ///< 0: the envelope (5.9 x 2.1 x 6.1 cm, as AO 8295 in the paper) fills the grid
  Contact contact = Contact::kPressed;
  double film_vox = 0.5;          ///< thickness of the film of Contact::kFilm
  double contact_share = 0.0;     ///< of the tablet's surface that touches the envelope; 0: drawn from 0.08 to 0.26
  double gap_vox = 0.0;           ///< between tablet and envelope elsewhere; 0: 0.3 mm, at least some voxels
  double wedge_depth_vox = 0.0;   ///< of a usual wedge; 0: 7 voxels, or more where 3.6 mm a line are more
  WritingOptions writing{};       ///< on the tablet
  double envelope_density = 1.0;  ///< of the envelope's clay, relative to the tablet's
  double rings = 0.0;             ///< standard deviation of ring artefacts, relative to clay
  double blur_vox = kUsualBlur;   ///< standard deviation of the point spread along each axis, 0.3 to 1.1
  AddedArtefacts artefacts{};
  std::optional<ScannerOptions> scanner{};  ///< a simulated scanner instead of snr_db, blur_vox and artefacts
};

/// "tiny" 96x64x96, "demo" 512x272x472, "paper" 1871x999x1723 (38 um). kUsage for any other name.
Result<PhantomOptions> parse_preset(std::string_view name);

/// Checks size (32 voxels to 65535 along each axis, and the memory budget's voxel limit), noise (0..120 dB or
/// infinity), voxel edge, film (0.05 to 2 voxels), pushed clay (up to 0.5), lost sealings (up to 0.9), share of contact
/// (up to 0.6), gap (1 to 64 voxels), wedges (2 to 64 voxels), density (0.5 to 1.5), rings (up to 1), blur (0.3
/// to 1.1), cupping (up to 0.5), streaks (up to 0.3) and holder (0.02 to 3), and fills in voxel_mm when it is 0.
/// kUsage.
Result<PhantomOptions> complete(PhantomOptions options);

/// The scan shows a border between the two clays: a film of air, or different densities.
inline bool tells_clays_apart(const PhantomOptions& options) {
  return options.contact == Contact::kFilm || options.envelope_density != 1.0;
}

// Mass-attenuation-like grey values of the paper's scan (figures 6 to 8).
inline constexpr float kClayDensity = 0.0017f;
inline constexpr float kAirDensity = 0.0f;
inline constexpr float kOrganicDensity = 0.0006f;
inline constexpr float kGrainDensity = 0.0032f;

}  // namespace dubsar::phantom
