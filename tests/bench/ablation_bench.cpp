// What each rule of the contact is worth: ./do bench ablation. Scans are processed with all rules, and with all but
// one, for every rule.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/contact/rules.h"
#include "core/mesh/evidence.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"
#include "tests/bench/contact_rows.h"
#include "tests/core/phantom/contact_score.h"

namespace dubsar {
namespace {

constexpr std::string_view kHelp =
    "ablation_bench [--size XxYxZ] [--seed N] [--seeds COUNT] [--placements COUNT] [--only ROW,ROW] [--rules "
    "RULE,RULE]\n"
    "  --size        of phantoms, 160x100x150 without\n"
    "  --seeds       phantoms of each row\n"
    "  --placements  of each on the grid, by cropping 0, 3, 6, ... voxels of its margins\n"
    "  --only        rows of wedges_bench\n"
    "  --rules       that are left out, each by itself; all of core/contact/rules.h without\n";

struct Arguments {
  Dims dims{160, 100, 150};
  std::uint64_t seed = 70301;
  int seeds = 3, placements = 1;
  std::string only = "pressed,pockets,film 0.5,film 0.35,film 0.2,filled,unwritten", rules;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    long x = 0, y = 0, z = 0;
    const char* const value = i + 1 < argc ? argv[++i] : "";
    if (word == "--seed") {
      a.seed = std::strtoull(value, nullptr, 10);
    } else if (word == "--seeds") {
      a.seeds = std::max(1, std::atoi(value));
    } else if (word == "--placements") {
      a.placements = std::max(1, std::atoi(value));
    } else if (word == "--only") {
      a.only = value;
    } else if (word == "--rules") {
      a.rules = value;
    } else if (word == "--size" && std::sscanf(value, "%ldx%ldx%ld", &x, &y, &z) == 3) {
      a.dims = {x, y, z};
    } else {
      fmt::print(stderr, "{}", kHelp);
      std::exit(64);
    }
  }
  return a;
}

bool listed(std::string_view list, std::string_view name) {
  return list.empty() || fmt::format(",{},", list).find(fmt::format(",{},", name)) != std::string::npos;
}

template <class T>
T value_or_exit(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "ablation_bench: {}\n", result.error().message);
  std::exit(1);
}

/// What a rule may change. Shares of the contact's vertices, and of wedges.
struct Figures {
  double free = NAN, pockets = NAN,
         wedges = NAN;  ///< wedges within 20 % of their depth: in air, in pockets, under films
  double film = 0.0, near = 0.0,
         stray_film = 0.0;  ///< called film; within a voxel of the truth; film farther than that
  double false_dents = 0.0;
};
struct FigureName {
  const char* name;
  double Figures::*figure;
};
constexpr FigureName kFigures[] = {
    {"free", &Figures::free},         {"pockets", &Figures::pockets}, {"wedges", &Figures::wedges},
    {"film", &Figures::film},         {"near", &Figures::near},       {"far film", &Figures::stray_film},
    {"dents", &Figures::false_dents},
};

Figures figures_of(const phantom::Phantom& truth, const SurfaceModel& model) {
  const TriMesh tablet = value_or_exit(make_tri_mesh(model, {.body = "tablet"}));
  std::vector<std::uint8_t> evidence = tablet.evidence;
  evidence.resize(tablet.positions.size(), evidence_byte(Evidence::kMeasured));
  std::vector<glm::vec3> positions;
  for (const glm::vec3& p : tablet.positions) positions.push_back(glm::vec3(tablet.frame.input_vox_from_grid(p)));
  const phantom::ContactScore score = judge_contact(truth, {positions, tablet.triangles, {}, 1.0}, evidence);
  const auto kept = [&](phantom::WedgeCase which) {
    const phantom::CaseScore& one = score.cases[static_cast<std::size_t>(which)];
    return one.wedges > 0 ? one.kept_fraction() : NAN;
  };
  std::int64_t film = 0, far = 0;
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    if (evidence[i] != evidence_byte(Evidence::kFilm)) continue;
    ++film;
    far += std::abs(truth.tablet_distance(glm::dvec3(positions[i]))) > 1.0;
  }
  const auto contact = std::max<double>(1.0, static_cast<double>(score.contact_vertices));
  return {kept(phantom::WedgeCase{0}),
          kept(phantom::WedgeCase{1}),
          kept(phantom::WedgeCase{2}),
          static_cast<double>(score.evidence[evidence_byte(Evidence::kFilm)]) / contact,
          score.near_fraction(),
          film > 0 ? static_cast<double>(far) / static_cast<double>(film) : 0.0,
          static_cast<double>(score.false_wedges())};
}

