#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/files/buffered_writer.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/mesh_text.h"
#include "core/mesh_io/polygon_soup.h"
#include "core/mesh_io/progress_step.h"
#include "core/mesh_io/text_scanner.h"

namespace dubsar {
namespace {
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxLine = std::size_t{1} << 20;

bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

struct ObjParser {
  std::string_view bytes;
  Progress& progress;
  TriMesh mesh;
  PolygonSoup soup;
  MeshTextReader text;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> corner_normals;
  bool corners_without_normal = false, vertices_without_color = false;
  PartitionId partition = 0;
  std::size_t line_number = 0;

  tl::unexpected<Error> broken(std::string_view line, std::string_view expected) const {
    return fail(ErrorKind::kBadData, "obj: line {}: \"{}\" found, expected {}", line_number, line.substr(0, 60),
                expected);
  }

  Result<void> vertex(TextScanner words, std::string_view line) {
    double value[8];
    int count = 0;
    for (std::string_view word = words.word(); !word.empty() && count < 8; word = words.word())
      if (!TextScanner::parse(word, value[count++])) return broken(line, "numbers");
    if (count < 3) return broken(line, "at least 3 coordinates");
    const glm::vec3 p(static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2]));
    if (!finite(p)) return broken(line, "finite coordinates");
    mesh.positions.push_back(p);
    if (count == 6) {
      std::array<std::uint8_t, 3> rgb{};
      for (std::size_t c = 0; c < 3; ++c)
        rgb[c] = static_cast<std::uint8_t>(
            std::lround(std::clamp(std::isfinite(value[3 + c]) ? value[3 + c] : 0.0, 0.0, 1.0) * 255.0));
      mesh.colors.push_back(rgb);
    } else {
      vertices_without_color = true;
    }
    return {};
  }

  /// 1-based or, counted back from the end, negative; to 0-based. kNone: not a valid index.
  static std::uint32_t resolved(std::string_view word, std::size_t count) {
    std::int64_t index = 0;
    if (!TextScanner::parse(word, index) || index == 0) return kNone;
    const std::int64_t id = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
    return id >= 0 && id < std::int64_t{kNone} ? static_cast<std::uint32_t>(id) : kNone;
  }

  Result<void> face(TextScanner words, std::string_view line) {
    std::uint32_t size = 0;
    for (std::string_view word = words.word(); !word.empty(); word = words.word(), ++size) {
      const std::size_t slash = word.find('/');
      const std::uint32_t v = resolved(word.substr(0, slash), mesh.positions.size());
      if (v == kNone) return broken(line, "vertex numbers that exist");
      std::uint32_t n = kNone;
      if (slash != std::string_view::npos) {
        if (const std::size_t second = word.find('/', slash + 1); second != std::string_view::npos) {
          n = resolved(word.substr(second + 1), normals.size());
          if (n == kNone) return broken(line, "normal numbers that exist");
        }
      }
      corners_without_normal = corners_without_normal || n == kNone;
      soup.corners.push_back(v);
      corner_normals.push_back(n);
    }
    if (size < 3) return broken(line, "at least 3 corners");
    soup.sizes.push_back(size);
    soup.partitions.push_back(partition);
    return {};
  }

  Result<void> one_line(std::string_view line) {
    TextScanner words(line);
    const std::string_view key = words.word();
    if (key == "v") return vertex(words, line);
    if (key == "f") return face(words, line);
    if (key == "vn") {
      glm::dvec3 n(0.0);
      if (!words.number(n.x) || !words.number(n.y) || !words.number(n.z)) return broken(line, "3 numbers");
      const glm::vec3 normal(n);
      normals.push_back(finite(normal) ? normal : glm::vec3(0.0f));
    } else if (key == "g") {
      const std::string_view name = words.word();
      const int digit = name.size() > 4 && name.starts_with("part") ? name[4] - '0' : 0;
      partition = digit > 0 && digit <= PartitionTable::kHighest ? static_cast<PartitionId>(digit) : PartitionId{0};
    } else if (line.starts_with("# ")) {
      text.line(line.substr(2));
    }
    return {};
  }

  Result<void> lines() {
    TextScanner scanner(bytes);
    progress.begin("read obj", static_cast<std::int64_t>(bytes.size()), "byte");
    std::size_t seen = bytes.size();
    std::string joined;
    while (!scanner.rest().empty()) {
      std::string_view line = scanner.line();
      ++line_number;
      if (line.ends_with('\\')) {
        joined.clear();
        while (line.ends_with('\\') && joined.size() <= kMaxLine) {
          joined.append(line.substr(0, line.size() - 1)).push_back(' ');
          line = scanner.line();
          ++line_number;
        }
        joined.append(line);
        line = joined;
      }
      if (line.size() > kMaxLine) return broken(line, "a line of at most 1 MiB");
      DUBSAR_TRY(one_line(line));
      if (line_number % kProgressStep == 0) {
        progress.advance(static_cast<std::int64_t>(seen - scanner.rest().size()));
        seen = scanner.rest().size();
        if (progress.cancelled()) return cancelled_error();
      }
    }
    progress.end();
    return {};
  }

