#include "core/parts/surface_model.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/extract/triangulate.h"

namespace dubsar {
namespace {

constexpr std::uint8_t kNotSelected = PartitionTable::kNone;

/// Triangles are counted in 32 bits; a polygon with doubled corners gives at most four more each.
Result<void> check_size(const QuadMesh& mesh) {
  const std::int64_t most = 2 * mesh.quad_count() + 4 * static_cast<std::int64_t>(mesh.doubled.size());
  if (most >= (std::int64_t{1} << 32) / 3)
    return fail(ErrorKind::kTryAgain,
                "surface_model: {} x-quads found, too many to make triangles of; expected at most {}",
                mesh.quad_count(), (std::int64_t{1} << 32) / 6);
  return {};
}

/// Which partitions go in, and which of them stay joined.
struct Selection {
  std::vector<std::uint8_t> group;  ///< of each partition id; kNotSelected: left out
};

Result<void> check_model(const SurfaceModel& model) {
  const std::size_t vertices = model.mesh.positions.size();
  const auto fits = [&](std::size_t size) { return size == 0 || size == vertices; };
  const VertexAttributes& a = model.attributes;
  if (!fits(a.normals.size()) || !fits(a.k_min.size()) || !fits(a.k_max.size()) || !fits(a.shape.size()) ||
      !fits(a.ao.size()))
    return fail(ErrorKind::kBadData,
                "surface_model: an attribute array does not have one entry for each of {} vertices", vertices);
  if (!model.quad_partition.empty() && model.quad_partition.size() != model.mesh.quads.size())
    return fail(ErrorKind::kBadData, "surface_model: {} partition ids found, expected one for each of {} x-quads",
                model.quad_partition.size(), model.mesh.quads.size());
  DUBSAR_TRY(model.partitions.check_complete(model.quad_partition, "surface_model", "an x-quad"));
  const std::size_t count = std::max<std::size_t>(model.partitions.size(), 1);
  for (const FillPatch& patch : model.patches) {
    if (patch.partition >= count ||
        (patch.reverse_partition >= count && patch.reverse_partition != PartitionTable::kNone))
      return fail(ErrorKind::kBadData, "surface_model: a fill patch has partition {}, expected less than {}",
                  std::max(patch.partition, patch.reverse_partition), count);
    for (const Triangle& t : patch.triangles)
      if (*std::max_element(t.begin(), t.end()) >= vertices + patch.extra_positions.size())
        return fail(ErrorKind::kBadData, "surface_model: a fill patch uses a vertex that does not exist");
  }
  return {};
}

Result<Selection> select(const SurfaceModel& model, const MeshOptions& options) {
  const auto& partitions = model.partitions;
  const std::size_t count = std::max<std::size_t>(partitions.size(), 1);
  Selection selection{std::vector<std::uint8_t>(count, kNotSelected)};
  if (options.partition) {
    if (*options.partition >= count)
      return fail(ErrorKind::kUsage, "surface_model: there is no partition {}, expected 0 to {}", *options.partition,
                  count - 1);
    selection.group[*options.partition] = 0;
    return selection;
  }
  bool found = !options.body;
  for (std::size_t id = 0; id < count; ++id) {
    const bool wanted = !options.body || (!partitions.empty() && partitions[id].body_name() == *options.body);
    if (wanted) selection.group[id] = partitions.body_of(static_cast<PartitionId>(id));
    found = found || wanted;
  }
  if (!found)
    return fail(ErrorKind::kUsage, "surface_model: there is no part \"{}\", expected one of: {}", *options.body,
                fmt::join(partitions.body_names(), ", "));
  return selection;
}

/// Triangles before vertices are split: ids 0..dual are dual vertices, then Steiner points, then patch
/// vertices (one copy for each side of a patch).
struct Soup {
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> partition, group;  ///< of each triangle
  std::vector<glm::vec3> added;                ///< positions of ids from dual_count on
  std::size_t first_patch_triangle = 0;
  std::size_t first_patch_vertex = 0;  ///< an id
};

void add_quads(const SurfaceModel& model, const Selection& selection, Triangulation triangulation, Soup& soup) {
  const std::size_t quads = model.mesh.quads.size();
  soup.added = std::move(triangulation.steiner);
  const bool everything =
      std::none_of(selection.group.begin(), selection.group.end(), [](std::uint8_t g) { return g == kNotSelected; });
  std::size_t kept = 0;
  soup.partition.resize(triangulation.triangles.size());
  soup.group.resize(triangulation.triangles.size());
  soup.triangles = std::move(triangulation.triangles);
  for (std::size_t q = 0; q < quads; ++q) {
    const std::uint8_t id = model.quad_partition.empty() ? std::uint8_t{0} : model.quad_partition[q];
    if (!everything && selection.group[id] == kNotSelected) continue;
    for (std::size_t t = triangulation.first_triangle[q]; t < triangulation.first_triangle[q + 1]; ++t) {
      soup.triangles[kept] = soup.triangles[t];
      soup.partition[kept] = id;
      soup.group[kept++] = selection.group[id];
    }
  }
  soup.triangles.resize(kept);
  soup.partition.resize(kept);
  soup.group.resize(kept);
}

void add_patches(const SurfaceModel& model, const Selection& selection, Soup& soup) {
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  soup.first_patch_triangle = soup.triangles.size();
  soup.first_patch_vertex = dual + soup.added.size();
  const auto add_side = [&](const FillPatch& patch, std::uint8_t id, bool reversed) {
    const auto base = static_cast<std::uint32_t>(dual + soup.added.size());
    soup.added.insert(soup.added.end(), patch.extra_positions.begin(), patch.extra_positions.end());
    for (Triangle t : patch.triangles) {
      for (std::uint32_t& v : t)
        if (v >= dual) v = v - dual + base;
      if (reversed) std::swap(t[1], t[2]);
      soup.triangles.push_back(t);
      soup.partition.push_back(id);
      soup.group.push_back(selection.group[id]);
    }
  };
  for (const FillPatch& patch : model.patches) {
    const std::uint8_t front = selection.group[patch.partition];
    const std::uint8_t back =
        patch.reverse_partition == PartitionTable::kNone ? kNotSelected : selection.group[patch.reverse_partition];
    if (front == back) continue;  // inside one part, or not selected at all
    if (front != kNotSelected) add_side(patch, patch.partition, false);
    if (back != kNotSelected) add_side(patch, patch.reverse_partition, true);
  }
}

/// Dual vertices where partitions meet or that a patch uses; only there can a vertex have more than one fan.
std::vector<bool> find_border(const SurfaceModel& model, const Selection& selection) {
  constexpr std::uint8_t kUnseen = 254;
  const QuadMesh& mesh = model.mesh;
  std::vector<bool> border(mesh.positions.size(), false);
  if (!model.quad_partition.empty()) {
    std::vector<std::uint8_t> seen(mesh.positions.size(), kUnseen);
    const auto visit = [&](std::uint32_t v, std::uint32_t q) {
      const std::uint8_t group = selection.group[model.quad_partition[q]];
      if (seen[v] == kUnseen) seen[v] = group;
      if (seen[v] != group) border[v] = true;
    };
    for (std::uint32_t q = 0; q < mesh.quads.size(); ++q)
      for (const std::uint32_t v : mesh.quads[q]) visit(v, q);
    for (const DoubledCorner& d : mesh.doubled) visit(d.vertex, d.quad);
  }
  for (const FillPatch& patch : model.patches)
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t)
        if (v < border.size()) border[v] = true;
  return border;
}

/// Gives every fan of triangles around a border vertex its own copy of it. O(n log n), whatever the triangles are. Copy
/// i gets the id first_copy + i; the result holds the id that each copy stands for.
std::vector<std::uint32_t> split_fans(Soup& soup, const std::vector<bool>& border, std::uint32_t first_copy) {
  struct Corner {
    std::uint32_t vertex;
    std::uint8_t group;
    std::uint32_t triangle;
    std::uint32_t next, previous;  ///< the other two vertices, in order
  };
  std::vector<Corner> corners;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle& triangle = soup.triangles[t];
    for (std::size_t c = 0; c < 3; ++c)
      if (triangle[c] < border.size() && border[triangle[c]])
        corners.push_back(
            {triangle[c], soup.group[t], static_cast<std::uint32_t>(t), triangle[(c + 1) % 3], triangle[(c + 2) % 3]});
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.vertex, a.group, a.triangle) < std::tie(b.vertex, b.group, b.triangle);
  });

  std::vector<std::uint32_t> copies;
  std::vector<std::size_t> parent;
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<std::pair<std::uint32_t, std::size_t>> starts;  // first side of a corner, corner
  std::vector<bool> met;                                      // a corner ends where these start
  std::vector<std::uint32_t> id_of_fan;                       // by the fan's root
  for (std::size_t begin = 0; begin < corners.size();) {
    const std::uint32_t vertex = corners[begin].vertex;
    bool original_taken = false;
    while (begin < corners.size() && corners[begin].vertex == vertex) {
      std::size_t end = begin;
      while (end < corners.size() && corners[end].vertex == vertex && corners[end].group == corners[begin].group) ++end;
      const std::size_t count = end - begin;
      parent.resize(count);
      std::iota(parent.begin(), parent.end(), std::size_t{0});
      const auto join = [&](std::size_t i, std::size_t j) {
        const std::size_t a = root(i), b = root(j);
        parent[std::max(a, b)] = std::min(a, b);
      };
      // Corners hang together where the side that one ends with is the side that others start with.
      starts.clear();
      for (std::size_t i = 0; i < count; ++i) starts.emplace_back(corners[begin + i].next, i);
      std::sort(starts.begin(), starts.end());
      met.assign(count, false);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t side = corners[begin + i].previous;
        const auto start = std::lower_bound(starts.begin(), starts.end(), std::pair(side, std::size_t{0}));
        if (start == starts.end() || start->first != side) continue;
        join(i, start->second);
        met[static_cast<std::size_t>(start - starts.begin())] = true;
      }
      for (std::size_t s = 1; s < count; ++s) {
        if (starts[s].first != starts[s - 1].first || !met[s - 1]) continue;
        join(starts[s - 1].second, starts[s].second);
        met[s] = true;
      }
      id_of_fan.assign(count, vertex);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t fan = root(i);
        if (fan == i) {  // roots are the smallest of their fan, so they come first
          if (original_taken) {
            id_of_fan[fan] = first_copy + static_cast<std::uint32_t>(copies.size());
            copies.push_back(vertex);
          }
          original_taken = true;
        }
        const std::uint32_t id = id_of_fan[fan];
        Triangle& triangle = soup.triangles[corners[begin + i].triangle];
        for (std::uint32_t& v : triangle)
          if (v == vertex) v = id;
      }
      begin = end;
    }
  }
  return copies;
}

