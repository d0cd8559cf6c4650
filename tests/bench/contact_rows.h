#pragma once
// Phantoms of all kinds of contact between tablet and envelope, processed without options and judged by their truth.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/contact/trace.h"
#include "core/filter/edge_spread.h"
#include "core/mesh/exact_crossings.h"
#include "core/phantom/options.h"
#include "core/pipeline/detail.h"
#include "core/pipeline/stage_clock.h"
#include "tests/bench/settled_tablet.h"
#include "tests/bench/tablet_cover.h"
#include "tests/core/phantom/contact_score.h"

namespace dubsar {

struct ContactRow {
  std::string name;
  phantom::PhantomOptions options;
};

/// "text", "pressed", "pockets", "film 1.0" to "film 0.2", "filled", "unwritten", "unwritten film", "hard", "sharp",
/// "soft" (other point spreads), "two clays" (the envelope fills the wedges and is denser), "clear film" (30 dB), and
/// "X-ray pressed", "X-ray filled", "X-ray film 0.5" and "0.2" (of the simulated scanner), "wide film 0.5" and "0.2",
/// "wide pressed" (nearly half of the tablet): the first with `seed`, each other with one of its own.
std::vector<ContactRow> contact_rows(const Dims& dims, std::uint64_t seed);

/// Of the tablet's vertices that are not inferred.
struct TabletError {
  double rms = 0.0;  ///< from the tablet's true surface, voxels, where the gap is at least as wide as seen by the scan
  double stray = 0.0;  ///< share of all of them farther than three voxels
  SettledTablet settled;
  TabletCover cover;
};

/// Mean and half of the range of some values, at least one; of one: itself.
std::string spread_text(const std::vector<double>& values, int digits);

struct JudgedRow {
  phantom::ContactScore contact;
  phantom::TruthComparison seen;  ///< tablet and envelope, without what is inferred
  TabletError tablet;
  float sharpen = 0.0f;  ///< amount that was used
  float sharpen_wide = 0.0f;
  ExactCheck crossings;  ///< of tablet and envelope, each alone
  bool traced = false;
  std::optional<EdgeSpread> blur;
  double step = 1.0;   ///< voxels of the scan in one of the grid
  std::string remark;  ///< why nothing was traced
  double wall_s = 0.0, cpu_s = 0.0, peak_mib = 0.0, contact_cpu_s = 0.0;
  std::vector<StageRecord> stages;
};

struct JudgeOptions {
  Detail detail = Detail::kAuto;
  bool contact = true;  ///< traced in the scan
  bool light = false;   ///< with ambient occlusion, so that the times are those of `dubsar process`
  bool judge = true;    ///< false: times and memory only
  bool cover = false;   ///< fills in TabletError::cover
  bool places = false;  ///< prints where a wedge was invented
};

/// Writes the scan to a folder for temporary files, processes it and judges the result. Ends the program with a
/// sentence where something fails.
JudgedRow judge_row(const ContactRow& row, const JudgeOptions& how);

}  // namespace dubsar
