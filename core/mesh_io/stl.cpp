#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/files/buffered_writer.h"
#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/no_mesh.h"
#include "core/mesh_io/progress_step.h"
#include "core/mesh_io/text_scanner.h"
#include "core/mesh_io/vertex_places.h"
#include "core/mesh_io/weld.h"

namespace dubsar {
namespace {
constexpr std::size_t kHeaderBytes = 80, kFacetBytes = 50;
constexpr std::string_view kMaker = "dubsar STL, units ";

/// What cannot be a triangle that was not counted: less than one, or zeros.
bool is_waste(std::string_view rest) {
  return rest.size() < kFacetBytes || rest.find_first_not_of('\0') == std::string_view::npos;
}

Result<TriMesh> parse_binary(std::string_view bytes, Progress& progress) {
  ByteReader reader(bytes);
  const std::string_view header = reader.take(kHeaderBytes);
  const auto count = reader.little<std::uint32_t>();
  const std::size_t expected = std::size_t{count} * kFacetBytes;
  if (is_plain_text(bytes.substr(0, kHeaderBytes + 4)))
    return fail(ErrorKind::kBadData,
                "stl: a text that does not begin with \"solid\" found, expected an STL file; fetch the file itself");
  if (!reader.ok() || reader.left() < expected || !is_waste(bytes.substr(kHeaderBytes + 4 + expected)))
    return fail(ErrorKind::kBadData,
                "stl: {} triangles announced, so {} bytes expected, but the file has {}; it is cut or damaged, fetch "
                "or export it again",
                count, kHeaderBytes + 4 + expected, bytes.size());
  if (const std::size_t waste = reader.left() - expected; waste > 0)
    log_warning("stl: {} bytes behind the last triangle left out", waste);
  DUBSAR_TRY(check_memory("stl", std::uint64_t{count} * 40));
  progress.begin("read stl", count, "triangle");
  TriMesh mesh;
  PointWelder welder;
  std::size_t numbered = 0;
  mesh.triangles.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    reader.take(12);
    for (std::uint32_t& id : mesh.triangles[t]) {
      glm::vec3 p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = reader.little<float>();
      if (!is_finite_place(p)) return fail(ErrorKind::kBadData, "stl: a corner of triangle {} is not finite", t);
      id = welder.id(p);
    }
    numbered += reader.little<std::uint16_t>() != 0;
    if ((t + 1) % kProgressStep == 0) {
      progress.advance(kProgressStep);
      if (progress.cancelled()) return cancelled_error();
    }
  }
  mesh.positions = std::move(welder.points());
  if (numbered > 0)
    log_warning("stl: the numbers of {} triangles left out; some programs write colours there", numbered);
  if (header.starts_with(kMaker)) {
    const std::string_view rest = header.substr(kMaker.size());
    if (rest.starts_with("mm;") && rest.find("unknown") == std::string_view::npos)
      mesh.frame.input_voxel.provenance = "file unit mm";
  }
  progress.end();
  return mesh;
}

/// Words of a text file in small letters, "end solid", "end loop" and "end facet" as one word.
class StlWords {
 public:
  explicit StlWords(std::string_view bytes) : scanner_(bytes) {}
  std::string_view next() {
    word_ = scanner_.word();
    std::transform(word_.begin(), word_.end(), word_.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (word_ == "end") word_ += next_raw();
    return word_;
  }
  /// As it stands in the file.
  std::string_view raw() { return scanner_.word(); }
  void line() { scanner_.line(); }

 private:
  std::string next_raw() {
    std::string word(scanner_.word());
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word;
  }
  TextScanner scanner_;
  std::string word_;
};

Result<TriMesh> parse_ascii(std::string_view bytes, Progress& progress) {
  std::vector<glm::dvec3> corners;
  // Zeros and the end mark of old systems, of writers that fill a block.
  while (!bytes.empty() && (bytes.back() == '\0' || bytes.back() == '\x1A')) bytes.remove_suffix(1);
  StlWords words(bytes);
  const auto broken = [&](std::string_view found, std::string_view expected) {
    return fail(ErrorKind::kBadData, "stl: \"{}\" found in triangle {}, expected {}",
                found.empty() ? std::string_view("end of file") : found.substr(0, 40), corners.size() / 3, expected);
  };
  progress.begin("read stl", 0, "triangle");
  if (words.next() != "solid") return fail(ErrorKind::kBadData, "stl: the file does not start with \"solid\"");
  words.line();
  bool open = true;
  while (true) {
    std::string_view word = words.next();
    if (!open) {
      if (word.empty()) break;
      if (word != "solid") return broken(word, "\"solid\" or the end of the file");
      words.line();
      open = true;
      continue;
    }
    if (word == "endsolid") {
      words.line();
      open = false;
      continue;
    }
    if (word != "facet") return broken(word, "\"facet\" or \"endsolid\"");
    if (word = words.next(); word != "normal") return broken(word, "\"normal\"");
    for (int i = 0; i < 3; ++i) words.next();  // often wrong, sometimes "nan": never used
    if (word = words.next(); word != "outer") return broken(word, "\"outer loop\"");
    if (word = words.next(); word != "loop") return broken(word, "\"outer loop\"");
    for (int corner = 0; corner < 3; ++corner) {
      if (word = words.next(); word != "vertex") return broken(word, "\"vertex\"");
      glm::dvec3 p(0.0);
      for (int axis = 0; axis < 3; ++axis)
        if (word = words.raw(); !TextScanner::parse(word, p[axis])) return broken(word, "a number");
      if (!is_finite_place(glm::vec3(p))) return broken("not finite", "a finite coordinate");
      corners.push_back(p);
    }
    if (word = words.next(); word != "endloop") return broken(word, "\"endloop\"");
    if (word = words.next(); word != "endfacet") return broken(word, "\"endfacet\"");
    if (corners.size() / 3 % kProgressStep == 0) {
      progress.advance(kProgressStep);
      if (progress.cancelled()) return cancelled_error();
    }
  }
  TriMesh mesh;
  set_places(mesh, corners);
  PointWelder welder;
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    const std::uint32_t first = welder.id(mesh.positions[c]), second = welder.id(mesh.positions[c + 1]);
    mesh.triangles.push_back({first, second, welder.id(mesh.positions[c + 2])});
  }
  mesh.positions = std::move(welder.points());
  progress.end();
  return mesh;
}
}  // namespace