/// Averages over the dual vertices around each added vertex.
struct Surroundings {
  glm::vec3 normal{0.0f};
  float k_min = 0.0f, k_max = 0.0f, ao = 0.0f;
  float count = 0.0f;
  std::uint8_t shape = 0;
};

std::vector<Surroundings> average_around_added(const SurfaceModel& model, const Soup& soup) {
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  const VertexAttributes& a = model.attributes;
  std::vector<Surroundings> result(soup.added.size());
  const auto position = [&](std::uint32_t v) { return v < dual ? model.mesh.positions[v] : soup.added[v - dual]; };
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const Triangle& t = soup.triangles[i];
    const bool patch = i >= soup.first_patch_triangle;
    for (const std::uint32_t v : t) {
      if (v < dual) continue;
      Surroundings& s = result[v - dual];
      if (patch) s.normal += glm::cross(position(t[1]) - position(t[0]), position(t[2]) - position(t[0]));
      for (const std::uint32_t w : t) {
        if (w >= dual) continue;
        s.count += 1.0f;
        if (!patch && !a.normals.empty()) s.normal += a.normals[w];
        if (!a.ao.empty()) s.ao += static_cast<float>(a.ao[w]);
        if (patch) continue;
        if (!a.k_min.empty()) s.k_min += a.k_min[w];
        if (!a.k_max.empty()) s.k_max += a.k_max[w];
        if (!a.shape.empty()) s.shape = a.shape[w];
      }
    }
  }
  // Inner vertices of a patch touch no dual vertex: they take the mean over the rims.
  float patch_ao = 0.0f, patch_count = 0.0f;
  for (std::size_t i = 0; i < result.size(); ++i)
    if (dual + i >= soup.first_patch_vertex) patch_ao += result[i].ao, patch_count += result[i].count;
  for (Surroundings& s : result) {
    const float length = glm::length(s.normal);
    s.normal = length > 0.0f ? s.normal / length : glm::vec3(0.0f, 0.0f, 1.0f);
    if (s.count > 0.0f) {
      s.k_min /= s.count;
      s.k_max /= s.count;
      s.ao /= s.count;
    } else if (patch_count > 0.0f) {
      s.ao = patch_ao / patch_count;
    }
  }
  return result;
}

