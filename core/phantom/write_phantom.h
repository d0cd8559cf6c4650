#pragma once
// `dubsar phantom`: the scan of a phantom and the truth about it as HDF5 files.

#include <array>
#include <filesystem>
#include <optional>

#include "core/base/progress.h"
#include "core/phantom/phantom.h"
#include "core/phantom/scanner/geometry.h"

namespace dubsar::phantom {

/// What a simulated scanner did.
struct ScannerReport {
  ScanGeometry geometry;
  double longest_mm = 0.0;   ///< path through clay
  double least_light = 1.0;  ///< behind it, of the open beam, without scatter
  double stray_light = 0.0;  ///< scatter there, of the open beam
  double clay_per_mm = 0.0;  ///< attenuation of the first millimetre
};

struct PhantomReport {
  PhantomOptions options;  ///< completed
  double sigma = 0.0;      ///< of the noise in the scan; of none of a simulated scanner
  std::optional<ScannerReport> scanner{};
  double glued_fraction = 0.0;
  bool cracked = false;
  int tablet_wedges = 0, envelope_wedges = 0, pores = 0;
  std::array<int, std::size(kWedgeCases)> wedges_by_case{};  ///< of the tablet's
};

/// Writes the scan to `scan` (NeXus: /entry/data/data float32 z y x, with axes in mm) and, if wanted, the truth:
///   /truth/label       uint8  z y x   Label of each voxel
///   /truth/distance    int16  z y x   signed distance to the clay's surface in 1/256 voxel, cut at Phantom::kReach
///   /truth/interface   int16  z y x   the same to the tablet's surface as if it were unwrapped: the true interface
///   where
///                                     it touches the envelope
///   /truth/wedges      float64 table, one row a wedge; the attribute "columns" names the columns; "case" is WedgeCase
/// Both files appear only when complete. Streams slabs of 16 slices: memory is some slices; a simulated scanner needs
/// what scan_object() says. Advances `progress` by voxels (stages "phantom" and "truth"). Errors: kUsage (options),
/// kCannotCreate, kPermission, kIo, kTryAgain (memory), kCancelled.
Result<PhantomReport> write_phantom(const std::filesystem::path& scan,
                                    const std::optional<std::filesystem::path>& truth, const PhantomOptions& options,
                                    Progress& progress);

/// Steps of stored distances per voxel.
inline constexpr double kDistanceSteps = 256.0;

/// Truth of slices [z_begin, z_end), x fastest: both spans hold slice * (z_end - z_begin) values. All threads.
void rasterise_truth(const Phantom& phantom, std::int64_t z_begin, std::int64_t z_end, std::span<std::uint8_t> label,
                     std::span<std::int16_t> distance);
/// The same for the distance to the tablet's surface as if it were unwrapped.
void rasterise_interface(const Phantom& phantom, std::int64_t z_begin, std::int64_t z_end,
                         std::span<std::int16_t> distance);

}  // namespace dubsar::phantom
