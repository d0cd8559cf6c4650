#include "core/exa/exa_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/numbers/bytes.h"
#include "core/base/system/budget.h"
#include "core/base/text/json_text.h"
#include "core/exa/chunks.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;

Json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Reads members of an object and remembers the first that is missing or of the wrong type.
class Members {
 public:
  explicit Members(const Json& object) : object_(object) {}
  const Json* get(const char* key, bool (Json::*test)() const noexcept) {
    if (object_.is_object()) {
      const auto found = object_.find(key);
      if (found != object_.end() && ((*found).*test)()) return &*found;
    }
    if (wrong_.empty()) wrong_ = key;
    return nullptr;
  }
  double number(const char* key) {
    const Json* value = get(key, &Json::is_number);
    return value ? value->get<double>() : 0.0;
  }
  std::int64_t count(const char* key) {
    const Json* value = get(key, &Json::is_number_unsigned);
    const std::uint64_t found = value ? value->get<std::uint64_t>() : 0;
    if (found > (std::uint64_t{1} << 40)) wrong_ = key;
    return static_cast<std::int64_t>(found);
  }
  bool flag(const char* key) {
    const Json* value = get(key, &Json::is_boolean);
    return value && value->get<bool>();
  }
  std::string text(const char* key) {
    const Json* value = get(key, &Json::is_string);
    return value ? value->get<std::string>() : std::string();
  }
  glm::dvec3 vector(const char* key) {
    glm::dvec3 v(0.0);
    const Json* value = get(key, &Json::is_array);
    if (!value) return v;
    if (value->size() != 3) wrong_ = key;
    for (std::size_t a = 0; a < 3 && value->size() == 3; ++a) {
      if (!(*value)[a].is_number())
        wrong_ = key;
      else
        v[static_cast<int>(a)] = (*value)[a].get<double>();
    }
    if (!finite(v)) wrong_ = key;
    return v;
  }
  const std::string& wrong() const { return wrong_; }

 private:
  const Json& object_;
  std::string wrong_;
};
}  // namespace

namespace {
// Vertices, x-quads, faces of a byte of the file; edges: no offset of 4 bits or more takes less than .0105 bits.
constexpr std::uint64_t kMostPerByte = 16384, kMostEdgesPerByte = 1024, kAlwaysItems = 1 << 16;
// Points and rows that are passed through take time, whatever is in them: .2 ns a point, 50 ns a row.
constexpr std::uint64_t kPointsOfRow = 256, kMostPointsPerByte = 4096, kAlwaysPoints = std::uint64_t{1} << 31;
constexpr std::uint64_t kMostRowsPerByte = 5, kAlwaysRows = std::uint64_t{5} << 19;

std::string_view normals_name(ExaNormals normals) {
  switch (normals) {
    case ExaNormals::kNone:
      return "none";
    case ExaNormals::kRecomputed:
      return "recomputed";
    case ExaNormals::kExact:
      return "exact";
  }
  return "";
}
}  // namespace