/// Source of every output vertex, in output order, and the new id of every soup vertex that is used.
struct Numbering {
  std::vector<std::uint32_t> source;  ///< id in the soup, below dual + added; copies stand for their original
  std::vector<std::uint32_t> new_id;
};

Numbering number_vertices(const Soup& soup, std::size_t first_copy, const std::vector<std::uint32_t>& copies) {
  Numbering numbering;
  numbering.new_id.assign(first_copy + copies.size(), 0);
  for (const Triangle& t : soup.triangles)
    for (const std::uint32_t v : t) numbering.new_id[v] = 1;
  for (std::size_t v = 0; v < numbering.new_id.size(); ++v) {
    if (numbering.new_id[v] == 0) continue;
    numbering.new_id[v] = static_cast<std::uint32_t>(numbering.source.size());
    numbering.source.push_back(v < first_copy ? static_cast<std::uint32_t>(v) : copies[v - first_copy]);
  }
  return numbering;
}

void fill_attributes(const SurfaceModel& model, const Soup& soup, const Numbering& numbering,
                     const std::vector<Surroundings>& added, TriMesh& out) {
  const std::size_t dual = model.mesh.positions.size();
  const std::size_t count = numbering.source.size();
  const VertexAttributes& a = model.attributes;
  const auto gather = [&](const auto& from, auto& to, const auto& of_added) {
    if (from.empty() && dual > 0) return;
    to.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t v = numbering.source[i];
      to[i] = v < dual ? from[v] : of_added(added[v - dual]);
    }
  };
  out.positions.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t v = numbering.source[i];
    out.positions[i] = v < dual ? model.mesh.positions[v] : soup.added[v - dual];
  }
  gather(a.normals, out.normals, [](const Surroundings& s) { return s.normal; });
  gather(a.k_min, out.k_min, [](const Surroundings& s) { return s.k_min; });
  gather(a.k_max, out.k_max, [](const Surroundings& s) { return s.k_max; });
  gather(a.shape, out.shape, [](const Surroundings& s) { return s.shape; });
  gather(a.ao, out.ao, [](const Surroundings& s) { return static_cast<std::uint8_t>(s.ao + 0.5f); });
}

