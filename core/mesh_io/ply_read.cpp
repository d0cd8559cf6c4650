#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "core/mesh/evidence.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/ply_header.h"
#include "core/mesh_io/ply_values.h"
#include "core/mesh_io/polygon_soup.h"
#include "core/mesh_io/progress_step.h"
#include "core/mesh_io/vertex_colors.h"
#include "core/mesh_io/vertex_places.h"

namespace dubsar {
namespace {

constexpr std::uint64_t kPlyMostWaste = 4;  // bytes: line ends and the like

enum Slot { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kPart, kKMin, kKMax, kShape, kAo, kEvidence, kSlots };

std::optional<Slot> slot_of(const PlyProperty& property, bool ours) {
  static constexpr std::array<std::string_view, kSlots> kNames{"x",     "y",     "z",     "nx",   "ny",
                                                               "nz",    "red",   "green", "blue", "partition",
                                                               "k_min", "k_max", "shape", "ao",   "evidence"};
  // Names of colours before "red" was agreed on, and of programs that never heard of it.
  static constexpr std::array<std::array<std::string_view, 2>, 3> kOldColors{
      {{"diffuse_red", "r"}, {"diffuse_green", "g"}, {"diffuse_blue", "b"}}};
  for (std::size_t c = 0; c < kOldColors.size(); ++c)
    for (const std::string_view name : kOldColors[c])
      if (property.name == name && !property.list) return static_cast<Slot>(kRed + c);
  for (int slot = 0; slot < kSlots; ++slot) {
    if (property.name != kNames[static_cast<std::size_t>(slot)] || property.list) continue;
    if (slot >= kPart && !ours) return std::nullopt;  // a foreign "ao" or "shape" means something else
    return static_cast<Slot>(slot);
  }
  return std::nullopt;
}

bool is_label(const PlyProperty& property) { return property.name == "partition" && !property.list; }

template <class T>
Result<T> checked_byte(double value, int highest, std::string_view name) {
  if (!(value >= 0.0 && value <= highest))
    return fail(ErrorKind::kBadData, "ply: {} {} found, expected 0..{}", name, value, highest);
  return static_cast<T>(value);
}

struct PlyParser {
  const PlyHeader& header;
  Progress& progress;
  TriMesh mesh;
  PolygonSoup soup;
  std::uint64_t vertex_count = 0;
  std::int64_t skipped = 0;
  std::vector<PartitionId> labels{};  ///< of the vertices, from files without labels of the faces
  std::vector<glm::dvec3> places{};
  std::uint64_t rest = 0;  ///< bytes behind the last element

