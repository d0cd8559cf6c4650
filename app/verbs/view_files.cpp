#include "app/verbs/view_files.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "app/cli/config_folder.h"
#include "app/cli/file_uses.h"
#include "app/cli/mesh_input.h"
#include "app/document/file_kinds.h"
#include "app/slices/scan_link.h"
#include "app/verbs/work_of_surface.h"
#include "app/viewer/first_document.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/files/file_suffix.h"
#include "core/base/system/log.h"
#include "core/exa/exa_file.h"
#include "core/parts/surface_model.h"
#include "core/volume/formats/import.h"
#include "input/source_spec.h"

namespace dubsar::app {
namespace {

/// What sessions on this surface left, and where this one keeps its own work.
void keep_work(SourceFile source, OpenedSurface& out) {
  out.session = std::make_unique<FileSession>(std::move(source), session_folder());
  if (!out.session->found()) return;
  out.work.document = *out.session->found();
  out.work.upright = false;
  out.work.restored = true;
  log_info("view: the work of the last session on this file is here again");
}

/// Of an EXA file with many vertices: every fourth point of the scan each way, or every second.
void tell_coarse(const std::filesystem::path& file, Progress& progress, const TellCoarse& tell) {
  constexpr std::int64_t kMany = 300'000, kFar = 800'000;
  const auto info = read_exa_info(file);
  if (!info || info->stats.vertices < kMany) return;
  const auto model = read_exa_level(file, info->stats.vertices < kFar ? 1 : 2, progress);
  if (!model) return;  // what is wrong with it, reading all of it says
  MeshOptions options;
  options.fill_holes = false;
  auto mesh = make_tri_mesh(*model, options);
  if (mesh && !mesh->triangles.empty()) tell(*std::move(mesh));
}

}  // namespace

ReadSurface surface_reader(const ViewOptions& options, const FileReading& reading) {
  return [options, reading](const std::filesystem::path& file, Progress& progress,
                            const TellCoarse& tell) -> Result<OpenedSurface> {
    OpenedSurface out;
    if (tell && reading.partitions.empty()) tell_coarse(file, progress, tell);
    DUBSAR_ASSIGN(out.mesh, load_mesh({file, reading.partitions, true, {reading.unit_mm, true}, true}, progress, tell));
    if (out.mesh.triangles.empty())
      return fail(ErrorKind::kBadData, "{}: there is no triangle in it, so there is nothing to show", file.string());
    ViewOptions with = options;
    out.work = options.work;
    out.work.surface = file;
    out.work.scan = reading.scan;
    out.work.upright = reading.upright;
    out.title = file.filename().string();
    DUBSAR_ASSIGN(out.work.document.source, source_of(file.string(), out.mesh));
    if (reading.keeps_work) keep_work(out.work.document.source, out);
    if (progress.cancelled()) return cancelled_error();
    progress.begin("open", 0, "surface");
    with.work = out.work;
    FirstDocument first = first_document(with, out.mesh);
    out.work.document = std::move(first.document);
    out.work.doubt = std::move(first.doubt);
    out.work.upright = false;
    progress.end();
    return out;
  };
}

ReadSurface beside_reader(ViewOptions options, FileReading reading) {
  options.work = {};
  reading.keeps_work = false;
  reading.scan.reset();
  return [read = surface_reader(options, reading)](const std::filesystem::path& file, Progress& progress,
                                                   const TellCoarse&) { return read(file, progress, {}); };
}

Result<std::optional<ImportOptions>> asked_scan(const std::string& scan, const InputOptionTexts& reading,
                                                const std::vector<std::string>& surfaces) {
  DUBSAR_ASSIGN(ImportOptions asked, parse_input_options(scan, reading));
  if (scan.empty()) {
    if (asked.raw || !asked.dataset.empty() || asked.axis_order)
      return fail(ErrorKind::kUsage, "view: options on how a scan is read found, expected --scan SCAN with them");
    return std::optional<ImportOptions>();
  }
  const auto info = surfaces.empty() ? Result<ExaInfo>(tl::unexpect, Error{}) : read_exa_info(surfaces.front());
  DUBSAR_ASSIGN(ImportOptions readable,
                readable_scan(std::move(asked), info ? std::string_view(info->provenance) : std::string_view()));
  return std::optional(std::move(readable));
}

Result<void> check_surface(const std::string& file, const std::vector<std::string>& partitions) {
  DUBSAR_TRY(check_surface_file(file));
  if (!std::ifstream(file).good()) return fail(ErrorKind::kPermission, "{}: it may not be read", file);
  if (lower_suffix(file) == ".exa") DUBSAR_TRY(read_exa_info(file));
  return check_parts(file, partitions);
}

Result<void> check_record(const std::string& record, const std::vector<std::string>& sources) {
  if (record.empty()) return {};
  std::vector<FileUse> files{{"--record", record, true}};
  for (const std::string& text : sources) {
    DUBSAR_ASSIGN(const SourceSpec source, parse_source(text));
    for (const Option& option : source.options) {
      std::error_code ignored;
      const std::string& word = option.value ? *option.value : option.key;
      if (std::filesystem::is_regular_file(word, ignored)) files.push_back({"--input", word});
    }
  }
  return check_file_uses(files);
}

Result<void> check_frames(const std::string& folder) {
  std::error_code error;
  if (folder.empty() || !std::filesystem::is_directory(folder, error)) return {};
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (const std::string name = at->path().filename().string(); name.starts_with("frame-") && name.ends_with(".png"))
      DUBSAR_TRY(check_made("--frames", at->path(), FileFormat::kPicture));
  return {};
}

}  // namespace dubsar::app