  Result<void> finish() {
    const std::size_t count = mesh.positions.size();
    if (count >= kNone) return fail(ErrorKind::kBadData, "obj: {} vertices, expected fewer than 2^32 - 1", count);
    for (const std::uint32_t v : soup.corners)
      if (v >= count) return fail(ErrorKind::kBadData, "obj: a face names vertex {}, but there are {}", v + 1, count);
    if (!soup.corners.empty() && !corners_without_normal) DUBSAR_TRY(vertex_normals());
    if (vertices_without_color) mesh.colors.clear();
    DUBSAR_TRY(text.apply(mesh));
    if (text.ours() && !mesh.partitions.empty()) mesh.triangle_partition = triangle_partitions(soup);
    DUBSAR_ASSIGN(mesh.triangles, triangulate_soup(mesh.positions, soup, "obj"));
    return {};
  }

  /// One normal per vertex: its only one, or the mean direction of several.
  Result<void> vertex_normals() {
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f));
    std::vector<std::uint32_t> last(mesh.positions.size(), kNone);
    std::vector<bool> several(mesh.positions.size());
    for (std::size_t c = 0; c < soup.corners.size(); ++c) {
      const std::uint32_t v = soup.corners[c], n = corner_normals[c];
      if (n >= normals.size())
        return fail(ErrorKind::kBadData, "obj: a face names normal {}, but there are {}", n + 1, normals.size());
      if (last[v] == n) continue;
      several[v] = several[v] || last[v] != kNone;
      last[v] = n;
      mesh.normals[v] += normals[n];
    }
    for (std::size_t v = 0; v < several.size(); ++v)
      if (const float length = glm::length(mesh.normals[v]); several[v] && length > 0.0f) mesh.normals[v] /= length;
    return {};
  }
};
}  // namespace

Result<TriMesh> parse_obj(std::string_view bytes, Progress& progress) {
  ObjParser parser{bytes, progress, {}, {}, {}, {}, {}};
  DUBSAR_TRY(parser.lines());
  DUBSAR_TRY(parser.finish());
  return std::move(parser.mesh);
}

Result<void> write_obj(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress) {
  DUBSAR_TRY(check_tri_mesh(mesh));
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path));
  BufferedWriter out(file);
  const VertexColors colors = output_colors(mesh);
  for (const std::string& line : mesh_text_lines(mesh, options, colors.derived || options.colors_derived))
    out.text("# " + line + "\n");
  const OutputSpace space(mesh.frame, options.units);
  const bool normals = !mesh.normals.empty();
  progress.begin("write obj", static_cast<std::int64_t>(mesh.positions.size() + mesh.triangles.size()), "item");
  std::int64_t items = 0;
  const auto stopped = [&]() {  // after every item
    if (++items % static_cast<std::int64_t>(kProgressStep) != 0) return false;
    progress.advance(static_cast<std::int64_t>(kProgressStep));
    return progress.cancelled() || !out.ok();
  };
  const auto stop = [&]() -> Result<void> { return out.ok() ? cancelled_error() : out.flush(); };
  fmt::memory_buffer row;
  const auto emit = [&]() { out.text(std::string_view(row.data(), row.size())); };
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 p = space.position(mesh.positions[v]);
    row.clear();
    fmt::format_to(std::back_inserter(row), "v {} {} {}", p.x, p.y, p.z);
    if (!colors.rgb.empty())
      for (const std::uint8_t c : colors.rgb[v]) fmt::format_to(std::back_inserter(row), " {:.4g}", c / 255.0);
    row.push_back('\n');
    emit();
    if (stopped()) return stop();
  }
  for (const glm::vec3& grid : mesh.normals) {
    const glm::vec3 n = space.normal(grid);
    row.clear();
    fmt::format_to(std::back_inserter(row), "vn {} {} {}\n", n.x, n.y, n.z);
    emit();
  }
  for (PartitionId id = 0; id < PartitionTable::kMost; ++id) {
    bool named = false;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (mesh.partition_of(i) != id) continue;
      const Triangle& t = mesh.triangles[i];
      if (!named) {
        std::string name = partition_name(mesh, id);
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c <= 32 || c > 126; }, '_');
        out.text(fmt::format("g part{}_{}\n", id, name));
        named = true;
      }
      const std::uint64_t a = std::uint64_t{t[0]} + 1, b = std::uint64_t{t[1]} + 1, c = std::uint64_t{t[2]} + 1;
      row.clear();
      if (normals)
        fmt::format_to(std::back_inserter(row), "f {0}//{0} {1}//{1} {2}//{2}\n", a, b, c);
      else
        fmt::format_to(std::back_inserter(row), "f {} {} {}\n", a, b, c);
      emit();
      if (stopped()) return stop();
    }
  }
  DUBSAR_TRY(out.flush());
  DUBSAR_TRY(file.commit());
  progress.end();
  return {};
}

}  // namespace dubsar
