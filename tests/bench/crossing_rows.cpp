// Do surfaces of EXA files cross or touch themselves, by exact predicates? The surface alone, and its parts as they are
// exported: crossing_rows FILE...
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <set>

#include "core/exa/exa_file.h"
#include "core/extract/cell_pieces.h"
#include "core/extract/extract.h"
#include "core/extract/quad_cuts.h"
#include "core/extract/triangulate.h"
#include "core/mesh/exact_crossings.h"
#include "core/mesh/mesh_check.h"
#include "core/relief/smoothing/smooth.h"

namespace dubsar {
namespace {

template <class T>
T value_or_stop(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "crossing_rows: {}\n", result.error().message);
  std::exit(1);
}

void print_row(const std::string& name, std::span<const glm::vec3> positions, std::span<const Triangle> triangles) {
  const ExactCheck exact = check_exactly(positions, triangles);
  const MeshCheck check = check_mesh(positions, triangles);
  fmt::print("  {:<24} {:>9} triangles, {:>5} crossing pairs, {:>5} of zero area, {}\n", name, triangles.size(),
             exact.crossing_pairs, exact.zero_area_triangles,
             check.watertight() ? "closed 2-manifold"
             : check.manifold() ? "open 2-manifold"
                                : "no 2-manifold");
}

void print_file(const char* path) {
  SilentProgress progress;
  SurfaceModel model = value_or_stop(read_exa(path, progress));
  fmt::print("{}: {} vertices, {}\n", path, model.mesh.vertex_count(), model.mesh.embedded ? "embedded" : "free");
  for (const bool embedded : {false, true}) {
    model.mesh.embedded = embedded;
    const Triangulation cut = triangulate(model.mesh, model.attributes.normals);
    std::vector<glm::vec3> positions = model.mesh.positions;
    positions.insert(positions.end(), cut.steiner.begin(), cut.steiner.end());
    print_row(embedded ? "surface, embedded cut" : "surface, free cut", positions, cut.triangles);
  }
  double seconds = 1e9;
  QuadCuts cuts;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    cuts = find_cuts(model.mesh);
    seconds = std::min(seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  double making = 1e9;  // the same surface extracted and smoothed
  for (int run = 0; run < 2; ++run) {
    const auto start = std::chrono::steady_clock::now();
    QuadMesh mesh = value_or_stop(build_quad_mesh(model.samples, progress));
    std::vector<glm::vec3> normals;
    value_or_stop(smooth(mesh, normals, {}, progress));
    making = std::min(making, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::array<std::int64_t, 5> count{};
  for (const QuadCut cut : cuts.of_quad) ++count[static_cast<std::size_t>(cut)];
  fmt::print(
      "  x-quads: {} free, {} + {} + {} diagonals, {} fans; {} face points, {} cells touch; {} cells of several "
      "pieces; "
      "{:.0f} ns an x-quad, extraction and smoothing {:.0f}\n",
      count[0], count[1], count[2], count[3], count[4], cuts.face_points.size(), cuts.touching.size(),
      cells_of_several_pieces(model.mesh).size(), seconds * 1e9 / static_cast<double>(model.mesh.quad_count()),
      making * 1e9 / static_cast<double>(model.mesh.quad_count()));
  std::set<std::string> bodies;
  for (const Partition& partition : model.partitions) bodies.insert(std::string(partition.body_name()));
  for (const std::string& body : bodies) {
    MeshOptions options;
    options.body = body;
    const TriMesh part = value_or_stop(make_tri_mesh(model, options));
    print_row(body, part.positions, part.triangles);
  }
}

}  // namespace
}  // namespace dubsar

int main(int count, char** arguments) {
  for (int i = 1; i < count; ++i) dubsar::print_file(arguments[i]);
}
