// What is read where tablet and envelope touch: phantoms of all kinds of contact, one row each.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/contact/trace.h"
#include "core/filter/resample.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"
#include "tests/core/phantom/contact_score.h"

namespace dubsar {
namespace {

struct Row {
  const char* name;
  phantom::PhantomOptions options;
};

std::vector<Row> rows(Dims dims, std::uint64_t seed) {
  std::vector<Row> all;
  const auto add = [&](const char* name, const auto& change) {
    phantom::PhantomOptions o;
    o.dims = dims;
    o.seed = seed + 17 * all.size();
    o.contact_share = 0.2;
    change(o);
    all.push_back({name, o});
  };
  using phantom::Contact;
  add("pressed", [](auto&) {});
  add("pockets", [](auto& o) { o.contact = Contact::kPockets; });
  for (const double film : {1.0, 0.5, 0.35, 0.2})
    add(film == 1.0    ? "film 1.0"
        : film == 0.5  ? "film 0.5"
        : film == 0.35 ? "film 0.35"
                       : "film 0.2",
        [&](auto& o) {
          o.contact = Contact::kFilm;
          o.film_vox = film;
        });
  add("filled", [](auto& o) { o.contact = Contact::kFilled; });
  add("unwritten", [](auto& o) { o.written = false; });
  add("unwritten film", [](auto& o) {
    o.written = false;
    o.contact = Contact::kFilm;
  });
  add("hard", [](auto& o) {
    o.contact = Contact::kPockets;
    o.contact_share = 0.25;
    o.snr_db = 14.0;
    o.rings = 0.03;
    o.gap_vox = 3.0;
  });
  return all;
}

std::vector<glm::vec3> in_voxels(const TriMesh& mesh) {
  std::vector<glm::vec3> positions;
  for (const glm::vec3& p : mesh.positions) positions.push_back(glm::vec3(mesh.frame.input_vox_from_grid(p)));
  return positions;
}

int run(int argc, char** argv) {
  const auto number = [&](int i, long other) { return argc > i ? std::atol(argv[i]) : other; };
  const Dims dims{number(1, 256), number(2, 160), number(3, 240)};
  const auto seed = static_cast<std::uint64_t>(number(4, 4711));
  const bool scan = number(5, 1) != 0;
  const std::string only = argc > 6 ? argv[6] : "";
  fmt::print("{:<16}{:>6}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>6}{:>7}{:>7}{:>7}\n", "contact", "free", "rms",
             "pocket", "shown", "film w", "filled", "near", "% film", "% inf", "false", "purity", "recall", "s");
  for (const Row& row : rows(dims, seed)) {
    if (!only.empty() && only != row.name) continue;
    const auto path = std::filesystem::temp_directory_path() / fmt::format("dubsar_contact_{}.h5", ::getpid());
    SilentProgress progress;
    const auto made = phantom::write_phantom(path, std::nullopt, row.options, progress);
    if (!made) return fmt::print("{}\n", made.error().message), 1;
    PipelineOptions options;
    options.import.path = path;
    options.occlusion = std::nullopt;
    options.detail = scan ? Detail::kScan : Detail::kHalf;
    options.trace_contact = false;
    auto result = run_pipeline(options, progress);
    if (!result) return fmt::print("{}\n", result.error().message), 1;
    auto source = open_volume(options.import).value();
    const double before = process_cpu_seconds();
    std::unique_ptr<HalfResolutionSource> half;
    if (!scan) half = std::make_unique<HalfResolutionSource>(*source);
    ContactOptions contact;
    if (!scan) contact.reach = 7.0f;
    const auto traced =
        trace_contact(result->model, scan ? static_cast<SlabSource&>(*source) : *half, contact, progress);
    const double seconds = process_cpu_seconds() - before;
    std::filesystem::remove(path);
    if (!traced) return fmt::print("{}\n", traced.error().message), 1;
    if (!traced->traced) fmt::print("{}: {}\n", row.name, traced->why);
    const auto truth = phantom::Phantom::create(row.options).value();
    const TriMesh tablet = make_tri_mesh(result->model, {.body = "tablet"}).value();
    const auto positions = in_voxels(tablet);
    const double step = scan ? 1.0 : 2.0;
    const auto score = phantom::judge_contact(*truth, {positions, tablet.triangles, {}, step}, tablet.evidence);
    const TriMesh seen = make_tri_mesh(result->model, {.fill_holes = false}).value();
    std::vector<PartitionId> labels(seen.positions.size());
    for (std::size_t t = 0; t < seen.triangles.size(); ++t)
      for (const std::uint32_t v : seen.triangles[t]) labels[v] = seen.partition_of(t);
    const auto seen_positions = in_voxels(seen);
    const auto all = phantom::compare(*truth, {seen_positions, seen.triangles, labels, step});
    const auto percent = [&](std::size_t e) {
      return 100.0 * static_cast<double>(score.evidence[e]) /
             std::max<double>(1.0, static_cast<double>(score.contact_vertices));
    };
    fmt::print(
        "{:<16}{:>6.3f}{:>7.3f}{:>7.3f}{:>7.3f}{:>7.3f}{:>7.3f}{:>7.3f}{:>7.1f}{:>7.1f}{:>6}{:>7.4f}{:>7.4f}{:>7.2f}\n",
        row.name, score.cases[0].kept_fraction(), all.resolved.rms * step, score.cases[1].kept_fraction(),
        score.cases[1].shown_fraction(), score.cases[2].kept_fraction(), score.cases[3].kept_fraction(),
        score.near_fraction(), percent(2), percent(3), score.false_wedges, all.owner[0].purity(), all.owner[0].recall(),
        seconds);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) {
  if (getenv("VERBOSE"))
    dubsar::set_log_handler([](dubsar::LogLevel, std::string_view m) { fmt::print(stderr, "{}\n", m); });
  return dubsar::run(argc, argv);
}