  template <class Values>
  Result<void> vertices(const PlyElement& element, Values& values) {
    std::array<bool, kSlots> has{};
    std::vector<int> slots;
    bool integers = true, bytes = true;  // colours are
    std::vector<glm::vec3> wide;         // colours of other types
    for (const PlyProperty& property : element.properties) {
      const auto slot = slot_of(property, header.text.ours());
      slots.push_back(slot ? *slot : -1);
      if (!slot) continue;
      has[*slot] = true;
      if (*slot < kRed || *slot > kBlue) continue;
      integers = integers && ply_is_integer(property.type);
      bytes = bytes && property.type == PlyScalar::kU8;
    }
    if (!has[kX] || !has[kY] || !has[kZ]) return fail(ErrorKind::kBadData, "ply: vertices have no x, y, z properties");
    const bool normals = has[kNx] && has[kNy] && has[kNz];
    const bool colors = has[kRed] && has[kGreen] && has[kBlue] && !header.text.colors_derived();
    const bool curvatures = has[kKMin] && has[kKMax];
    const auto count = static_cast<std::size_t>(element.count);
    DUBSAR_TRY(check_memory("ply", element.count * 72));
    places.resize(count);
    if (normals) mesh.normals.resize(count);
    if (colors && bytes) mesh.colors.resize(count);
    if (colors && !bytes) wide.resize(count);
    if (curvatures) mesh.k_min.resize(count), mesh.k_max.resize(count);
    if (has[kPart]) labels.resize(count);
    if (has[kShape]) mesh.shape.resize(count);
    if (has[kAo]) mesh.ao.resize(count);
    if (has[kEvidence]) mesh.evidence.resize(count);

    std::array<double, kSlots> row{};
    const auto point = [&](int first) {
      return glm::vec3(static_cast<float>(row[first]), static_cast<float>(row[first + 1]),
                       static_cast<float>(row[first + 2]));
    };
    for (std::size_t v = 0; v < count; ++v) {
      for (std::size_t p = 0; p < slots.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.list) {
          DUBSAR_TRY(skip_list(property, values));
        } else if (const double value = values.next(property.type); slots[p] >= 0) {
          row[static_cast<std::size_t>(slots[p])] = value;
        }
      }
      if (!values.ok())
        return fail(ErrorKind::kBadData, "ply: the file ends or has a broken number in vertex {} of {}", v, count);
      places[v] = {row[kX], row[kY], row[kZ]};
      const glm::vec3 position = point(kX);  // what float does not hold is refused, too
      if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
        return fail(ErrorKind::kBadData, "ply: the position of vertex {} is not finite", v);
      if (normals) mesh.normals[v] = point(kNx);
      if (colors && bytes)
        for (std::size_t c = 0; c < 3; ++c) mesh.colors[v][c] = static_cast<std::uint8_t>(row[kRed + c]);
      else if (colors)
        wide[v] = point(kRed);
      if (curvatures) {
        mesh.k_min[v] = static_cast<float>(row[kKMin]);
        mesh.k_max[v] = static_cast<float>(row[kKMax]);
      }
      if (has[kPart]) {
        DUBSAR_ASSIGN(labels[v], checked_byte<PartitionId>(row[kPart], PartitionTable::kHighest, "partition"));
      }
      if (has[kShape]) {
        DUBSAR_ASSIGN(mesh.shape[v], checked_byte<std::uint8_t>(row[kShape], 126, "shape"));
      }
      if (has[kAo]) {
        DUBSAR_ASSIGN(mesh.ao[v], checked_byte<std::uint8_t>(row[kAo], 63, "ao"));
      }
      if (has[kEvidence]) {
        constexpr int kHighest = static_cast<int>(kEvidenceCount) - 1;
        DUBSAR_ASSIGN(mesh.evidence[v], checked_byte<std::uint8_t>(row[kEvidence], kHighest, "evidence"));
      }
      if (v % kProgressStep == 0 && progress.cancelled()) return cancelled_error();
    }
    if (colors && !bytes) mesh.colors = color_bytes(wide, integers);
    return {};
  }

  template <class Values>
  Result<std::uint64_t> list_length(const PlyProperty& property, Values& values) {
    const double length = values.next(property.count_type);
    if (!values.ok()) return fail(ErrorKind::kBadData, "ply: the file ends inside element data");
    if (!(length >= 0.0) || length != std::floor(length) || length > 4294967295.0)
      return fail(ErrorKind::kBadData, "ply: a list of length {} found", length);
    const auto count = static_cast<std::uint64_t>(length);
    DUBSAR_TRY(check_count("ply: list", count, values.least_bytes(property.type), values.left()));
    return count;
  }

  template <class Values>
  Result<void> skip_list(const PlyProperty& property, Values& values) {
    DUBSAR_ASSIGN(const std::uint64_t count, list_length(property, values));
    values.skip(property.type, count);
    return {};
  }

  template <class Values>
  Result<void> corners(const PlyProperty& property, Values& values) {
    DUBSAR_ASSIGN(const std::uint64_t count, list_length(property, values));
    if (count < 3) {
      ++skipped;
      values.skip(property.type, count);
      return {};
    }
    for (std::uint64_t c = 0; c < count; ++c) {
      const double id = values.next(property.type);
      if (!(id >= 0.0 && id < static_cast<double>(vertex_count)) || id != std::floor(id))
        return fail(ErrorKind::kBadData, "ply: a face names vertex {}, but there are {} vertices", id, vertex_count);
      soup.corners.push_back(static_cast<std::uint32_t>(id));
    }
    soup.sizes.push_back(static_cast<std::uint32_t>(count));
    return {};
  }