Result<std::string> exa_header_json(const ExaHeader& header) {
  if (!std::isfinite(header.isovalue) || !finite(header.frame.scale) || !finite(header.frame.origin_vox) ||
      !finite(header.frame.input_voxel.mm))
    return fail(ErrorKind::kBadData, "exa: isovalue, scale, origin and voxel size must be finite to be stored");
  nlohmann::ordered_json json;
  if (header.sums.embedded) json["cut"] = "envelope";
  json["dims"] = {header.dims.x, header.dims.y, header.dims.z};
  json["isovalue"] = static_cast<double>(header.isovalue);
  json["offset_bits"] = header.offset_bits;
  json["closed"] = header.closed;
  if (header.sums.far_sides) json["far_sides"] = true;
  json["vertices"] = header.vertices;
  json["quads"] = header.quads;
  json["edges"] = header.samples.edges;
  json["faces"] = header.samples.faces;
  json["position_sum"] = header.sums.positions;
  json["quad_sum"] = header.sums.quads;
  if (header.sums.contact)
    json["contact"] = {{"edges", header.sums.contact->edges},
                       {"vertices", header.sums.contact->vertices},
                       {"sum", header.sums.contact->sum}};
  json["normals"] = normals_name(header.normals);
  json["curvatures"] = header.curvatures;
  json["shapes"] = header.shapes ? "recomputed" : "stored";
  json["curvature_method"] = header.curvature == CurvatureMethod::kFit ? "fit" : "pairs";
  json["unit"] = "mm";
  json["scale"] = vector_json(header.frame.scale);
  json["origin_vox"] = vector_json(header.frame.origin_vox);
  json["voxel_size_mm"] = vector_json(header.frame.input_voxel.mm);
  json["voxel_size_from"] = header.frame.input_voxel.provenance;
  json["tool"] = header.tool;
  return json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

Result<void> check_exa_size(const Dims& dims, std::uint64_t file_bytes) {
  const std::uint64_t work = static_cast<std::uint64_t>(dims.count()) +
                             kPointsOfRow * static_cast<std::uint64_t>(dims.y) * static_cast<std::uint64_t>(dims.z);
  const std::uint64_t most = std::max(kAlwaysPoints, kMostPointsPerByte * file_bytes);
  if (work > most)
    return fail(ErrorKind::kBadData,
                "exa: {} x {} x {} grid points in a file of {} bytes: {} with {} for each row, expected at most {}",
                dims.x, dims.y, dims.z, file_bytes, work, kPointsOfRow, most);
  const auto rows = static_cast<std::uint64_t>(dims.y * dims.z);
  const std::uint64_t most_rows = std::max(kAlwaysRows, kMostRowsPerByte * file_bytes);
  if (rows > most_rows)
    return fail(ErrorKind::kBadData, "exa: {} x {} grid rows in a file of {} bytes: {}, expected at most {}", dims.y,
                dims.z, file_bytes, rows, most_rows);
  return {};
}

Result<ExaHeader> parse_exa_header(std::string_view text, std::uint64_t file_bytes) {
  DUBSAR_ASSIGN(const Json json, parse_json(text, "exa: header"));
  Members members(json);
  ExaHeader header;
  if (json.is_object() && json.contains("profile"))
    return fail(
        ErrorKind::kBadData,
        "exa: profile {} found, expected none: surfaces coded as in the paper, to compare, are not read any more; "
        "process the scan again",
        json["profile"].dump());
  if (json.is_object() && json.contains("cut")) {
    if (json["cut"] != "envelope")
      return fail(ErrorKind::kBadData,
                  "exa: cut {} found, expected \"envelope\" or none; a newer program reads this file",
                  json["cut"].dump());
    header.sums.embedded = true;
  }
  if (json.is_object() && json.contains("far_sides")) header.sums.far_sides = members.flag("far_sides");
  if (json.is_object() && json.contains("contact")) {
    Members contact(json["contact"]);
    header.sums.contact =
        ExaContact{contact.count("edges"), contact.count("vertices"), static_cast<std::uint32_t>(contact.count("sum"))};
    if (!contact.wrong().empty())
      return fail(ErrorKind::kBadData, "exa: \"{}\" of \"contact\" is missing or wrong in the header", contact.wrong());
  }
  const glm::dvec3 dims = members.vector("dims");
  header.isovalue = static_cast<float>(members.number("isovalue"));
  const std::int64_t bits = members.count("offset_bits");
  header.closed = members.flag("closed");
  header.vertices = members.count("vertices");
  header.quads = members.count("quads");
  header.samples.edges = members.count("edges");
  header.samples.faces = members.count("faces");
  header.sums.positions = static_cast<std::uint32_t>(members.count("position_sum"));
  header.sums.quads = static_cast<std::uint32_t>(members.count("quad_sum"));
  const std::string normals = members.text("normals"), method = members.text("curvature_method");
  header.curvatures = members.flag("curvatures");
  const std::string shapes = members.text("shapes");
  const std::string unit = members.text("unit");
  header.frame.scale = members.vector("scale");
  header.frame.origin_vox = members.vector("origin_vox");
  header.frame.input_voxel.mm = members.vector("voxel_size_mm");
  header.frame.input_voxel.provenance = members.text("voxel_size_from");
  header.tool = members.text("tool");
  if (!members.wrong().empty())
    return fail(ErrorKind::kBadData, "exa: \"{}\" is missing or wrong in the header", members.wrong());
  std::uint64_t size[3];
  for (int a = 0; a < 3; ++a) {
    if (!(dims[a] >= 1.0 && dims[a] <= 65535.0) || dims[a] != std::floor(dims[a]))
      return fail(ErrorKind::kBadData, "exa: dimension {} found, expected 1..65535", dims[a]);
    size[a] = static_cast<std::uint64_t>(dims[a]);
  }
  DUBSAR_TRY(check_dims("exa", size, 1));
  header.dims = {static_cast<std::int64_t>(size[0]), static_cast<std::int64_t>(size[1]),
                 static_cast<std::int64_t>(size[2])};
  DUBSAR_TRY(check_exa_size(header.dims, file_bytes));
  if (bits < 1 || bits > 16) return fail(ErrorKind::kBadData, "exa: {} offset bits found, expected 1..16", bits);
  const auto edges = static_cast<std::uint64_t>(header.samples.edges);
  if (bits >= 4 && edges > kAlwaysItems + kMostEdgesPerByte * file_bytes)
    return fail(ErrorKind::kBadData, "exa: {} edges in a file of {} bytes, expected at most {}", edges, file_bytes,
                kAlwaysItems + kMostEdgesPerByte * file_bytes);
  const ExaContact contact = header.sums.contact.value_or(ExaContact());
  for (const std::int64_t count :
       {header.vertices, header.quads, header.samples.edges, header.samples.faces, contact.edges, contact.vertices})
    if (static_cast<std::uint64_t>(count) > kAlwaysItems + kMostPerByte * file_bytes)
      return fail(ErrorKind::kBadData,
                  "exa: {} vertices, x-quads, edges or faces in a file of {} bytes, expected at most {}", count,
                  file_bytes, kAlwaysItems + kMostPerByte * file_bytes);
  header.offset_bits = static_cast<int>(bits);
  for (int a = 0; a < 3; ++a)
    if (!(header.frame.scale[a] > 0.0) || !(header.frame.input_voxel.mm[a] > 0.0))
      return fail(ErrorKind::kBadData, "exa: a scale or voxel size is not positive");
  if (!std::isfinite(header.isovalue)) return fail(ErrorKind::kBadData, "exa: the isovalue is not finite");
  if (unit != "mm") return fail(ErrorKind::kBadData, "exa: voxel sizes in \"{}\" found, expected \"mm\"", unit);
  for (const ExaNormals kind : {ExaNormals::kNone, ExaNormals::kRecomputed, ExaNormals::kExact})
    if (normals == normals_name(kind)) header.normals = kind;
  if (normals != normals_name(header.normals))
    return fail(ErrorKind::kBadData, "exa: normals \"{}\" found, expected none, recomputed, exact or quantised",
                normals);
  if (method != "fit" && method != "pairs")
    return fail(ErrorKind::kBadData, "exa: curvature method \"{}\" found, expected fit or pairs", method);
  if ((shapes != "recomputed" && shapes != "stored") || (shapes == "recomputed" && !header.curvatures))
    return fail(ErrorKind::kBadData, "exa: shapes \"{}\" found, expected stored, or recomputed beside curvatures",
                shapes);
  header.shapes = shapes == "recomputed";
  header.curvature = method == "fit" ? CurvatureMethod::kFit : CurvatureMethod::kPairs;
  return header;
}

std::uint64_t exa_memory_bound(const ExaHeader& header) {
  const auto words = static_cast<std::uint64_t>((header.dims.x + 63) / 64 * header.dims.y * header.dims.z);
  const auto rows = static_cast<std::uint64_t>((header.dims.y + 1) * (header.dims.z + 1));
  const auto items =
      static_cast<std::uint64_t>(header.vertices + header.quads + header.samples.edges + header.samples.faces);
  const ExaContact contact = header.sums.contact.value_or(ExaContact());
  const std::uint64_t labelled =
      header.sums.contact ? words * 17 + items * 60 + static_cast<std::uint64_t>(contact.edges + contact.vertices) * 400
                          : 0;
  return words * 9 + rows * 48 + items * 80 + labelled + (std::uint64_t{64} << 20);
}

Result<std::string> exa_partitions_json(const PartitionTable& partitions) {
  for (const Partition& p : partitions)
    if (!std::isfinite(p.area_mm2) || !std::isfinite(p.volume_mm3))
      return fail(ErrorKind::kBadData, "exa: area or volume of partition {} is not finite", p.id);
  return partitions_json(partitions).dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

Result<PartitionTable> parse_exa_partitions(std::string_view text) {
  DUBSAR_ASSIGN(const Json json, parse_json(text, "exa: partition table"));
  if (!json.is_array()) return fail(ErrorKind::kBadData, "exa: the partition table is no table");
  PartitionTable partitions;
  for (const Json& row : json) {
    DUBSAR_ASSIGN(Partition partition, parse_partition(row));
    DUBSAR_TRY(partitions.insert(std::move(partition)));
  }
  return partitions;
}

std::uint32_t position_sum_of(const SurfaceModel& model) {
  const auto bytes_of = [](const auto& items) {
    return std::string_view(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(items[0]));
  };
  return crc32_of(bytes_of(model.samples.offsets), crc32_of(bytes_of(model.mesh.positions)));
}

std::uint32_t quad_sum_of(const QuadMesh& mesh) {
  const std::uint32_t quads =
      crc32_of({reinterpret_cast<const char*>(mesh.quads.data()), mesh.quads.size() * sizeof(mesh.quads[0])});
  std::string corners;
  for (const DoubledCorner& d : mesh.doubled) {
    append_little(corners, d.quad);
    append_little(corners, d.vertex);
    append_little(corners, d.corner);
  }
  return crc32_of(corners, quads);
}

}  // namespace dubsar
