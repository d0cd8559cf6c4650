#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/files/buffered_writer.h"
#include "core/base/system/log.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/mesh_text.h"
#include "core/mesh_io/polygon_soup.h"
#include "core/mesh_io/progress_step.h"
#include "core/mesh_io/text_scanner.h"
#include "core/mesh_io/vertex_colors.h"
#include "core/mesh_io/vertex_places.h"

namespace dubsar {
namespace {
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxLine = std::size_t{1} << 20;

/// Words that begin a line, of the format's description (Wavefront 1995) and of later versions.
bool is_obj_word(std::string_view word) {
  static constexpr std::array kWords{
      "v",     "vt",    "vn",   "vp",     "f",        "fo",       "l",      "p",          "g",
      "s",     "o",     "mg",   "usemtl", "mtllib",   "usemap",   "maplib", "cstype",     "deg",
      "bmat",  "step",  "curv", "curv2",  "surf",     "parm",     "trim",   "hole",       "scrv",
      "sp",    "end",   "con",  "bevel",  "c_interp", "d_interp", "lod",    "shadow_obj", "trace_obj",
      "ctech", "stech", "call", "csh",    "bsp",      "bzp",      "cdc",    "cdp",        "res"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// Comments and lines of names do not: "mtllib C:\scans\" is a folder of Windows.
bool may_go_on(std::string_view line) {
  static constexpr std::array kNamed{"mtllib",    "usemtl", "maplib", "usemap", "shadow_obj",
                                     "trace_obj", "call",   "csh",    "o",      "g"};
  const std::string_view word = TextScanner(line).word();
  return !word.starts_with('#') && std::find(kNamed.begin(), kNamed.end(), word) == kNamed.end();
}

std::string_view without_blanks(std::string_view line) {
  while (line.ends_with(' ') || line.ends_with('\t')) line.remove_suffix(1);
  return line;
}

/// The numbers behind the coordinates of a vertex: r g b, r g b a, or w r g b.
class ObjColors {
 public:
  void add(std::span<const double> values) {
    missing_ = missing_ || values.size() < 3;
    if (missing_) return;
    first_three_.emplace_back(values[0], values[1], values[2]);
    fourth_.push_back(values.size() > 3 ? static_cast<float>(values[3]) : kNothing);
    weights_first_ = weights_first_ && values.size() == 4 && values[0] == 1.0;
  }
  /// One of each vertex; none where one has none. A weight is 1 everywhere, and so is what covers.
  std::vector<std::array<std::uint8_t, 3>> bytes() const {
    if (missing_) return {};
    if (!weights_first_ || std::all_of(fourth_.begin(), fourth_.end(), [&](float a) { return a == fourth_[0]; }))
      return color_bytes(first_three_, false);
    std::vector<glm::vec3> moved;
    for (std::size_t v = 0; v < first_three_.size(); ++v)
      moved.emplace_back(first_three_[v].y, first_three_[v].z, fourth_[v]);
    return color_bytes(moved, false);
  }

 private:
  static constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  std::vector<glm::vec3> first_three_;
  std::vector<float> fourth_;
  bool missing_ = false, weights_first_ = true;
};

struct ObjParser {
  std::string_view bytes;
  Progress& progress;
  TriMesh mesh;
  PolygonSoup soup;
  MeshTextReader text;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> corner_normals;
  std::vector<glm::dvec3> places{};
  ObjColors colors{};
  bool corners_without_normal = false;
  PartitionId partition = 0;
  std::size_t line_number = 0, strange_lines = 0, first_strange = 0;

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
    const glm::dvec3 p(value[0], value[1], value[2]);
    if (!is_finite_place(glm::vec3(p))) return broken(line, "finite coordinates below 3e38");
    places.push_back(p);
    colors.add({value + 3, static_cast<std::size_t>(count - 3)});
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
      const std::uint32_t v = resolved(word.substr(0, slash), places.size());
      if (v == kNone) return broken(line, "vertex numbers that exist");
      std::uint32_t n = kNone;
      if (slash != std::string_view::npos) {
        if (const std::size_t second = word.find('/', slash + 1); second != std::string_view::npos) {
          const std::string_view number = word.substr(second + 1);
          n = resolved(number, normals.size());
          if (n == kNone && !number.empty() && number != "0") return broken(line, "normal numbers that exist");
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
    if (key == "f" || key == "fo") return face(words, line);
    if (key == "vn") {
      glm::dvec3 n(0.0);
      if (!words.number(n.x) || !words.number(n.y) || !words.number(n.z)) return broken(line, "3 numbers");
      const glm::vec3 normal(n);
      normals.push_back(is_finite_place(normal) ? normal : glm::vec3(0.0f));
    } else if (key == "g") {
      const std::string_view name = words.word();
      const int digit = name.size() > 4 && name.starts_with("part") ? name[4] - '0' : 0;
      partition = digit > 0 && digit <= PartitionTable::kHighest ? static_cast<PartitionId>(digit) : PartitionId{0};
    } else if (line.starts_with("# ")) {
      text.line(line.substr(2));
    } else if (!key.empty() && !key.starts_with('#') && !is_obj_word(key)) {
      if (places.empty()) return broken(line, "a line of an OBJ file, such as \"v 1 2 3\" or \"f 1 2 3\"");
      if (strange_lines++ == 0) first_strange = line_number;
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
      if (without_blanks(line).ends_with('\\') && may_go_on(line)) {
        joined.clear();
        while (without_blanks(line).ends_with('\\') && joined.size() <= kMaxLine) {
          joined.append(without_blanks(line), 0, without_blanks(line).size() - 1).push_back(' ');
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
    const std::size_t count = places.size();
    if (count == 0 && !text.ours())
      return fail(ErrorKind::kBadData, "obj: {} lines without a vertex found, expected lines such as \"v 1 2 3\"",
                  line_number);
    if (count >= kNone) return fail(ErrorKind::kBadData, "obj: {} vertices, expected fewer than 2^32 - 1", count);
    for (const std::uint32_t v : soup.corners)
      if (v >= count) return fail(ErrorKind::kBadData, "obj: a face names vertex {}, but there are {}", v + 1, count);
    if (!soup.corners.empty() && !corners_without_normal) DUBSAR_TRY(vertex_normals());
    mesh.colors = colors.bytes();
    if (strange_lines > 0)
      log_warning("obj: {} lines left out that begin with no word of the format, the first one is line {}",
                  strange_lines, first_strange);
    DUBSAR_TRY(text.apply(mesh));
    set_places(mesh, places);
    if (text.ours() && !mesh.partitions.empty()) mesh.triangle_partition = triangle_partitions(soup);
    DUBSAR_ASSIGN(mesh.triangles, triangulate_soup(mesh.positions, soup, "obj"));
    if (!text.ours()) join_equal_places(mesh);
    return {};
  }

  /// One normal per vertex: its only one, or the mean direction of several.
  Result<void> vertex_normals() {
    mesh.normals.assign(places.size(), glm::vec3(0.0f));
    std::vector<std::uint32_t> last(places.size(), kNone);
    std::vector<bool> several(places.size());
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
  const bool normals = !mesh.normals.empty(), far = space.far_origin(mesh) != glm::dvec3(0.0);
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
    row.clear();
    if (const glm::dvec3 p = space.exact_position(mesh.positions[v]); far)
      fmt::format_to(std::back_inserter(row), "v {:.6f} {:.6f} {:.6f}", p.x, p.y, p.z);
    else if (const glm::vec3 near(p); true)
      fmt::format_to(std::back_inserter(row), "v {} {} {}", near.x, near.y, near.z);
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
