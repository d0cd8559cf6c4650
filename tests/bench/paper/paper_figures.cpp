#include "tests/bench/paper/paper_figures.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/extract/extract.h"
#include "tests/bench/paper/paper_profile.h"
#include "tests/bench/paper/paper_signs.h"

namespace dubsar {
namespace {

double bits_of(const std::vector<std::string>& chunks) {
  double bits = 0.0;
  for (const std::string& chunk : chunks) bits += 8.0 * static_cast<double>(chunk.size());
  return bits;
}

}  // namespace

Result<void> print_paper_figures(SurfaceModel model, Progress& progress) {
  if (model.labelled)
    return fail(ErrorKind::kUsage, "the paper's code holds no parts that touch; process with --no-fill-holes");
  DUBSAR_TRY(settle_for_paper(model, {}, progress));
  DUBSAR_ASSIGN(const QuadMesh base, build_quad_mesh(model.samples, progress));
  const SurfaceSamples& samples = model.samples;
  const std::vector<std::uint16_t> joined(samples.joined.begin(), samples.joined.end());
  const auto places = encode_paper_positions(base.positions, model.mesh.positions, progress);
  const auto normals = encode_paper_normals(model.attributes.normals, progress);
  if (!places || !normals) return fail(ErrorKind::kInternal, "a place or normal is on no step");
  const PaperWords words = encode_paper_words(model, true, progress);
  struct Row {
    const char* what;
    double bits, printed;
  };
  const Row rows[] = {
      {"topology", bits_of(encode_signs_as_paper(samples.signs)) + bits_of(encode_paper_bits(joined, 1, progress)),
       1.168},
      {"crossings", bits_of(encode_paper_bits(samples.offsets, samples.offset_bits, progress)), 3.984},
      {"places", bits_of(*places), 19.9},
      {"normals", bits_of(*normals), 19.1},
      {"shape, partition, light", bits_of(words.words) + bits_of(words.exceptions), 16.1},
  };
  fmt::print("{:<28}{:>12}{:>12}\n", "coded as in the paper", "bits a vertex", "printed");
  double all = 0.0;
  for (const Row& row : rows) {
    const double bits = row.bits / static_cast<double>(model.mesh.vertex_count());
    all += bits;
    fmt::print("{:<28}{:>12.3f}{:>12.3f}\n", row.what, bits, row.printed);
  }
  fmt::print("{:<28}{:>12.3f}{:>12.3f}\n", "all of these", all, 60.223);
  return {};
}

}  // namespace dubsar
