#include "core/parts/surface_model.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/extract/triangulate.h"
#include "core/mesh/evidence.h"
#include "core/mesh/vertex_attributes.h"
#include "core/parts/split_fans.h"
#include "core/parts/triangle_soup.h"

namespace dubsar {
namespace {

constexpr std::int64_t kModelGrain = 1 << 14;
constexpr std::uint8_t kNotSelected = PartitionTable::kNone;

/// Triangles are counted in 32 bits; a polygon with doubled corners gives at most four more each. (The few fans beside
/// them have room: triangulate() looks again.)
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
  Result<void> fits;
  for_each_attribute([&](const auto& a) {
    const std::size_t size = (model.attributes.*a.values).size();
    if (fits && size != 0 && size != vertices)
      fits = fail(ErrorKind::kBadData, "surface_model: {} {} found, expected one for each of {} vertices", size, a.name,
                  vertices);
  });
  DUBSAR_TRY(fits);
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
    if (!patch.evidence.empty() && patch.evidence.size() != patch.extra_positions.size())
      return fail(ErrorKind::kBadData, "surface_model: a fill patch has {} vertices but evidence for {}",
                  patch.extra_positions.size(), patch.evidence.size());
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
    const auto partition = static_cast<PartitionId>(id);
    if (wanted) selection.group[id] = options.separate_partitions ? partition : partitions.body_of(partition);
    found = found || wanted;
  }
  if (!found)
    return fail(ErrorKind::kUsage, "surface_model: there is no part \"{}\", expected one of: {}", *options.body,
                fmt::join(partitions.body_names(), ", "));
  return selection;
}