  static bool is_corners(const PlyProperty& property) {
    return property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
  }
  static Result<void> needs_corners(const PlyElement& element) {
    if (element.count == 0 || std::any_of(element.properties.begin(), element.properties.end(), is_corners)) return {};
    return fail(ErrorKind::kBadData,
                "ply: {} items \"{}\" found without properties that are a list vertex_indices, expected one",
                element.count, element.name);
  }

  template <class Values>
  Result<void> faces(const PlyElement& element, Values& values) {
    DUBSAR_TRY(needs_corners(element));
    const bool labelled = header.text.ours() && std::any_of(element.properties.begin(), element.properties.end(),
                                                            [](const PlyProperty& p) { return is_label(p); });
    for (std::uint64_t f = 0; f < element.count; ++f) {
      PartitionId label = 0;
      const std::size_t polygons = soup.sizes.size();
      for (const PlyProperty& property : element.properties) {
        if (labelled && is_label(property)) {
          const double value = values.next(property.type);
          DUBSAR_ASSIGN(label, checked_byte<PartitionId>(value, PartitionTable::kHighest, "partition"));
        } else if (!property.list) {
          values.next(property.type);
        } else if (is_corners(property)) {
          DUBSAR_TRY(corners(property, values));
        } else {
          DUBSAR_TRY(skip_list(property, values));
        }
      }
      if (!values.ok())
        return fail(ErrorKind::kBadData, "ply: the file ends or has a broken number in face {} of {}", f,
                    element.count);
      if (labelled) soup.partitions.insert(soup.partitions.end(), soup.sizes.size() - polygons, label);
      if (f % kProgressStep == 0 && progress.cancelled()) return cancelled_error();
    }
    return {};
  }

  /// Each vertex makes a triangle with the two before it, every other one turned; a negative one begins anew.
  template <class Values>
  Result<void> strips(const PlyElement& element, Values& values) {
    DUBSAR_TRY(needs_corners(element));
    for (std::uint64_t s = 0; s < element.count; ++s) {
      for (const PlyProperty& property : element.properties) {
        if (!property.list) {
          values.next(property.type);
          continue;
        }
        if (!is_corners(property)) {
          DUBSAR_TRY(skip_list(property, values));
          continue;
        }
        DUBSAR_ASSIGN(const std::uint64_t count, list_length(property, values));
        std::vector<std::uint32_t> strip;
        for (std::uint64_t c = 0; c < count; ++c) {
          const double id = values.next(property.type);
          if (!(id < static_cast<double>(vertex_count)) || id != std::floor(id))
            return fail(ErrorKind::kBadData, "ply: a strip names vertex {}, but there are {} vertices", id,
                        vertex_count);
          if (id < 0) {
            strip.clear();
            continue;
          }
          strip.push_back(static_cast<std::uint32_t>(id));
          const std::size_t n = strip.size();
          if (n < 3 || strip[n - 1] == strip[n - 2] || strip[n - 2] == strip[n - 3] || strip[n - 1] == strip[n - 3])
            continue;
          const bool turned = n % 2 == 0;
          soup.corners.insert(soup.corners.end(),
                              {strip[turned ? n - 2 : n - 3], strip[turned ? n - 3 : n - 2], strip[n - 1]});
          soup.sizes.push_back(3);
        }
        if (progress.cancelled()) return cancelled_error();
      }
      if (!values.ok())
        return fail(ErrorKind::kBadData, "ply: the file ends or has a broken number in strip {} of {}", s,
                    element.count);
    }
    return {};
  }

