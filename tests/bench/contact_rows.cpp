#include "tests/bench/contact_rows.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/base/system/parallel.h"
#include "core/mesh/evidence.h"
#include "core/mesh/exact_crossings.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"

namespace dubsar {
namespace {

template <class T>
T value_or_exit(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "wedges_bench: {}\n", result.error().message);
  std::exit(1);
}

std::vector<glm::vec3> in_voxels(const TriMesh& mesh) {
  std::vector<glm::vec3> positions;
  positions.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) positions.push_back(glm::vec3(mesh.frame.input_vox_from_grid(p)));
  return positions;
}

phantom::TruthComparison judge_seen(const phantom::Phantom& truth, const SurfaceModel& model, double step) {
  const TriMesh seen = value_or_exit(make_tri_mesh(model, {.fill_holes = false}));
  std::vector<PartitionId> labels(seen.triangles.size());
  for (std::size_t t = 0; t < labels.size(); ++t) labels[t] = seen.partition_of(t);
  return phantom::compare(truth, {in_voxels(seen), seen.triangles, labels, step});
}

void judge_tablet(const phantom::Phantom& truth, const TriMesh& tablet, const std::vector<glm::vec3>& positions,
                  JudgedRow& judged) {
  constexpr double kSlit = 1.5, kStray = 3.0;
  struct Sum {
    double squares = 0.0;
    std::int64_t open = 0, stray = 0, all = 0;
  };
  const Sum sum = parallel_reduce<Sum>(
      static_cast<std::int64_t>(positions.size()), 4096, {},
      [&](std::int64_t begin, std::int64_t end) {
        Sum part;
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          if (!tablet.evidence.empty() && tablet.evidence[i] == evidence_byte(Evidence::kInferred)) continue;
          const glm::dvec3 p(positions[i]);
          const double off = std::abs(truth.tablet_distance(p));
          ++part.all;
          part.stray += off > kStray;
          if (truth.gap_width(p) < kSlit) continue;
          ++part.open;
          part.squares += off * off;
        }
        return part;
      },
      [](Sum a, const Sum& b) {
        return Sum{a.squares + b.squares, a.open + b.open, a.stray + b.stray, a.all + b.all};
      });
  judged.tablet.rms = std::sqrt(sum.squares / std::max<double>(1.0, static_cast<double>(sum.open)));
  judged.tablet.stray = static_cast<double>(sum.stray) / std::max<double>(1.0, static_cast<double>(sum.all));
}

void count_crossings(const TriMesh& mesh, JudgedRow& judged) {
  const ExactCheck exact = check_exactly(mesh.positions, mesh.triangles);
  judged.crossings.crossing_pairs += exact.crossing_pairs;
  judged.crossings.zero_area_triangles += exact.zero_area_triangles;
}

}  // namespace

std::string spread_text(const std::vector<double>& values, int digits) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  if (values.size() == 1) return fmt::format("{:.{}f}", mean, digits);
  return fmt::format("{:.{}f} ± {:.{}f}", mean, digits, 0.5 * (*most - *least), digits);
}