bool starts_like_stl(std::string_view bytes) { return StlWords(bytes.substr(0, 256)).next() == "solid"; }

Result<TriMesh> parse_stl(std::string_view bytes, Progress& progress) {
  // Many binary files start with "solid" too: the announced count decides first.
  if (bytes.size() >= kHeaderBytes + 4) {
    ByteReader count(bytes.substr(kHeaderBytes, 4));
    if (bytes.size() == kHeaderBytes + 4 + std::size_t{count.little<std::uint32_t>()} * kFacetBytes)
      return parse_binary(bytes, progress);
  }
  if (starts_like_stl(bytes) && bytes.substr(0, 256).find('\0') == std::string_view::npos)
    return parse_ascii(bytes, progress);
  return parse_binary(bytes, progress);
}

Result<void> write_stl(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress) {
  DUBSAR_TRY(check_tri_mesh(mesh));
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorKind::kUsage, "stl: {} triangles do not fit the 32-bit count; export one partition at a time",
                mesh.triangles.size());
  const VoxelSize& voxel = mesh.frame.input_voxel;
  std::string header(kMaker);
  if (options.units == MeshUnits::kMm)
    header += voxel.known() ? "mm; " : "mm; voxel size unknown, 1 voxel = 1 mm; ";
  else
    header += "voxel; ";
  if (!mesh.triangles.empty() && !mesh.partitions.empty()) {
    const PartitionId id = mesh.partition_of(0);
    const bool single = std::all_of(mesh.triangle_partition.begin(), mesh.triangle_partition.end(),
                                    [&](PartitionId other) { return other == id; });
    header += single ? partition_name(mesh, id) : "all parts";
  }
  std::replace_if(
      header.begin(), header.end(), [](char c) { return c < 32 || c > 126; }, '?');
  header.resize(kHeaderBytes, ' ');

  const std::size_t bytes = kHeaderBytes + 4 + kFacetBytes * mesh.triangles.size();
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path, static_cast<std::int64_t>(bytes)));
  BufferedWriter out(file);
  out.text(header);
  out.little(static_cast<std::uint32_t>(mesh.triangles.size()));
  const OutputSpace space(mesh.frame, options.units);
  const glm::dvec3 told = space.told_origin(mesh, "stl");
  progress.begin("write stl", static_cast<std::int64_t>(mesh.triangles.size()), "triangle");
  std::string facet;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<glm::vec3, 4> rows;  // the normal, then the corners
    for (std::size_t c = 0; c < 3; ++c)
      rows[c + 1] = glm::vec3(space.exact_position(mesh.positions[mesh.triangles[t][c]]) - told);
    const glm::dvec3 origin(rows[1]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(rows[2]) - origin, glm::dvec3(rows[3]) - origin);
    const double length = glm::length(normal);
    rows[0] = length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f);
    facet.clear();
    for (const glm::vec3& row : rows)
      for (int axis = 0; axis < 3; ++axis) append_little(facet, row[axis]);
    append_little(facet, std::uint16_t{0});
    out.text(facet);
    if ((t + 1) % kProgressStep == 0) {
      progress.advance(kProgressStep);
      if (progress.cancelled()) return cancelled_error();
      if (!out.ok()) return out.flush();
    }
  }
  DUBSAR_TRY(out.flush());
  DUBSAR_TRY(file.commit());
  progress.end();
  return {};
}

}  // namespace dubsar