/// A scan, and its truth.
class PreparedScan {
 public:
  PreparedScan(const phantom::PhantomOptions& wanted, int cropped)
      : path_(std::filesystem::temp_directory_path() / fmt::format("dubsar_ablation_{}.h5", ::getpid())),
        truth_(value_or_exit(phantom::Phantom::create(wanted))) {
    SilentProgress progress;
    value_or_exit(phantom::write_phantom(path_, std::nullopt, wanted, progress));
    options_.import.path = path_;
    if (cropped > 0) options_.import.crop = CropRange{{cropped, cropped, cropped}, {-1, -1, -1}};
    options_.detail = Detail::kScan;
    options_.occlusion.reset();
  }
  ~PreparedScan() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  PreparedScan(const PreparedScan&) = delete;
  PreparedScan& operator=(const PreparedScan&) = delete;

  Figures traced(ContactRules rules) {
    options_.contact = rules;
    SilentProgress progress;
    return figures_of(*truth_, value_or_exit(run_pipeline(options_, progress)).model);
  }

 private:
  std::filesystem::path path_;
  std::unique_ptr<const phantom::Phantom> truth_;
  PipelineOptions options_;
};

using Table = std::map<std::string, std::vector<Figures>>;  ///< of each rule that was left out, one for each scan

std::vector<double> known(const std::vector<Figures>& all, double Figures::*figure) {
  std::vector<double> values;
  for (const Figures& one : all)
    if (!std::isnan(one.*figure)) values.push_back(one.*figure);
  return values;
}

/// Mean and half of the range with all rules, then what each rule changes: mean and half of the range of differences.
void print_table(const std::string& row, const Table& table) {
  const std::vector<Figures>& all = table.at("");
  fmt::print("\n{:<20}", row);
  for (const FigureName& f : kFigures) fmt::print("{:>17}", f.name);
  fmt::print("\n");
  for (const auto& [rule, figures] : table) {
    fmt::print("{:<20}", rule.empty() ? "all rules" : "- " + rule);
    for (const FigureName& f : kFigures) {
      std::vector<Figures> changed = figures;
      if (!rule.empty())
        for (std::size_t i = 0; i < changed.size(); ++i) changed[i].*f.figure -= all[i].*f.figure;
      const std::vector<double> values = known(changed, f.figure);
      fmt::print("{:>18}", values.empty() ? "-" : spread_text(values, 3));
    }
    fmt::print("\n");
  }
  std::fflush(stdout);
}

void run(const Arguments& a) {
  std::map<std::string, Table> tables;
  for (int s = 0; s < a.seeds; ++s)
    for (const ContactRow& row : contact_rows(a.dims, a.seed + 1000 * static_cast<std::uint64_t>(s))) {
      if (!listed(a.only, row.name)) continue;
      for (int p = 0; p < a.placements; ++p) {
        PreparedScan scan(row.options, 3 * p);
        Table& table = tables[row.name];
        table[""].push_back(scan.traced({}));
        for (const auto& rule : kContactRules)
          if (listed(a.rules, rule.name))
            table[std::string(rule.name)].push_back(scan.traced(ContactRules{}.without(rule.value)));
      }
      if (s + 1 == a.seeds) print_table(row.name, tables[row.name]);
    }
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) { dubsar::run(dubsar::parse(argc, argv)); }