  template <class Values>
  Result<void> other(const PlyElement& element, Values& values) {
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
      for (const PlyProperty& property : element.properties) {
        if (property.list)
          DUBSAR_TRY(skip_list(property, values));
        else
          values.next(property.type);
      }
      if (!values.ok())
        return fail(ErrorKind::kBadData, "ply: the file ends or has a broken number in element \"{}\"", element.name);
      if (i % kProgressStep == 0 && progress.cancelled()) return cancelled_error();
    }
    return {};
  }

  /// Files of earlier versions label vertices, those between two partitions with the lower id.
  std::vector<PartitionId> triangle_labels() const {
    if (labels.empty() || !soup.partitions.empty()) return triangle_partitions(soup);
    std::vector<PartitionId> of_triangle(mesh.triangles.size());
    std::transform(mesh.triangles.begin(), mesh.triangles.end(), of_triangle.begin(), [&](const Triangle& t) {
      return std::max({labels[t[0]], labels[t[1]], labels[t[2]]});
    });
    return of_triangle;
  }

  template <class Values>
  Result<void> body(Values values) {
    for (const PlyElement& element : header.elements) {
      std::uint64_t least = 0;
      for (const PlyProperty& p : element.properties) least += values.least_bytes(p.list ? p.count_type : p.type);
      DUBSAR_TRY(check_count("ply: " + element.name.substr(0, 40), element.count, least, values.left()));
      progress.begin("read ply " + element.name.substr(0, 40), static_cast<std::int64_t>(element.count), "item");
      if (element.name == "vertex") {
        if (!places.empty()) return fail(ErrorKind::kBadData, "ply: two vertex elements, expected one");
        DUBSAR_TRY(vertices(element, values));
      } else if (element.name == "face") {
        DUBSAR_TRY(faces(element, values));
      } else if (element.name == "tristrips") {
        DUBSAR_TRY(strips(element, values));
      } else {
        DUBSAR_TRY(other(element, values));
      }
      progress.end();
    }
    rest = values.left();
    return {};
  }
};
}  // namespace

Result<TriMesh> parse_ply(std::string_view bytes, Progress& progress) {
  DUBSAR_ASSIGN(const PlyHeader header, parse_ply_header(bytes));
  PlyParser parser{header, progress, {}, {}};
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    if (element.name != "vertex") continue;
    has_vertices = true;
    parser.vertex_count = element.count;
    if (element.count >= std::numeric_limits<std::uint32_t>::max())
      return fail(ErrorKind::kBadData, "ply: {} vertices found, expected fewer than 2^32 - 1", element.count);
  }
  if (!has_vertices) return fail(ErrorKind::kBadData, "ply: no vertex element");
  const std::string_view body = bytes.substr(header.body);
  switch (header.encoding) {
    case PlyEncoding::kAscii:
      DUBSAR_TRY(parser.body(AsciiValues(body)));
      break;
    case PlyEncoding::kLittle:
      DUBSAR_TRY(parser.body(BinaryValues<false>(body)));
      break;
    case PlyEncoding::kBig:
      DUBSAR_TRY(parser.body(BinaryValues<true>(body)));
      break;
  }
  if (parser.skipped > 0 && parser.soup.sizes.empty())
    return fail(ErrorKind::kBadData,
                "ply: {} faces found of which none has 3 corners, expected triangles; the counts in the header are not "
                "those of the data, export it again",
                parser.skipped);
  if (parser.rest > kPlyMostWaste)
    log_warning("ply: {} bytes behind the last element left out: the header announces less than there is", parser.rest);
  if (parser.skipped > 0) log_warning("ply: {} faces with fewer than 3 corners left out", parser.skipped);
  DUBSAR_TRY(header.text.apply(parser.mesh));
  set_places(parser.mesh, parser.places);
  DUBSAR_ASSIGN(parser.mesh.triangles, triangulate_soup(parser.mesh.positions, parser.soup, "ply"));
  parser.mesh.triangle_partition = parser.triangle_labels();
  if (!header.text.ours()) join_equal_places(parser.mesh);
  return std::move(parser.mesh);
}

}  // namespace dubsar
