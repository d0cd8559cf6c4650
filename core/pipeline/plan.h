#pragma once
// The plan of a run as data: one table of its stages, in their order, with what each reads, writes and costs. The run
// itself, its forecast, the choice of its grid, the check of the room and the program's progress all come from it.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/volume/grid_store.h"

namespace dubsar {

/// In the order in which they run.
enum class RunStage {
  kImport,
  kRays,
  kDenoise,
  kSurface,
  kMesh,
  kSmooth,
  kSettle,
  kParts,
  kContact,
  kLight,
  kCheck,
  kWrite
};
inline constexpr std::size_t kStages = static_cast<std::size_t>(RunStage::kWrite) + 1;

/// What stages hand on. A value takes memory from the stage that writes it to the last one that reads it.
enum class Value { kScan, kHalf, kStraight, kSamples, kMesh, kAttributes, kParts, kChecked };
inline constexpr std::size_t kValues = static_cast<std::size_t>(Value::kChecked) + 1;

/// A set of values.
struct Values {
  unsigned bits = 0;
  constexpr bool has(Value v) const { return (bits >> static_cast<unsigned>(v) & 1U) != 0; }
};
constexpr Values operator|(Values set, Value v) { return {set.bits | 1U << static_cast<unsigned>(v)}; }

/// Rays are straightened.
struct StraightPlan {
  GridPlace place = GridPlace::kMemory;  ///< of the straightened grid
  double core_s = 0.0;                   ///< seconds of one core
};

/// What is done about noise.
struct NoisePlan {
  int passes = 2;          ///< of the denoising filter
  bool made_fair = false;  ///< what is left of it moves the surface, which is made fair and extracted anew
};

/// All that the cost of a run depends on.
struct RunShape {
  Dims scan = {};
  bool half = true;       ///< the surface is that of the halved grid; else it is refined at the scan's resolution
  double vertices = 0.0;  ///< of the surface
  double patches = -1.0;  ///< triangles of fill patches; < 0: as many as usual
  GridPlace half_place = GridPlace::kMemory;  ///< of the halved grid
  bool artefacts = true;                      ///< are looked for
  std::optional<StraightPlan> straight;       ///< and found: rays are straightened
  bool fill_holes = true, contact = true;     ///< holes are filled, where tablet and envelope touch is traced
  double layer_bytes = 0.0;                   ///< of a layer of chunks that the scan's source keeps
  NoisePlan noise;
  double rays = 160.0;     ///< of ambient light a vertex; 0: none
  double read_s = 1.1e-9;  ///< seconds of one core for a voxel that is read
  int threads = 2;
  double slowness = 1.0;  ///< seconds of this machine for one of the table's machine
};

/// A phase of a stage, as Progress::begin() names it, and its part of the stage's time.
struct StagePhase {
  const char* name = nullptr;
  double share = 0.0;
};

struct StagePlan {
  RunStage stage;
  const char* when;  ///< "while the contact is traced"
  Values reads, writes;
  bool surface;                           ///< works on the surface, else on voxels
  double serial;                          ///< part of core_s that other threads wait for
  bool (*wanted)(const RunShape&);        ///< whether the run goes through it
  double (*work_bytes)(const RunShape&);  ///< memory beside the values that are there
  double (*core_s)(const RunShape&);      ///< seconds of one core
  std::array<StagePhase, 9> phases = {};  ///< those without a name are not there
};

extern const std::array<StagePlan, kStages> kRunPlan;

/// Memory of a value while it is there.
double bytes_of(Value value, const RunShape& run);

struct RunCost {
  double bytes = 0.0;                 ///< most memory at any time, beside the program as it was before
  const char* when = "";              ///< that is
  double core_s = 0.0, wall_s = 0.0;  ///< of one core; by the clock, nobody else at work
  double scratch_bytes = 0.0;         ///< most on the disk
};

/// Memory while a stage runs: all values that are there, and its own.
double bytes_while(const StagePlan& stage, const RunShape& run);

/// Of the stages from `first` on. Memory errs by up to a third on the side of too much.
RunCost cost_of(const RunShape& run, RunStage first = RunStage::kImport);

/// kTryAgain where the stages from `first` on would take more than `room` bytes, with what, when and how much.
Result<void> check_fits(const RunShape& run, std::uint64_t room, RunStage first = RunStage::kImport);

/// What a product of this shape takes on the disk.
double product_bytes(const RunShape& run);

/// The grid on which the surface of a scan is found.
Dims grid_of(const Dims& scan, bool half);

/// Vertices of the surface of a tablet in its envelope, from the size of its grid alone.
double usual_vertices(const Dims& grid);

/// How many neighbours share the rays of ambient light (occlusion.h): 1 but for large surfaces of the scan's own
/// resolution, where light would take longer than all else.
int sharers_of_rays(bool half, double vertices);

}  // namespace dubsar