void add_quads(const SurfaceModel& model, const Selection& selection, Triangulation triangulation, TriangleSoup& soup) {
  const std::size_t quads = model.mesh.quads.size();
  soup.added = std::move(triangulation.steiner);
  soup.bends = std::move(triangulation.face_points);
  for (auto* const labels : {&soup.partition, &soup.group}) {
    labels->reserve(triangulation.triangles.capacity());
    labels->resize(triangulation.triangles.size());
  }
  soup.triangles = std::move(triangulation.triangles);
  const auto id_of = [&](std::size_t q) {
    return model.quad_partition.empty() ? std::uint8_t{0} : model.quad_partition[q];
  };
  const bool everything =
      std::none_of(selection.group.begin(), selection.group.end(), [](std::uint8_t g) { return g == kNotSelected; });
  if (everything) {
    parallel_for(static_cast<std::int64_t>(quads), kModelGrain, [&](std::int64_t i) {
      const auto q = static_cast<std::size_t>(i);
      const std::uint8_t id = id_of(q), group = selection.group[id];
      for (std::size_t t = triangulation.first_triangle[q]; t < triangulation.first_triangle[q + 1]; ++t) {
        soup.partition[t] = id;
        soup.group[t] = group;
      }
    });
    return;
  }
  std::size_t kept = 0;
  for (std::size_t q = 0; q < quads; ++q) {
    const std::uint8_t id = id_of(q);
    if (selection.group[id] == kNotSelected) continue;
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

/// Triangles that add_patches() adds at most.
std::size_t patch_triangles(const SurfaceModel& model) {
  std::size_t count = 0;
  for (const FillPatch& patch : model.patches) count += 2 * patch.triangles.size();
  return count;
}

/// The triangles that a model draws, with room for `more`.
Triangulation drawing_of(const SurfaceModel& model, std::size_t more) {
  if (!model.drawing) return triangulate(model.mesh, model.attributes.normals, more);
  const Triangulation& own = *model.drawing;
  Triangulation copy{{}, own.first_triangle, own.steiner, own.face_points};
  copy.triangles.reserve(own.triangles.size() + more);
  copy.triangles.assign(own.triangles.begin(), own.triangles.end());
  return copy;
}

/// Calls add(triangle) for a triangle, or for those that it is cut into where sides of x-quads that it shares have
/// points, whose ids begin with first_bend.
template <class Add>
void cut_at_bends(const TriangleSoup& soup, std::size_t first_bend, std::uint32_t dual, const Triangle& t,
                  const Add& add) {
  for (std::size_t i = 0; i < 3 && !soup.bends.empty(); ++i) {
    const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    if (a >= dual || b >= dual) continue;
    const auto point = find_face_point(soup.bends, a, b);
    if (!point) continue;
    const auto middle = static_cast<std::uint32_t>(first_bend + *point);
    cut_at_bends(soup, first_bend, dual, {a, middle, c}, add);
    cut_at_bends(soup, first_bend, dual, {middle, b, c}, add);
    return;
  }
  add(t);
}

void add_patches(const SurfaceModel& model, const Selection& selection, TriangleSoup& soup) {
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  soup.first_patch_triangle = soup.triangles.size();
  soup.first_patch_vertex = dual + soup.added.size();
  const auto add_side = [&](const FillPatch& patch, std::uint8_t id, bool reversed) {
    const auto base = static_cast<std::uint32_t>(dual + soup.added.size());
    soup.added.insert(soup.added.end(), patch.extra_positions.begin(), patch.extra_positions.end());
    if (patch.evidence.empty())
      soup.patch_evidence.resize(soup.patch_evidence.size() + patch.extra_positions.size(),
                                 evidence_byte(Evidence::kInferred));
    else
      soup.patch_evidence.insert(soup.patch_evidence.end(), patch.evidence.begin(), patch.evidence.end());
    for (Triangle t : patch.triangles) {
      for (std::uint32_t& v : t)
        if (v >= dual) v = v - dual + base;
      if (reversed) std::swap(t[1], t[2]);
      cut_at_bends(soup, soup.first_patch_vertex - soup.bends.size(), dual, t, [&](const Triangle& piece) {
        soup.triangles.push_back(piece);
        soup.partition.push_back(id);
        soup.group.push_back(selection.group[id]);
      });
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

/// Source of every output vertex, in output order, and the new id of every soup vertex that is used.
struct Numbering {
  std::vector<std::uint32_t> source;  ///< id in the soup, below dual + added; copies stand for their original
  std::vector<std::uint32_t> new_id;
};

Numbering number_vertices(const TriangleSoup& soup, std::size_t first_copy, const std::vector<std::uint32_t>& copies) {
  Numbering numbering;
  std::vector<std::uint32_t>& id = numbering.new_id;
  resize_large(id, first_copy + copies.size());
  const auto vertices = static_cast<std::int64_t>(id.size());
  parallel_for(static_cast<std::int64_t>(soup.triangles.size()), kModelGrain, [&](std::int64_t t) {
    for (const std::uint32_t v : soup.triangles[static_cast<std::size_t>(t)])
      std::atomic_ref(id[v]).store(1, std::memory_order_relaxed);
  });
  std::vector<std::int64_t> start(static_cast<std::size_t>((vertices + kModelGrain - 1) / kModelGrain));
  const auto chunk_of = [](std::int64_t begin) { return static_cast<std::size_t>(begin / kModelGrain); };
  parallel_chunks(vertices, kModelGrain, [&](std::int64_t begin, std::int64_t end) {
    start[chunk_of(begin)] = std::accumulate(id.begin() + begin, id.begin() + end, std::int64_t{0});
  });
  resize_large(numbering.source, static_cast<std::size_t>(exclusive_scan(start)));
  parallel_chunks(vertices, kModelGrain, [&](std::int64_t begin, std::int64_t end) {
    auto next = static_cast<std::uint32_t>(start[chunk_of(begin)]);
    for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
      if (id[v] == 0) continue;
      id[v] = next;
      numbering.source[next++] = v < first_copy ? static_cast<std::uint32_t>(v) : copies[v - first_copy];
    }
  });
  return numbering;
}

/// Positions and attributes of the output vertices.
void fill_vertices(const SurfaceModel& model, const TriangleSoup& soup, const Numbering& numbering,
                   const VertexAttributes& added, const MeshOptions& options, TriMesh& out) {
  const std::size_t dual = model.mesh.positions.size();
  const auto gather = [&](const auto& from, const auto& from_added, auto& to) {
    resize_large(to, numbering.source.size());
    parallel_for(static_cast<std::int64_t>(to.size()), kModelGrain, [&](std::int64_t k) {
      const auto i = static_cast<std::size_t>(k);
      const std::uint32_t v = numbering.source[i];
      to[i] = v < dual ? from[v] : from_added[v - dual];
    });
  };
  gather(model.mesh.positions, soup.added, out.positions);
  for_each_attribute([&](const auto& a) {
    const auto& values = model.attributes.*a.values;
    if (!values.empty() && takes(options, a)) gather(values, added.*a.values, out.*a.values);
  });
}

/// How each vertex is known, and which triangles are not: those of patches, but for films.
void fill_evidence(const TriangleSoup& soup, const Numbering& numbering, TriMesh& out) {
  if (out.evidence.empty()) out.evidence.assign(out.positions.size(), evidence_byte(Evidence::kMeasured));
  parallel_for(static_cast<std::int64_t>(numbering.source.size()), kModelGrain, [&](std::int64_t v) {
    const auto i = static_cast<std::size_t>(v);
    if (numbering.source[i] >= soup.first_patch_vertex)
      out.evidence[i] = soup.patch_evidence[numbering.source[i] - soup.first_patch_vertex];
  });
  if (soup.first_patch_triangle >= out.triangles.size()) return;
  out.triangle_inferred.assign(out.triangles.size(), 0);
  for (std::size_t t = soup.first_patch_triangle; t < out.triangles.size(); ++t) {
    // A triangle between vertices of the rim alone knows nothing either.
    bool film = false, inferred = false;
    for (const std::uint32_t v : out.triangles[t]) {
      if (numbering.source[v] < soup.first_patch_vertex) continue;
      film = film || out.evidence[v] == evidence_byte(Evidence::kFilm);
      inferred = inferred || out.evidence[v] == evidence_byte(Evidence::kInferred);
    }
    out.triangle_inferred[t] = inferred || !film;
  }
}

}  // namespace

Result<TriMesh> make_tri_mesh(const SurfaceModel& model, const MeshOptions& options,
                              std::vector<std::uint32_t>* source) {
  DUBSAR_TRY(check_model(model));
  DUBSAR_TRY(check_size(model.mesh));
  DUBSAR_ASSIGN(const Selection selection, select(model, options));
  TriangleSoup soup;
  const std::size_t more = options.fill_holes ? patch_triangles(model) : 0;
  add_quads(model, selection, drawing_of(model, more), soup);
  soup.first_patch_triangle = soup.triangles.size();
  soup.first_patch_vertex = model.mesh.positions.size() + soup.added.size();
  if (options.fill_holes) add_patches(model, selection, soup);

  const std::size_t first_copy = model.mesh.positions.size() + soup.added.size();
  if (first_copy > (std::size_t{1} << 31))
    return fail(ErrorKind::kTryAgain, "surface_model: {} vertices found, expected at most 2^31", first_copy);
  const VertexAttributes added = attributes_of_added(model, soup, options);
  std::vector<std::uint8_t> border = border_vertices(model, selection.group);
  border.resize(soup.first_patch_vertex - soup.bends.size(), 0);
  border.resize(first_copy, 1);  // parts may meet at a point of a face, and a patch may touch itself, too
  DUBSAR_ASSIGN(const std::vector<std::uint32_t> copies,
                split_fans(soup, border, static_cast<std::uint32_t>(first_copy), options.progress));
  const Numbering numbering = number_vertices(soup, first_copy, copies);

  TriMesh out;
  fill_vertices(model, soup, numbering, added, options, out);
  parallel_for(static_cast<std::int64_t>(soup.triangles.size()), kModelGrain, [&](std::int64_t t) {
    for (std::uint32_t& v : soup.triangles[static_cast<std::size_t>(t)]) v = numbering.new_id[v];
  });
  out.triangles = std::move(soup.triangles);
  out.triangle_partition = std::move(soup.partition);
  fill_evidence(soup, numbering, out);
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

}  // namespace dubsar
