#include "core/pipeline/report.h"

#include <fmt/format.h>

#include <cmath>

#include "core/pipeline/pipeline.h"

namespace dubsar {
using nlohmann::json;

namespace {

json dims_json(const Dims& dims) { return {dims.x, dims.y, dims.z}; }
json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

json parameters_json(const PipelineReport& report, const PipelineOptions& options) {
  const auto& denoise = options.denoise;
  return {
      {"detail", name_in(kDetails, report.detail.detail)},
      {"resample", report.detail.resample()},
      {"artefacts", name_in(kArtefacts, options.artefacts)},
      {"denoise",
       {{"method", name_in(kDenoiseMethods, denoise.method)},
        {"range", name_in(kRangeWeights, denoise.range)},
        {"window", denoise.window},
        {"iterations", denoise.iterations},
        {"sigma", denoise.sigma > 0.0 ? json(denoise.sigma) : json("estimated")}}},
      {"sharpen", report.surface_by.sharpen},
      {"sharpen_wide", report.surface_by.sharpen_wide},
      {"fairing", report.surface_by.fairing},
      {"threshold_method", options.threshold ? "given" : name_in(kThresholdMethods, options.estimate.method)},
      {"threshold", report.threshold.value},
      {"levels", name_in(kLevels, options.sample.levels)},
      {"offset_bits", options.sample.offset_bits},
      {"boundary", options.sample.closed ? "closed" : "open"},
      {"normal_iterations", options.smooth.normals.iterations},
      {"vertex_iterations", options.smooth.vertex_iterations},
      {"curvature", options.curvature == CurvatureMethod::kFit ? "fit" : "pairs"},
      {"segment", name_in(kSegmentMethods, options.segment.method)},
      {"fill_holes", options.fill_holes},
      {"occlusion", options.occlusion
                        ? json{{"rays", options.occlusion->rays}, {"radius_vox", options.occlusion->radius_vox}}
                        : json(nullptr)},
  };
}

json input_json(const PipelineReport& report) {
  const ScanFacts& scan = report.scan;
  json input = volume_json(scan.info);
  input["unmeasured"] = unmeasured_json(scan.unmeasured);
  input["unmeasured_voxels"] = scan.unmeasured_voxels.all();
  input["nonfinite_voxels"] = scan.unmeasured_voxels.nonfinite;
  input["grid"] = dims_json(scan.grid);
  return input;
}

json blur_json(const std::optional<EdgeSpread>& blur) {
  if (!blur) return nullptr;
  return {{"deviation_vox", std::sqrt(blur->variance)},
          {"variance_vox2", blur->variance},
          {"uncertainty_vox2", blur->uncertainty},
          {"places", blur->places},
          {"double_edges", blur->doubled ? json{{"axis", std::string(1, "xyz"[blur->doubled->axis])},
                                                {"apart_vox", blur->doubled->apart},
                                                {"text", describe(*blur->doubled)}}
                                         : json(nullptr)}};
}

json levels_json(const std::optional<LocalLevels>& levels) {
  if (!levels) return nullptr;
  return {{"least", levels->least}, {"most", levels->most}, {"followed", !levels->shift.empty()}};
}

json estimates_json(const PipelineReport& report) {
  json filters = json::array();
  for (const FilterStep& step : report.filters)
    filters.push_back({{"after", step.name},
                       {"sigma", step.estimates.sigma},
                       {"snr_db", step.estimates.snr_db},
                       {"snr_alt_db", step.estimates.snr_alt_db},
                       {"air", step.estimates.m_lo},
                       {"material", step.estimates.m_hi},
                       {"path", step.estimates.path}});
  const Estimates& last = report.filters.back().estimates;
  return {{"sigma", last.sigma},
          {"snr_db", last.snr_db},
          {"air", last.m_lo},
          {"material", last.m_hi},
          {"material_fraction", last.material_fraction},
          {"threshold", report.threshold.value},
          {"threshold_valley", last.threshold_valley},
          {"path", report.threshold.path},
          {"levels", levels_json(report.surface_by.levels)},
          {"blur", blur_json(report.scan.blur)},
          {"filters", filters}};
}

json artefacts_json(const PipelineReport& report) {
  if (!report.scan.rays) return nullptr;
  const RaysReport& rays = *report.scan.rays;
  json result{{"bent_rays", rays.bent ? bent_rays_json(*rays.bent) : json(nullptr)},
              {"straightened", rays.straightened.has_value()},
              {"axis_shift_vox", rays.straightened ? json(rays.straightened->axis_shift.pixels) : json(nullptr)},
              {"seen_bend", {{"bend", rays.seen.bend}, {"share", rays.seen.share}}},
              {"text", rays_text(rays, report.scan.frame)}};
  if (const auto& rings = report.scan.rings)
    result["rings"] = {{"centre_vox", {rings->look.centre.x, rings->look.centre.y}},
                       {"deviation", rings->deviation},
                       {"strongest", rings->strongest},
                       {"alike", rings->look.alike},
                       {"text", describe(*rings)}};
  if (report.scan.holder) result["holder"] = holder_json(*report.scan.holder, report.scan.frame.input_voxel);
  if (!rays.why_not.empty()) result["why_not"] = rays.why_not;
  if (rays.bent) result["advice"] = kAdviceForBentRays;
  return result;
}

json segment_json(const PipelineReport& report) {
  json segment{{"nested", report.segment.nested},
               {"enclosure_refused", report.segment.enclosure_refused},
               {"crack_radius_vox", report.segment.crack_radius},
               {"components", report.segment.components},
               {"small_pieces", report.segment.small_pieces},
               {"cut_length_vox", report.segment.cut_length}};
  if (const auto& holes = report.holes)
    segment["holes"] = {{"loops", holes->loops},
                        {"unshared", holes->unshared},
                        {"longest_loop", holes->longest_loop},
                        {"triangles", holes->triangles},
                        {"area_vox2", holes->area}};
  return segment;
}

json band_json(const std::optional<BandReport>& band) {
  if (!band) return nullptr;
  return {{"share", band->share}, {"bricks", band->bricks}, {"bricks_added", band->added}, {"bricks_cut", band->cut}};
}

json contact_json(const ContactReport& contact) {
  json result{{"traced", contact.traced},
              {"points", contact.points},
              {"pockets", contact.pockets},
              {"film_vertices", contact.film_vertices},
              {"inferred_vertices", contact.inferred_vertices},
              {"clays_differ", contact.clays_differ},
              {"touching", contact.touching}};
  if (!contact.traced) result["why"] = contact.why;
  return result;
}

json exa_json(const ExaStats& stats) {
  json blocks = json::object();
  for (const ExaBlockStats& block : stats.blocks)
    blocks[block.name] = {{"bytes", block.bytes}, {"bits_per_vertex", block.bits_per_vertex}};
  return {{"bytes", stats.bytes}, {"bits_per_vertex", stats.bits_per_vertex}, {"blocks", blocks}};
}

}  // namespace

PipelineReport make_report(const StageResults& results, const SurfaceModel& model, const StageClock& clock) {
  PipelineReport report{.scan = results.imported.facts,
                        .filters = {results.imported.raw},
                        .threshold = results.threshold,
                        .surface_by = {results.sampled.sharpen, results.sampled.sharpen_wide, results.sampled.fairing,
                                       results.sampled.noise, results.sampled.levels},
                        .moves = {results.smoothed.stats, results.settled.stats},
                        .segment = results.separated.segment,
                        .holes = results.separated.holes,
                        .contact = results.contact,
                        .detail = {results.imported.detail, results.band},
                        .mesh = results.check,
                        .surface = {model.mesh.vertex_count(), model.mesh.quad_count()},
                        .partitions = model.partitions,
                        .exa = {},
                        .stages = clock.records()};
  if (!results.sampled.warning.empty()) report.scan.warnings.push_back(results.sampled.warning);
  report.filters.insert(report.filters.end(), results.filters.begin(), results.filters.end());
  return report;
}

json volume_json(const VolumeInfo& info) {
  json candidates = json::array();
  for (const VolumeCandidate& candidate : info.candidates)
    candidates.push_back({{"dataset", candidate.dataset}, {"dims_zyx", candidate.dims}, {"dtype", candidate.dtype}});
  return {{"path", info.path},
          {"fingerprint", info.fingerprint.empty() ? json(nullptr) : json(info.fingerprint)},
          {"format", info.format},
          {"dataset", info.dataset},
          {"found_by", info.found_by},
          {"dims", dims_json(info.box.dims())},
          {"file_dims", dims_json(info.file_dims)},
          {"axes",
           {{"order", info.axes.letters()},
            {"stated_by", info.axes.known() ? json(info.axes.provenance) : json(nullptr)},
            {"mirrored_as_stored", info.axes.mirrored_as_stored()}}},
          {"dtype", info.stored.dtype},
          {"byte_order", info.stored.byte_order},
          {"layout", info.stored.layout},
          {"filters", info.stored.filters},
          {"storage_bytes", info.stored.storage_bytes},
          {"logical_bytes", info.stored.logical_bytes},
          {"voxel_size_mm", info.voxel.known() ? vector_json(info.voxel.mm) : json(nullptr)},
          {"provenance", info.voxel.known() ? info.voxel.provenance : "unknown"},
          {"other_datasets", candidates}};
}

json unmeasured_json(const Unmeasured& unmeasured) {
  if (!unmeasured.left_out()) return nullptr;
  return {{"share", unmeasured.share},     {"outside", unmeasured.outside}, {"each_slice", unmeasured.each_slice},
          {"ignored", unmeasured.ignored}, {"counts_as", unmeasured.fill},  {"at_rim", unmeasured.at_rim},
          {"text", describe(unmeasured)}};
}

json bent_rays_json(const BentRays& bent) {
  return {{"axis", std::string(1, "xyz"[static_cast<int>(bent.axis)])},
          {"longest_ray_vox", bent.longest_vox},
          {"contrast_on_longest_ray", bent.contrast},
          {"curve",
           {{"coefficients", bent.curve.coefficients},
            {"longest_recorded_vox", bent.curve.longest},
            {"stray", bent.curve.stray},
            {"stray_spread_vox", bent.stray ? json(bent.stray->spread()) : json(nullptr)}}},
          {"uneven_air", {{"before", bent.before.air}, {"after", bent.after.air}}},
          {"uneven_clay", {{"before", bent.before.clay}, {"after", bent.after.clay}}},
          {"cut_by_border", bent.cut_by_border}};
}

json holder_json(const Holder& holder, const VoxelSize& voxel) {
  return {{"of_clay", holder.of_clay()},
          {"share", holder.share},
          {"axis", std::string(1, "xyz"[holder.axis])},
          {"at_high_end", holder.at_high_end},
          {"reach_vox", holder.reach_vox},
          {"at_border", holder.at_border},
          {"counts_as_air", holder.counts_as_air()},
          {"text", describe(holder, voxel)}};
}

json mesh_check_json(const MeshCheck& check) {
  return {{"vertices", check.vertices},
          {"triangles", check.triangles},
          {"edges", check.edges},
          {"nonmanifold_edges", check.nonmanifold_edges},
          {"nonmanifold_vertices", check.nonmanifold_vertices},
          {"inconsistent_edges", check.inconsistent_edges},
          {"degenerate_triangles", check.degenerate_triangles},
          {"zero_area_triangles", check.zero_area_triangles},
          {"boundary_edges", check.boundary_edges},
          {"components", check.components},
          {"euler", check.euler}};
}

json provenance_json(const PipelineReport& report, const PipelineOptions& options) {
  return {{"program", "dubsar"},
          {"input", input_json(report)},
          {"artefacts", artefacts_json(report)},
          {"estimates", estimates_json(report)},
          {"parameters", parameters_json(report, options)}};
}

json report_json(const PipelineReport& report, const PipelineOptions& options) {
  json stages = json::array();
  for (const StageRecord& stage : report.stages)
    stages.push_back({{"name", stage.name},
                      {"wall_s", stage.wall_s},
                      {"cpu_s", stage.cpu_s},
                      {"peak_rss_mib", stage.peak_rss_mib},
                      {"work", stage.work},
                      {"work_unit", stage.unit}});
  json mesh = mesh_check_json(report.mesh);
  mesh["vertices"] = report.surface.vertices;
  mesh["xquads"] = report.surface.xquads;
  mesh["export_vertices"] = report.mesh.vertices;
  mesh["noise_cavities"] = {{"cavities", report.surface_by.noise.cavities}, {"points", report.surface_by.noise.points}};
  mesh["smooth"] = {{"mean_displacement_vox", report.moves.smooth.mean_displacement_vox},
                    {"max_displacement_vox", report.moves.smooth.max_displacement_vox},
                    {"clamped_fraction", report.moves.smooth.clamped_fraction},
                    {"residual_angle_deg", report.moves.smooth.residual_angle_deg}};
  mesh["settle"] = {{"mean_error_vox", report.moves.settle.mean_error_vox},
                    {"p95_error_vox", report.moves.settle.p95_error_vox},
                    {"max_error_vox", report.moves.settle.max_error_vox},
                    {"escaped_fraction", report.moves.settle.escaped_fraction},
                    {"normal_error_deg", report.moves.settle.normal_error_deg}};
  return {{"input", input_json(report)},
          {"artefacts", artefacts_json(report)},
          {"estimates", estimates_json(report)},
          {"stages", stages},
          {"mesh", mesh},
          {"detail", {{"grid", name_in(kDetails, report.detail.detail)}, {"why", report.detail.why}}},
          {"band", band_json(report.detail.band)},
          {"segment", segment_json(report)},
          {"contact", report.contact ? contact_json(*report.contact) : json(nullptr)},
          {"partitions", partitions_json(report.partitions)},
          {"exa", exa_json(report.exa)},
          {"parameters", parameters_json(report, options)},
          {"warnings", report.scan.warnings}};
}

std::string report_text(const PipelineReport& report) {
  std::string text =
      fmt::format("{:<14}{:>10}{:>10}{:>12}{:>16}  {}\n", "stage", "wall s", "cpu s", "peak MiB", "work", "");
  double wall = 0.0, cpu = 0.0, peak = 0.0;
  for (const StageRecord& stage : report.stages) {
    text += fmt::format("{:<14}{:>10.2f}{:>10.2f}{:>12.0f}{:>16}  {}\n", stage.name, stage.wall_s, stage.cpu_s,
                        stage.peak_rss_mib, stage.work, stage.unit);
    wall += stage.wall_s;
    cpu += stage.cpu_s;
    peak = std::max(peak, stage.peak_rss_mib);
  }
  text += fmt::format("{:<14}{:>10.2f}{:>10.2f}{:>12.0f}\n\n", "all", wall, cpu, peak);
  for (const FilterStep& step : report.filters)
    text += fmt::format("noise {:<22} sigma {:<11.4g} SNR {:5.1f} dB\n", step.name, step.estimates.sigma,
                        step.estimates.snr_db);
  if (const auto& blur = report.scan.blur; blur && blur->variance > blur->uncertainty)
    text += fmt::format("blur of edges {:.2f} voxel, measured at {} flat places\n", std::sqrt(blur->variance),
                        blur->places);
  if (report.scan.unmeasured.left_out()) text += describe(report.scan.unmeasured) + "\n";
  if (report.scan.rings) text += describe(*report.scan.rings) + "\n";
  if (report.scan.holder) text += describe(*report.scan.holder, report.scan.frame.input_voxel) + "\n";
  if (report.scan.rays) text += rays_text(*report.scan.rays, report.scan.frame) + "\n";
  text += fmt::format("detail {}: {}\n", name_in(kDetails, report.detail.detail), report.detail.why);
  if (const auto& band = report.detail.band)
    text += fmt::format("band: {:.1f} % of the scan is near the surface and was filtered\n", 100.0 * band->share);
  text += fmt::format("threshold {:.6g}: {}\n", report.threshold.value, report.threshold.path);
  if (report.surface_by.levels) text += "levels: " + describe(*report.surface_by.levels) + "\n";
  if (report.surface_by.noise.cavities > 0)
    text += fmt::format("{} closed cavities of {} points are smaller or fainter than noise and count as clay\n",
                        report.surface_by.noise.cavities, report.surface_by.noise.points);
  text +=
      fmt::format("mesh: {} vertices, {} x-quads, {} triangles, {} non-manifold edges, {} non-manifold vertices\n\n",
                  report.surface.vertices, report.surface.xquads, report.mesh.triangles, report.mesh.nonmanifold_edges,
                  report.mesh.nonmanifold_vertices);
  text += fmt::format("parts: {} surfaces, {}{}", report.segment.components,
                      report.segment.nested ? "a body inside another" : "no body inside another",
                      report.segment.enclosure_refused ? " that fills its cavity as a tablet would" : "");
  if (report.segment.crack_radius > 0)
    text += fmt::format(", cracks up to {} steps closed", 2 * report.segment.crack_radius + 1);
  if (report.segment.nested) text += fmt::format(", cut along {:.0f} steps", report.segment.cut_length);
  if (report.holes) text += fmt::format(", {} holes filled", report.holes->loops);
  if (const auto& contact = report.contact; contact && contact->traced)
    text += fmt::format(", contact: {} pockets, {} vertices of films, {} inferred", contact->pockets,
                        contact->film_vertices, contact->inferred_vertices);
  else if (contact)
    text += fmt::format(", contact not traced in the scan: {}", contact->why);
  if (const auto& contact = report.contact; contact && contact->touching > 0)
    text += fmt::format(", polygons of {} cells touch others", contact->touching);
  text += fmt::format("\n{:<4}{:<24}{:>14}{:>14}  {}\n", "id", "part", "area mm2", "volume mm3", "");
  for (const Partition& part : report.partitions)
    text += fmt::format("{:<4}{:<24}{:>14.1f}{:>14.1f}  {}\n", part.id, part.name, part.area_mm2, part.volume_mm3,
                        part.watertight ? "watertight" : "open");
  if (report.exa.bytes > 0)
    text += fmt::format("\nEXA: {} bytes, {:.2f} bits per vertex\n", report.exa.bytes, report.exa.bits_per_vertex);
  return text;
}

}  // namespace dubsar
