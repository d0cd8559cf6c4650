#include "core/mesh_io/coarse_surface.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <vector>

#include "core/base/numbers/sort_unique.h"
#include "core/mesh_io/text_scanner.h"
#include "core/mesh_io/vertex_places.h"

namespace dubsar {
namespace {

constexpr int kCells = 160;  // along the longest side of the box
constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

struct FileBox {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

/// A grid over the box: what falls into one of its cells becomes one vertex, in the mean of its places.
class Clusters {
 public:
  explicit Clusters(const FileBox& box) : low_(box.low) {
    const glm::vec3 size = box.high - box.low;
    const float longest = std::max({size.x, size.y, size.z, 1e-30f});
    per_unit_ = kCells / longest;
    count_ = glm::ivec3(size * per_unit_) + 1;
    ids_.assign(
        static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) * static_cast<std::size_t>(count_.z),
        kFree);
  }

  std::uint32_t vertex(const glm::vec3& p) {
    const glm::ivec3 cell = glm::clamp(glm::ivec3((p - low_) * per_unit_), glm::ivec3(0), count_ - 1);
    std::uint32_t& id = ids_[static_cast<std::size_t>((cell.z * count_.y + cell.y) * count_.x + cell.x)];
    if (id == kFree) {
      id = static_cast<std::uint32_t>(sums_.size());
      sums_.emplace_back(0.0);
      places_.push_back(0);
    }
    sums_[id] += glm::dvec3(p);
    ++places_[id];
    return id;
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == b || b == c || c == a) return;
    Triangle t{a, b, c};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());  // the same one begins the same way
    triangles_.push_back(t);
  }

  std::optional<TriMesh> take() {
    sort_unique(triangles_);
    if (triangles_.empty()) return std::nullopt;
    TriMesh out;
    for (std::size_t i = 0; i < sums_.size(); ++i)
      out.positions.emplace_back(sums_[i] / static_cast<double>(places_[i]));
    out.triangles = std::move(triangles_);
    return out;
  }

 private:
  glm::vec3 low_;
  float per_unit_ = 1.0f;
  glm::ivec3 count_{1};
  std::vector<std::uint32_t> ids_;  // of the cells
  std::vector<glm::dvec3> sums_;
  std::vector<std::uint32_t> places_;
  std::vector<Triangle> triangles_;
};

std::optional<TriMesh> of_stl(std::string_view bytes) {
  constexpr std::size_t kHeader = 84, kFacet = 50, kNormal = 12;
  if (bytes.size() < kHeader) return std::nullopt;
  std::uint32_t count = 0;  // little endian, as this machine (core/base/byte_order.h)
  std::memcpy(&count, bytes.data() + 80, 4);
  if (bytes.size() != kHeader + std::size_t{count} * kFacet) return std::nullopt;
  const auto corners = [&](std::size_t t) {
    std::array<glm::vec3, 3> out{};
    std::memcpy(out.data(), bytes.data() + kHeader + t * kFacet + kNormal, sizeof out);
    return out;
  };
  FileBox box;
  for (std::size_t t = 0; t < count; ++t)
    for (const glm::vec3& p : corners(t)) {
      if (!is_finite_place(p)) return std::nullopt;
      box.add(p);
    }
  Clusters clusters(box);
  for (std::size_t t = 0; t < count; ++t) {
    const auto [a, b, c] = corners(t);
    const std::uint32_t first = clusters.vertex(a), second = clusters.vertex(b);
    clusters.triangle(first, second, clusters.vertex(c));
  }
  return clusters.take();
}

/// Three numbers of a line "v x y z"; what follows does not matter.
bool parse_place(std::string_view line, glm::vec3& p) {
  TextScanner words(line);
  for (int axis = 0; axis < 3; ++axis)
    if (!words.number(p[axis])) return false;
  return is_finite_place(p);
}

/// The vertex of "12", "12/3", "12//3" or "-2"; kFree where it is none.
std::uint32_t parse_corner(std::string_view word, std::size_t count) {
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error != std::errc() || (end != word.data() + word.size() && *end != '/')) return kFree;
  const std::int64_t id = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
  return index != 0 && id >= 0 && id < static_cast<std::int64_t>(count) ? static_cast<std::uint32_t>(id) : kFree;
}

/// Nothing for the rare files whose faces name vertices that come later, or whose later vertices lie outside of the box
/// of those before the first face.
std::optional<TriMesh> of_obj(std::string_view bytes) {
  std::vector<glm::vec3> places;
  FileBox box;
  std::optional<Clusters> clusters;
  std::vector<std::uint32_t> ids;
  for (TextScanner scanner(bytes); !scanner.rest().empty();) {
    const std::string_view line = scanner.line();
    if (line.size() < 2 || line[1] != ' ' || (line[0] != 'v' && line[0] != 'f')) continue;
    if (line[0] == 'v') {
      glm::vec3 p;
      if (!parse_place(line.substr(2), p)) return std::nullopt;
      places.push_back(p);
      if (clusters && (p != glm::clamp(p, box.low, box.high))) return std::nullopt;
      box.add(p);
      continue;
    }
    if (!clusters) clusters.emplace(box);
    for (std::size_t v = ids.size(); v < places.size(); ++v) ids.push_back(clusters->vertex(places[v]));
    TextScanner words(line.substr(2));
    std::uint32_t first = kFree, last = kFree;
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
      const std::uint32_t corner = parse_corner(word, places.size());
      if (corner == kFree) return std::nullopt;
      if (last != kFree && first != last) clusters->triangle(ids[first], ids[last], ids[corner]);
      if (first == kFree) first = corner;
      last = corner;
    }
  }
  return clusters ? clusters->take() : std::nullopt;
}

}  // namespace

std::optional<TriMesh> coarse_surface(MeshFormat format, std::string_view bytes) {
  if (bytes.size() < kCoarseFrom) return std::nullopt;
  if (format == MeshFormat::kStl) return of_stl(bytes);
  if (format == MeshFormat::kObj) return of_obj(bytes);
  return std::nullopt;
}

}  // namespace dubsar
