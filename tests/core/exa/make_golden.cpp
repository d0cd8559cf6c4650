// make_golden FOLDER: writes the golden files of this version of the format. Run it when the version changes, then
// write down what exa_reader.py prints; never to make a test pass.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/exa/exa_file.h"
#include "core/exa/offsets/settle.h"
#include "core/exa/offsets/settle_labelled.h"
#include "core/extract/edge_index.h"
#include "core/extract/extract.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/relief/curvature/shape_class.h"
#include "core/relief/smoothing/smooth.h"

namespace {
using namespace dubsar;

struct Sample {
  const char* name;
  Dims dims;
  double noise;
  bool closed;
  int bits;
  bool smoothed, exact;
  unsigned seed;
  bool evidence = false;
};

SurfaceModel make(const Sample& sample) {
  std::mt19937 random(sample.seed);
  const auto uniform = [&] { return static_cast<double>(random() % 65536) / 32768.0 - 1.0; };
  Volume<float> volume(sample.dims);
  for (std::int64_t z = 0; z < sample.dims.z; ++z)
    for (std::int64_t y = 0; y < sample.dims.y; ++y)
      for (std::int64_t x = 0; x < sample.dims.x; ++x)
        volume.at(x, y, z) =
            static_cast<float>(std::sin(.31 * static_cast<double>(x)) + std::sin(.27 * static_cast<double>(y) + 1.0) +
                               std::sin(.23 * static_cast<double>(z)) - .2 + sample.noise * uniform());
  VolumeSource source(volume);
  SilentProgress progress;
  SurfaceModel model;
  model.samples =
      sample_surface(source, {.isovalue = .125f, .offset_bits = sample.bits, .closed = sample.closed}, progress)
          .value();
  model.mesh = build_quad_mesh(model.samples, progress).value();
  model.frame.scale = {2, 2, 2};
  model.frame.origin_vox = {.5, .5, .5};
  model.frame.input_voxel = {{.038, .038, .04}, "/entry/data@pixel_size"};
  model.provenance = "{\"program\":\"dubsar\"}";
  if (!sample.smoothed) return model;
  VertexAttributes& a = model.attributes;
  smooth(model.mesh, a.normals, {}, progress).value();
  auto k = principal_curvatures(model.mesh, a.normals, CurvatureMethod::kFit, progress).value();
  a.k_min = k.k_min;
  a.k_max = k.k_max;
  a.shape = shape_classes(k.k_min, k.k_max);
  for (const glm::vec3& p : model.mesh.positions)
    a.ao.push_back(static_cast<std::uint8_t>(
        std::clamp(40.0 + 20.0 * std::sin(.1 * double{p.x} + .07 * double{p.z}) + 2.0 * uniform(), 0.0, 63.0)));
  SettleOptions settle;
  settle.exact_normals = sample.exact;
  settle_for_exa(model, settle, progress).value();
  if (sample.exact) a.shape[5] = static_cast<std::uint8_t>((a.shape[5] + 1) % 127);  // so that the classes are stored
  for (const auto& quad : model.mesh.quads)
    model.quad_partition.push_back(model.mesh.positions[quad[0]].x > static_cast<float>(sample.dims.x) / 2 ? 1 : 0);
  model.partitions.insert({0, "tablet", "tablet", 1.5, 2.5, true});
  model.partitions.insert({1, "envelope outside", "envelope", 3.5, -4.5, false});
  if (!sample.evidence) return model;
  for (const glm::vec3& p : model.mesh.positions)
    a.evidence.push_back(static_cast<std::uint8_t>(p.x < 9.5f ? 0 : p.y < 12.0f ? 1 : p.z + uniform() < 14.0 ? 2 : 3));
  return model;
}

/// A tablet in an envelope: two balls with the same middle, half of the way between them air, half contact.
SurfaceModel make_parts(unsigned seed) {
  std::mt19937 random(seed);
  const Dims dims{33, 27, 28};
  const auto radius = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return std::hypot(static_cast<double>(x) - 16.2, static_cast<double>(y) - 13.1, static_cast<double>(z) - 13.4);
  };
  const auto inner = [](std::int64_t x, std::int64_t y) {
    return 6.8 + .7 * std::sin(.9 * static_cast<double>(x)) * std::cos(.8 * static_cast<double>(y));
  };
  SurfaceModel model;
  Volume<float> volume(dims);
  EnvelopeBits envelope(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) {
        const double r = radius(x, y, z), film = std::abs(r - inner(x, y)) - (x > 17 ? 1.1 : 0.0);
        volume.at(x, y, z) = static_cast<float>(std::min(11.5 - r, film) + .1 * static_cast<double>(random() % 8));
        envelope.set(x, y, z, r > inner(x, y));
      }
  VolumeSource source(volume);
  SilentProgress progress;
  model.samples = sample_surface(source, {.isovalue = .125f, .offset_bits = 4, .closed = true}, progress).value();
  envelope.compact(model.samples.signs);
  model.labelled.emplace().envelope = envelope;
  const PointLabels labels(model.samples.signs, model.labelled->envelope);
  const ContactEdges edges(labels);
  for (std::size_t i = 0; i < edges.all().size(); ++i)
    model.labelled->contact.push_back(static_cast<std::uint16_t>(4 + random() % 8));
  model.mesh = build_quad_mesh(model.samples, progress).value();
  for (std::size_t v = 0; v < model.mesh.positions.size(); ++v)
    model.attributes.ao.push_back(static_cast<std::uint8_t>(40 + random() % 4));
  for (const auto& quad : model.mesh.quads) {
    const glm::vec3& at = model.mesh.positions[quad[0]];
    const double r = std::hypot(at.x - 16.2, at.y - 13.1, at.z - 13.4);
    model.quad_partition.push_back(r > 9.0 ? 1 : r > 6.8 ? 2 : 0);
  }
  model.partitions = {{0, "tablet", "", 0.0, 0.0, false},
                      {1, "envelope outside", "envelope", 0.0, 0.0, false},
                      {2, "envelope inside", "envelope", 0.0, 0.0, false}};
  const EdgeIndex index = EdgeIndex::create(model.samples).value();
  LabelledMesh labelled =
      build_labelled_mesh(model.samples, index, labels, edges, model.labelled->contact, progress).value();
  for (std::size_t v = labelled.first_mixed; v < labelled.mesh.positions.size(); ++v)
    if (!labelled.is_at_air(v)) model.labelled->evidence.push_back(static_cast<std::uint8_t>(2 + (random() % 4 == 0)));
  settle_labelled(model, std::move(labelled), CurvatureMethod::kFit, false, progress).value();
  return model;
}
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "make_golden FOLDER\n");
    return 64;
  }
  const Sample sample{"exa7_bricks.exa", {129, 6, 5}, .05, true, 4, true, false, 5, true};
  for (const auto& [name, model] : {std::pair{sample.name, make(sample)}, {"exa7_labels.exa", make_parts(7)}}) {
    SilentProgress progress;
    const auto stats = write_exa(std::string(argv[1]) + "/" + name, model, progress);
    if (!stats) {
      fmt::print(stderr, "{}\n", stats.error().message);
      return exit_code(stats.error().kind);
    }
    fmt::print("{} {} vertices {:.3f} bits a vertex\n", name, stats->vertices, stats->bits_per_vertex);
  }
  return 0;
}
