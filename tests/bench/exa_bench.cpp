// exa_bench [FILE.exa ...]: bits and speed of EXA on spheres and on the surfaces of files, next to the paper's figures.
// One line each: signs, signs with offsets, speeds of both together, threads as they are.

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "core/base/parallel.h"
#include "core/exa/chunks.h"
#include "core/exa/exa_file.h"
#include "core/exa/offsets.h"
#include "core/exa/topology.h"
#include "core/extract/extract.h"

namespace {
using namespace dubsar;

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

SurfaceSamples sphere(std::int64_t n) {
  Volume<float> volume({n, n, n});
  const double centre = 0.5 * static_cast<double>(n - 1), radius = 0.45 * static_cast<double>(n);
  parallel_for(n, 1, [&](std::int64_t z) {
    for (std::int64_t y = 0; y < n; ++y)
      for (std::int64_t x = 0; x < n; ++x) {
        const double dx = static_cast<double>(x) - centre, dy = static_cast<double>(y) - centre,
                     dz = static_cast<double>(z) - centre;
        volume.at(x, y, z) = static_cast<float>(radius - std::sqrt(dx * dx + dy * dy + dz * dz));
      }
  });
  VolumeSource source(volume);
  SilentProgress progress;
  return sample_surface(source, {.isovalue = 0.0f}, progress).value();
}

std::size_t bytes_of(const std::vector<std::string>& chunks) { return join_chunks(chunks).size(); }

void print(const std::string& name, const SurfaceSamples& samples) {
  SilentProgress progress;
  const double vertices = static_cast<double>(build_quad_mesh(samples, progress).value().vertex_count());
  const double start = now_s();
  const SignCode signs = encode_signs(samples.signs, progress).value();
  const SampleCode code = encode_samples(samples, progress).value();
  const double encoded = now_s();
  SignChunks chunks;
  chunks.coarse.assign(signs.coarse.begin(), signs.coarse.end());
  std::size_t sign_bytes = bytes_of(signs.coarse);
  for (std::size_t level = 0; level < 3; ++level) {
    chunks.bricks[level].assign(signs.bricks[level].begin(), signs.bricks[level].end());
    sign_bytes += bytes_of(signs.bricks[level]);
  }
  const std::vector<std::string_view> offsets(code.offsets.begin(), code.offsets.end()),
      faces(code.faces.begin(), code.faces.end());
  const double begin = now_s();
  SurfaceSamples back = samples;
  back.signs = decode_signs(chunks, samples.dims, 0, std::nullopt, ~std::uint64_t{0}, progress).value();
  const bool same = decode_samples(offsets, faces, back, progress).has_value() && back == samples;
  const double decoded = now_s();
  const double all = 8.0 * static_cast<double>(sign_bytes + bytes_of(code.offsets) + bytes_of(code.faces));
  fmt::print("{:<28}{:>10.0f}{:>10.4f}{:>10.4f}{:>12.2f}{:>12.2f}  {}\n", name, vertices,
             8.0 * static_cast<double>(sign_bytes) / vertices, all / vertices, vertices / (encoded - start) * 1e-6,
             vertices / (decoded - begin) * 1e-6, same ? "lossless" : "DIFFERENT");
}
}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:<28}{:>10}{:>10}{:>10}{:>12}{:>12}\n", "surface", "vertices", "signs", "+offsets", "Mv/s enc",
             "Mv/s dec");
  fmt::print("{:<28}{:>10}{:>10}\n", "paper, sphere 256", 248426, 0.869);
  fmt::print("{:<28}{:>10}{:>10}\n", "paper, sphere 512", 996842, 0.871);
  print("sphere 256", sphere(256));
  print("sphere 512", sphere(512));
  SilentProgress progress;
  for (int i = 1; i < argc; ++i) {
    const auto model = read_exa(argv[i], progress);
    if (!model) {
      fmt::print(stderr, "{}\n", model.error().message);
      return exit_code(model.error().kind);
    }
    print(argv[i], model->samples);
  }
  return 0;
}