std::vector<ContactRow> contact_rows(const Dims& dims, std::uint64_t seed) {
  using phantom::Contact;
  std::vector<ContactRow> all;
  const auto add = [&](std::string name, const auto& change) {
    phantom::PhantomOptions o;
    o.dims = dims;
    o.seed = seed + 17 * all.size();
    change(o);
    all.push_back({std::move(name), o});
  };
  constexpr double kShare = 0.2;
  add("text", [](auto& o) { o.wedge_depth_vox = 7.0; });
  add("pressed", [](auto& o) { o.contact_share = kShare; });
  add("pockets", [](auto& o) {
    o.contact = Contact::kPockets;
    o.contact_share = kShare;
  });
  for (const double film : {1.0, 0.5, 0.35, 0.2})
    add(fmt::format("film {}", film), [&](auto& o) {
      o.contact = Contact::kFilm;
      o.film_vox = film;
      o.contact_share = kShare;
    });
  add("filled", [](auto& o) {
    o.contact = Contact::kFilled;
    o.contact_share = kShare;
  });
  add("unwritten", [](auto& o) {
    o.writing.written = false;
    o.contact_share = kShare;
  });
  add("unwritten film", [](auto& o) {
    o.writing.written = false;
    o.contact = Contact::kFilm;
    o.contact_share = kShare;
  });
  add("hard", [](auto& o) {
    o.contact = Contact::kPockets;
    o.contact_share = 0.25;
    o.snr_db = 14.0;
    o.rings = 0.03;
    o.gap_vox = 3.0;
  });
  add("sharp", [](auto& o) {
    o.contact = Contact::kFilm;
    o.contact_share = kShare;
    o.blur_vox = 0.4;
  });
  add("soft", [](auto& o) {
    o.contact = Contact::kFilm;
    o.contact_share = kShare;
    o.blur_vox = 0.75;
  });
  add("two clays", [](auto& o) {
    o.contact = Contact::kFilled;
    o.contact_share = kShare;
    o.envelope_density = 1.3;
  });
  add("clear film", [](auto& o) {
    o.contact = Contact::kFilm;
    o.contact_share = kShare;
    o.snr_db = 30.0;
  });
  const auto add_scanned = [&](std::string name, Contact contact, double film) {
    add(std::move(name), [&](auto& o) {
      o.contact = contact;
      o.film_vox = film;
      o.contact_share = kShare;
      o.scanner = phantom::parse_scanner("medium,turn=half,cone=0").value();
    });
  };
  add_scanned("X-ray pressed", Contact::kPressed, 0.5);
  add_scanned("X-ray filled", Contact::kFilled, 0.5);
  for (const double film : {0.5, 0.2}) add_scanned(fmt::format("X-ray film {}", film), Contact::kFilm, film);
  constexpr double kWideShare = 0.45;
  for (const double film : {0.5, 0.2})
    add(fmt::format("wide film {}", film), [&](auto& o) {
      o.contact = Contact::kFilm;
      o.film_vox = film;
      o.contact_share = kWideShare;
    });
  add("wide pressed", [](auto& o) { o.contact_share = kWideShare; });
  return all;
}

JudgedRow judge_row(const ContactRow& row, const JudgeOptions& how) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("dubsar_wedges_{}.h5", ::getpid());
  struct Remove {
    std::filesystem::path path;
    ~Remove() {
      std::error_code ignored;
      std::filesystem::remove(path, ignored);
    }
  } remove{path};
  SilentProgress progress;
  value_or_exit(phantom::write_phantom(path, std::nullopt, row.options, progress));
  PipelineOptions options;
  options.import.path = path;
  options.detail = how.detail;
  if (!how.contact) options.contact.reset();
  if (!how.light) options.occlusion.reset();
  const PipelineResult result = value_or_exit(run_pipeline(options, progress));
  JudgedRow judged;
  for (const StageRecord& stage : result.report.stages) {
    judged.wall_s += stage.wall_s;
    judged.cpu_s += stage.cpu_s;
    judged.peak_mib = std::max(judged.peak_mib, stage.peak_rss_mib);
    if (stage.name == "contact") judged.contact_cpu_s = stage.cpu_s;
  }
  judged.stages = result.report.stages;
  judged.blur = result.report.scan.blur;
  judged.sharpen = result.report.surface_by.sharpen;
  judged.sharpen_wide = result.report.surface_by.sharpen_wide;
  judged.traced = result.report.contact && result.report.contact->traced;
  if (result.report.contact) judged.remark = result.report.contact->why;
  if (!how.judge) return judged;
  const auto truth = value_or_exit(phantom::Phantom::create(row.options));
  judged.step = result.report.detail.resample() ? 2.0 : 1.0;
  judged.seen = judge_seen(*truth, result.model, judged.step);
  auto tablet = make_tri_mesh(result.model, {.body = "tablet"});
  auto envelope = make_tri_mesh(result.model, {.body = "envelope"});
  if (!tablet || !envelope) {
    judged.remark = "no tablet was found";
    return judged;
  }
  if (tablet->evidence.empty()) tablet->evidence.assign(tablet->positions.size(), 0);
  count_crossings(*tablet, judged);
  count_crossings(*envelope, judged);
  const auto positions = in_voxels(*tablet);
  judged.contact = phantom::judge_contact(*truth, {positions, tablet->triangles, {}, judged.step}, tablet->evidence);
  judge_tablet(*truth, *tablet, positions, judged);
  judged.tablet.settled = settle_tablet(*truth, *tablet, positions);
  if (how.cover) judged.tablet.cover = cover_tablet(*truth, *tablet, positions, in_voxels(*envelope));
  if (how.places)
    for (const phantom::FalseWedge& wedge : judged.contact.invented)
      fmt::print(
          stderr,
          "{}: seed {}, invented at {:.0f} {:.0f} {:.0f}, {} vertices, {} of pockets, {:.1f} deep, {} of pores\n",
          row.name, row.options.seed, wedge.place.x, wedge.place.y, wedge.place.z, wedge.vertices, wedge.of_pockets,
          wedge.deepest, wedge.of_pores);
  return judged;
}

}  // namespace dubsar
