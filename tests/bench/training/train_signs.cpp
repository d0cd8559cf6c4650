// train_signs OUT.inc NAME UNITS EPOCHS FILE.exa ... [-- TEST.exa ...]: fits a network of signs to the surfaces of EXA
// files and writes its table of weights; with test files, the bits a vertex that their points take. Weights are part of
// a version of the format: new ones are a new model, never a change of an old one (docs/exa.md, "Training").

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "core/exa/exa_file.h"
#include "tests/bench/training/sign_trainer.h"

namespace {
using namespace dubsar;

bool read_number(const char* text, int& number) {
  const std::string_view view(text);
  return std::from_chars(view.data(), view.data() + view.size(), number).ptr == view.data() + view.size();
}

Result<std::int64_t> add_file(const std::string& path, SignSamples& samples) {
  SilentProgress progress;
  DUBSAR_ASSIGN(const SurfaceModel model, read_exa(path, progress, {.recompute = false}));
  add_sign_samples(model.samples.signs, samples);
  return model.mesh.vertex_count();
}

Result<void> run(const SignTraining& training, const std::string& out, const std::string& name,
                 const std::vector<std::string>& files, const std::vector<std::string>& tests) {
  SignSamples samples;
  for (const std::string& file : files) {
    DUBSAR_TRY(add_file(file, samples));
  }
  const std::array<SignWeights, 7> weights = train_signs(samples, training);
  std::ofstream table(out);
  table << sign_weights_text(weights, training.units, name);
  if (!table.flush()) return fail(ErrorKind::kCannotCreate, "{}: cannot be written", out);
  for (const std::string& file : tests) {
    SignSamples own;
    DUBSAR_ASSIGN(const std::int64_t vertices, add_file(file, own));
    fmt::print("{}: {:.4f} bits a vertex without flags\n", file,
               sign_bits(own, weights, training.units) / static_cast<double>(vertices));
  }
  return {};
}
}  // namespace

int main(int argc, char** argv) {
  dubsar::SignTraining training;
  int units = 0;
  if (argc < 6 || !read_number(argv[3], units) || (units != 16 && units != 64) ||
      !read_number(argv[4], training.epochs) || training.epochs < 1) {
    fmt::print(stderr, "train_signs OUT.inc NAME 16|64 EPOCHS FILE.exa ... [-- TEST.exa ...]\n");
    return 64;
  }
  training.units = static_cast<std::size_t>(units);
  std::vector<std::string> files, tests;
  bool testing = false;
  for (int i = 5; i < argc; ++i) {
    if (argv[i] == std::string("--"))
      testing = true;
    else
      (testing ? tests : files).emplace_back(argv[i]);
  }
  const auto done = run(training, argv[1], argv[2], files, tests);
  if (done) return 0;
  fmt::print(stderr, "{}\n", done.error().message);
  return exit_code(done.error().kind);
}
