#pragma once
// What a run found and cost, made at its end from what the stages returned; for programs (JSON, snake_case keys) and
// for people (text).

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/exa/exa_file.h"
#include "core/pipeline/contact_stage.h"
#include "core/pipeline/surface_stages.h"
#include "core/pipeline/volume_stages.h"
#include "core/refine/surface_band.h"

namespace dubsar {

struct PipelineOptions;

/// Of the product, where neighbouring parts share their vertices.
struct SurfaceSize {
  std::int64_t vertices = 0, xquads = 0;
};

/// How far vertices were moved: by smoothing, and to where the product's file can say that they are.
struct VertexMoves {
  SmoothStats smooth;
  SettleStats settle;
};

/// What was decided where the isosurface was sampled.
struct SurfaceDecisions {
  float sharpen = 0.0f;               ///< amount that was used
  float sharpen_wide = 0.0f;          ///< the same, against a Gauss of 7 voxels
  float fairing = 0.0f;               ///< share of what noise and blur did to the surface that was taken back
  NoiseCavities noise;                ///< that became clay
  std::optional<LocalLevels> levels;  ///< where they were measured
};

struct DetailTaken : DetailChoice {
  std::optional<BandReport> band;  ///< at the scan's resolution: how much of it was filtered
};

struct PipelineReport {
  ScanFacts scan;
  std::vector<FilterStep> filters;  ///< the raw scan, then before and after each pass; the last ones gave the threshold
  Threshold threshold;
  SurfaceDecisions surface_by;
  VertexMoves moves;
  SegmentReport segment;
  std::optional<HoleReport> holes;       ///< when holes were filled
  std::optional<ContactReport> contact;  ///< when tablet and envelope were told apart where they touch
  DetailTaken detail;
  MeshCheck mesh;  ///< of all parts together, with their fill patches
  SurfaceSize surface;
  PartitionTable partitions;
  ExaStats exa;  ///< once the product is written
  std::vector<StageRecord> stages;
};

/// What the stages returned; what a later stage took over from it (grids, meshes) may be gone.
struct StageResults {
  const ImportedGrid& imported;
  const std::vector<FilterStep>& filters;
  const Threshold& threshold;
  const SampledSurface& sampled;
  const std::optional<BandReport>& band;
  const SmoothedMesh& smoothed;
  const SettledModel& settled;
  const SeparatedModel& separated;
  const std::optional<ContactReport>& contact;
  const MeshCheck& check;
};

/// The one place where a report is made.
PipelineReport make_report(const StageResults& results, const SurfaceModel& model, const StageClock& clock);

/// Keys: input, artefacts, estimates, stages, mesh, detail, segment, contact, patches, partitions, exa, parameters,
/// warnings.
nlohmann::json report_json(const PipelineReport& report, const PipelineOptions& options);

/// The stage table, the estimates and the parts, in lines of at most 110 characters.
std::string report_text(const PipelineReport& report);

/// What goes into the product: input, parameters as used, estimates; no times, so that equal input gives equal bytes.
nlohmann::json provenance_json(const PipelineReport& report, const PipelineOptions& options);

/// Facts of a volume file, also for `dubsar info`.
nlohmann::json volume_json(const VolumeInfo& info);
/// null where every voxel is a measurement.
nlohmann::json unmeasured_json(const Unmeasured& unmeasured);
nlohmann::json bent_rays_json(const BentRays& bent);
/// `voxel`: of the scan.
nlohmann::json holder_json(const Holder& holder, const VoxelSize& voxel);
nlohmann::json mesh_check_json(const MeshCheck& check);

}  // namespace dubsar