/// One TriMesh from triangles that were made before, so that several selections share the triangulation.
Result<TriMesh> assemble(const SurfaceModel& model, Triangulation triangulation, const MeshOptions& options,
                         std::vector<std::uint32_t>* source = nullptr) {
  DUBSAR_ASSIGN(const Selection selection, select(model, options));
  Soup soup;
  add_quads(model, selection, std::move(triangulation), soup);
  soup.first_patch_triangle = soup.triangles.size();
  soup.first_patch_vertex = model.mesh.positions.size() + soup.added.size();
  if (options.fill_holes) add_patches(model, selection, soup);

  const std::size_t first_copy = model.mesh.positions.size() + soup.added.size();
  if (first_copy > (std::size_t{1} << 31))
    return fail(ErrorKind::kTryAgain,
                "surface_model: {} vertices found, expected at most 2^31; crop or resample the input", first_copy);
  const std::vector<Surroundings> added = average_around_added(model, soup);
  const std::vector<std::uint32_t> copies =
      split_fans(soup, find_border(model, selection), static_cast<std::uint32_t>(first_copy));
  const Numbering numbering = number_vertices(soup, first_copy, copies);

  TriMesh out;
  fill_attributes(model, soup, numbering, added, out);
  for (Triangle& t : soup.triangles)
    for (std::uint32_t& v : t) v = numbering.new_id[v];
  out.triangles = std::move(soup.triangles);
  out.triangle_partition = std::move(soup.partition);
  if (soup.first_patch_triangle < out.triangles.size()) {
    out.triangle_inferred.assign(out.triangles.size(), 0);
    std::fill(out.triangle_inferred.begin() + static_cast<std::ptrdiff_t>(soup.first_patch_triangle),
              out.triangle_inferred.end(), std::uint8_t{1});
  }
  if (source != nullptr) {
    *source = numbering.source;
    for (std::uint32_t& v : *source)
      if (v >= model.mesh.positions.size()) v = kNoSource;
  }
  out.frame = model.frame;
  for (const Partition& partition : model.partitions)
    if (selection.group[partition.id] != kNotSelected) DUBSAR_TRY(out.partitions.insert(partition));
  out.provenance = model.provenance;
  return out;
}

}  // namespace

Result<TriMesh> make_tri_mesh(const SurfaceModel& model, const MeshOptions& options,
                              std::vector<std::uint32_t>* source) {
  DUBSAR_TRY(check_model(model));
  DUBSAR_TRY(check_size(model.mesh));
  return assemble(model, triangulate(model.mesh, model.attributes.normals), options, source);
}

Result<void> measure_partitions(SurfaceModel& model) {
  DUBSAR_TRY(check_model(model));
  DUBSAR_TRY(check_size(model.mesh));
  const Triangulation triangulation = triangulate(model.mesh, model.attributes.normals);
  for (std::size_t row = 0; row < model.partitions.size(); ++row) {
    const PartitionId id = model.partitions[row].id;
    DUBSAR_ASSIGN(const TriMesh mesh, assemble(model, triangulation, {.partition = id}));
    const MeshMeasure measure = measure_mesh(mesh);
    model.partitions.measured(id, measure.area_mm2, measure.volume_mm3, measure.watertight);
  }
  return {};
}

}  // namespace dubsar
