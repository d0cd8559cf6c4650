#pragma once
// What a run found and cost, for programs (JSON, snake_case keys) and for people (text).

#include <nlohmann/json.hpp>
#include <string>

#include "core/pipeline/pipeline.h"

namespace dubsar {

/// Keys: input, estimates, stages, mesh, segment, partitions, exa, parameters, warnings.
nlohmann::json report_json(const PipelineReport& report, const PipelineOptions& options);

/// The stage table, the estimates and the parts, in lines of at most 110 characters.
std::string report_text(const PipelineReport& report);

/// What goes into the product: input, parameters as used, estimates; no times, so that equal input gives equal bytes.
nlohmann::json provenance_json(const PipelineReport& report, const PipelineOptions& options);

/// Facts of a volume file, also for `dubsar info`.
nlohmann::json volume_json(const VolumeInfo& info);
nlohmann::json mesh_check_json(const MeshCheck& check);

}  // namespace dubsar
