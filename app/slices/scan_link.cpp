#include "app/slices/scan_link.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/text/json_text.h"
#include "core/volume/formats/import.h"
#include "core/volume/formats/import_raw.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

/// What surface files say of the scan they were made of; null when they do not.
json input_of(std::string_view provenance) {
  if (provenance.empty()) return nullptr;
  const auto all = parse_json(provenance, "provenance");
  if (!all || !all->is_object() || !all->contains("input") || !all->at("input").is_object()) return nullptr;
  return all->at("input");
}

std::string text_at(const json& object, const char* name) {
  return object.is_object() && object.contains(name) && object.at(name).is_string() ? object.at(name).get<std::string>()
                                                                                    : std::string();
}

Dims dims_at(const json& object, const char* name) {
  if (!object.is_object() || !object.contains(name) || !object.at(name).is_array() || object.at(name).size() != 3)
    return {};
  for (const json& each : object.at(name))
    if (!each.is_number_integer()) return {};
  return {object.at(name)[0], object.at(name)[1], object.at(name)[2]};
}

}  // namespace

std::string scan_fingerprint_of(std::string_view provenance) {
  constexpr std::size_t kLongest = 60;  // it becomes part of names of files
  std::string out = text_at(input_of(provenance), "fingerprint");
  const bool plain = out.find_first_not_of("0123456789abcdef-") == std::string::npos && out.size() <= kLongest;
  return plain ? out : std::string();
}

std::optional<RawSpec> raw_volume_of(std::string_view provenance) {
  const json input = input_of(provenance);
  if (text_at(input, "format") != "raw" || !input.contains("axes") || text_at(input.at("axes"), "order") != "zyx")
    return std::nullopt;
  const Dims dims = dims_at(input, "file_dims");
  const auto type = parse_scalar_type(text_at(input, "dtype"));
  if (dims.count() <= 0 || !type) return std::nullopt;
  RawSpec raw{{dims.x, dims.y, dims.z}, *type, ByteOrder::kLittle, 0};
  if (const auto order = parse_byte_order(text_at(input, "byte_order"))) raw.order = *order;
  const auto skip = skip_of_layout(text_at(input, "layout"));
  if (!skip) return std::nullopt;
  raw.skip = *skip;
  return raw;
}

Result<ImportOptions> readable_scan(ImportOptions asked, std::string_view provenance) {
  const auto opened = open_voxels(asked);
  if (opened) return asked;
  if (!asked.raw) asked.raw = raw_volume_of(provenance);
  if (!asked.raw) return tl::unexpected<Error>(opened.error());
  DUBSAR_TRY(open_voxels(asked));
  return asked;
}

std::optional<ScanLink> scan_of(const TriMesh& mesh, const fs::path& surface,
                                const std::optional<ImportOptions>& given) {
  const json input = input_of(mesh.provenance);
  ScanLink out;
  out.voxel_mm = mesh.frame.input_voxel.mm;
  out.fingerprint = text_at(input, "fingerprint");
  out.dims = dims_at(input, "file_dims");
  out.import.dataset = text_at(input, "dataset");
  if (input.is_object() && input.contains("axes") && text_at(input.at("axes"), "stated_by") == "given by the user")
    if (const auto order = parse_axis_order(text_at(input.at("axes"), "order"))) out.import.axis_order = *order;
  out.import.raw = raw_volume_of(mesh.provenance);
  if (given) {
    ImportOptions import = *given;
    if (import.dataset.empty() && import.path.string().find(":/") == std::string::npos)  // else it names its own
      import.dataset = out.import.dataset;
    if (!import.axis_order) import.axis_order = out.import.axis_order;
    out.import = std::move(import);
    out.given = true;
    return out;
  }
  const fs::path name = fs::path(text_at(input, "path")).filename();
  if (name.empty() || out.fingerprint.empty()) return std::nullopt;
  out.import.path = surface.parent_path() / name;
  std::error_code error;
  if (!fs::is_regular_file(out.import.path, error)) return std::nullopt;
  return out;
}

Result<OpenedScan> open_scan(const ScanLink& link) {
  DUBSAR_ASSIGN(OpenedVoxels opened, open_voxels(link.import));
  OpenedScan out;
  out.voxel_mm = link.voxel_mm;
  const Dims found = opened.reader->dims();
  const std::string name = link.import.path.filename().string();
  if (link.dims.count() > 0 && found != link.dims)
    return fail(ErrorKind::kBadData,
                "slices: {} has {} x {} x {} voxels, expected {} x {} x {}, the scan that this surface was made of",
                name, found.x, found.y, found.z, link.dims.x, link.dims.y, link.dims.z);
  if (!link.fingerprint.empty() && opened.info.fingerprint != link.fingerprint) {
    if (!link.given)
      return fail(ErrorKind::kBadData,
                  "slices: {} is not the scan that this surface was made of, though it has its name", name);
    out.note = name + " is not the file that this surface was made of; what the slices show may be something else";
  }
  DUBSAR_ASSIGN(out.sampler, PlaneSampler::create(std::move(opened.reader)));
  return out;
}

}  // namespace dubsar::app
