// What is read of a hidden tablet, beside what is wanted, on phantoms that nothing was tuned on: ./do bench wedges

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/system/log.h"
#include "tests/bench/contact_rows.h"
#include "tests/bench/real_volumes.h"
#include "tests/bench/recipe_rows.h"
#include "tests/bench/scanner_rows.h"

namespace dubsar {
namespace {

struct Arguments {
  Dims dims{512, 320, 480};
  std::uint64_t seed = 0;
  int seeds = 1;
  Detail detail = Detail::kAuto;
  bool contact = true;
  std::string only;     ///< names of rows, with commas
  std::string volumes;  ///< a folder of scans that are not of tablets
  bool large = false, costs = false, places = false, scanner = false, recipe = false;
};

constexpr std::string_view kHelp =
    "wedges_bench [--quick | --size XxYxZ] [--seed N] [--seeds COUNT] [--only ROW,ROW] [--detail auto|scan|half]\n"
    "             [--no-contact] [--places] [--costs] [--large] [--scanner | --recipe] | --volumes "
    "FOLDER\n"
    "  --quick   256x160x240, minutes; else 512x320x480\n"
    "  --seed    phantoms of this seed, --seeds: so many of each kind; none: a fresh one, which is printed\n"
    "  --only    rows: text, pressed, pockets, film 1, film 0.5, film 0.35, film 0.2, filled, unwritten,\n"
    "            unwritten film, hard, sharp, soft, two clays, clear film, X-ray pressed, X-ray filled, X-ray film "
    "0.5,\n"
    "            X-ray film 0.2, wide film 0.5, wide film 0.2, wide pressed\n"
    "  --places  says where wedges were invented\n"
    "  --costs   time and memory of --detail half and scan instead\n"
    "  --large   time and memory at 935x499x861 and at the paper's size, 1871x999x1723 instead (most of an hour, 15 GB "
    "disk)\n"
    "  --scanner  scans of a simulated scanner instead, a table of docs/scans.md; rows: clean, hardening, scatter 12 "
    "%,\n"
    "            axis 1, gains 1.2 %, few photons, few views, good, mild, medium, strong, cone strong and others\n"
    "  --recipe  one artefact at a time instead, another table of docs/scans.md; rows: recipe, cupping .15, streaks "
    ".06,\n"
    "            rings .05, blur .9, 14 dB, holder .3, holder .7, hard\n"
    "  --volumes FOLDER  processes the HDF5 files in it; exit code 1 where one fails or has a tablet\n";

[[noreturn]] void usage(int code) {
  fmt::print(code == 0 ? stdout : stderr, "{}", kHelp);
  std::exit(code);
}

Arguments parse(int argc, char** argv) {
  constexpr int kUsage = 64;
  Arguments a;
  const auto fresh = std::chrono::system_clock::now().time_since_epoch().count();
  a.seed = static_cast<std::uint64_t>(fresh / 1'000'000'000) % 1'000'000;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--help" || word == "-h") usage(0);
    if (word == "--quick") {
      a.dims = {256, 160, 240};
    } else if (word == "--large") {
      a.large = true;
    } else if (word == "--costs") {
      a.costs = true;
    } else if (word == "--scanner") {
      a.scanner = true;
    } else if (word == "--recipe") {
      a.recipe = true;
    } else if (word == "--no-contact") {
      a.contact = false;
    } else if (word == "--places") {
      a.places = true;
    } else if (i + 1 == argc) {
      usage(kUsage);
    } else if (const char* value = argv[++i]; word == "--seed") {
      a.seed = std::strtoull(value, nullptr, 10);
    } else if (word == "--seeds") {
      a.seeds = std::max(1, std::atoi(value));
    } else if (word == "--volumes") {
      a.volumes = value;
    } else if (word == "--only") {
      a.only = value;
    } else if (word == "--detail") {
      const auto* const detail =
          std::find_if(std::begin(kDetails), std::end(kDetails), [&](const auto& name) { return name.name == value; });
      if (detail == std::end(kDetails)) usage(kUsage);
      a.detail = detail->value;
    } else if (word == "--size") {
      long x = 0, y = 0, z = 0;
      if (std::sscanf(value, "%ldx%ldx%ld", &x, &y, &z) != 3) usage(kUsage);
      a.dims = {x, y, z};
    } else {
      usage(kUsage);
    }
  }
  return a;
}

/// Figures of all seeds of a kind of phantom, as one.
struct Kind {
  std::vector<JudgedRow> rows;
  double share(phantom::WedgeCase which, int phantom::CaseScore::*count) const {
    int wedges = 0, counted = 0;
    for (const JudgedRow& row : rows) {
      const phantom::CaseScore& one = row.contact.cases[static_cast<std::size_t>(which)];
      wedges += one.wedges;
      counted += one.*count;
    }
    return wedges ? static_cast<double>(counted) / wedges : NAN;
  }
  template <class Figure>
  double largest(const Figure& figure) const {
    double most = -INFINITY;
    for (const JudgedRow& row : rows) most = std::max(most, static_cast<double>(figure(row)));
    return most;
  }
  template <class Figure>
  double mean(const Figure& figure) const {
    double sum = 0.0;
    for (const JudgedRow& row : rows) sum += static_cast<double>(figure(row));
    return sum / static_cast<double>(rows.size());
  }
};
using Kinds = std::map<std::string, Kind>;

void print_row_heads() {
  fmt::print("{:<15}{:>7}{:>7}{:>6}{:>6}{:>6}{:>7}{:>7}{:>7}{:>6}{:>8}{:>8}{:>6}{:>7}{:>6}{:>6}{:>7}{:>7}{:>7}\n",
             "phantom", "seed", "free", "rms", "pock.", "shown", "film w", "near", "% film", "% inf", "purity",
             "recall", "false", "touch", "flat", "blur", "cpu s", "contact", "MiB");
}

void print_row(const ContactRow& row, const JudgedRow& j) {
  const phantom::ContactScore& c = j.contact;
  const auto percent = [&](std::size_t e) {
    return 100.0 * static_cast<double>(c.evidence[e]) / std::max<double>(1.0, static_cast<double>(c.contact_vertices));
  };
  fmt::print(
      "{:<15}{:>7}{:>7.3f}{:>6.3f}{:>6.3f}{:>6.3f}{:>7.3f}{:>7.3f}{:>7.1f}{:>6.1f}{:>8.4f}{:>8.4f}{:>6}{:>7}{:>6}{:>6."
      "2f}"
      "{:>7.1f}{:>7.1f}{:>7.0f}  {}\n",
      row.name, row.options.seed, c.cases[0].kept_fraction(), j.tablet.rms, c.cases[1].kept_fraction(),
      c.cases[1].shown_fraction(), c.cases[2].kept_fraction(), c.near_fraction(), percent(2), percent(3),
      std::min(j.seen.owner[0].purity(), j.seen.owner[1].purity()),
      std::min(j.seen.owner[0].recall(), j.seen.owner[1].recall()), c.false_wedges(), j.crossings.crossing_pairs,
      j.crossings.zero_area_triangles, j.blur ? std::sqrt(j.blur->variance) : NAN, j.cpu_s, j.contact_cpu_s, j.peak_mib,
      j.remark);
  std::fflush(stdout);
}

class Wanted {
 public:
  Wanted() { fmt::print("\n{:<72}{:>9}{:>9}{:>9}  {}\n", "wanted", "least", "aim", "found", "holds"); }
  void at_least(std::string_view what, double least, double aim, double found) {
    line(what, least, aim, found, found >= least, found >= aim);
  }
  void at_most(std::string_view what, double most, double aim, double found) {
    line(what, most, aim, found, found <= most, found <= aim);
  }
  int failed() const noexcept { return failed_; }

 private:
  void line(std::string_view what, double least, double aim, double found, bool holds, bool reached) {
    if (std::isnan(found)) {
      fmt::print("{:<72}{:>9}{:>9}{:>9}  no such wedge\n", what, least, aim, "-");
      return;
    }
    fmt::print("{:<72}{:>9}{:>9}{:>9.4f}  {}\n", what, least, aim, found, reached ? "yes, aim" : holds ? "yes" : "NO");
    failed_ += !holds;
  }
  int failed_ = 0;
};

/// Returns how many lines do not hold. Rows that were not asked for have no lines.
int print_wanted(const Kinds& kinds) {
  using phantom::CaseScore;
  using phantom::WedgeCase;
  const auto with = [&](const std::string& name, const auto& use) {
    if (const auto kind = kinds.find(name); kind != kinds.end()) use(kind->second);
  };
  Wanted table;
  with("text", [&](const Kind& k) {
    table.at_least("wedges 7 voxels deep, depth within 20 %", 0.95, 0.98,
                   k.mean([](const JudgedRow& r) { return r.seen.wedges.kept_fraction(); }));
    table.at_most("surface error RMS, tablet and envelope, not inferred, voxels", 0.20, 0.12,
                  k.largest([](const JudgedRow& r) { return r.seen.resolved.rms * r.step; }));
  });
  with("pockets", [&](const Kind& k) {
    table.at_least("wedges in contact with open pockets, shown on the tablet", 0.90, 0.97,
                   k.share(WedgeCase::kPocket, &CaseScore::shown));
  });
  const auto near = [](const JudgedRow& r) { return r.contact.near_fraction(); };
  with("film 0.5", [&](const Kind& k) {
    table.at_least("film of 0.5 voxel: interface within 1 voxel over this share", 0.92, 0.98, k.mean(near));
  });
  for (const char* name : {"sharp", "soft"})
    with(name, [&](const Kind& k) {
      table.at_least(fmt::format("{} scan, film of 0.5 voxel: interface within 1 voxel", name), 0.92, 0.98,
                     k.mean(near));
    });
  with("two clays", [&](const Kind& k) {
    table.at_least("clays of densities 1 and 1.3: interface within 1 voxel", 0.80, 0.92, k.mean(near));
  });
  with("film 0.2", [&](const Kind& k) { table.at_least("film of 0.2 voxel, the same", 0.80, 0.92, k.mean(near)); });
  for (const char* film : {"0.5", "0.35", "0.2"})
    with(fmt::format("film {}", film), [&](const Kind& k) {
      table.at_least(fmt::format("wedges under a film of {} voxel, depth within 20 %", film), 0.75, 0.90,
                     k.share(WedgeCase::kFilm, &CaseScore::kept));
    });
  for (const char* name : {"filled", "unwritten", "unwritten film", "text", "pressed", "film 0.5", "film 0.35",
                           "film 0.2", "sharp", "soft", "two clays"})
    with(name, [&](const Kind& k) {
      table.at_most(fmt::format("{}: false wedges", name), 0, 0,
                    k.largest([](const JudgedRow& r) { return r.contact.false_wedges(); }));
    });
  for (const auto& [name, kind] : kinds) {
    if (name == "hard") continue;
    table.at_least(fmt::format("{}: purity and recall, the least of both of tablet and envelope", name), 0.99, 0.998,
                   -kind.largest([](const JudgedRow& r) {
                     double least = 1.0;
                     for (const phantom::PartScore& part : r.seen.owner)
                       least = std::min({least, part.purity(), part.recall()});
                     return -least;
                   }));
  }
  with("hard", [&](const Kind& k) {
    int wedges = 0, kept = 0;
    for (const JudgedRow& row : k.rows)
      for (const WedgeCase which : {WedgeCase::kFree, WedgeCase::kPocket}) {
        wedges += row.contact.cases[static_cast<std::size_t>(which)].wedges;
        kept += row.contact.cases[static_cast<std::size_t>(which)].kept;
      }
    table.at_least("hard scan: wedges within 20 %, of all that have air", 0.75, 0.90,
                   wedges ? static_cast<double>(kept) / wedges : NAN);
    table.at_most("hard scan: surface error RMS, tablet, not inferred, voxels", 0.35, 0.25,
                  k.largest([](const JudgedRow& r) { return r.tablet.rms; }));
    table.at_most("hard scan: surface beyond 3 voxels, not inferred, share", 0.005, 0.001,
                  k.largest([](const JudgedRow& r) { return r.tablet.stray; }));
    table.at_most("hard scan: false wedges", 0, 0,
                  k.largest([](const JudgedRow& r) { return r.contact.false_wedges(); }));
  });
  double crossings = 0.0;
  for (const auto& [name, kind] : kinds)
    crossings = std::max(crossings, kind.largest([](const JudgedRow& r) { return r.crossings.crossing_pairs; }));
  table.at_most("pairs of triangles of tablet or envelope that touch, all phantoms", 0, 0, crossings);
  return table.failed();
}

/// A row of docs/evidence.md: seconds of processors and memory, then of which stages.
void print_costs(const Dims& dims, Detail detail) {
  const std::vector<ContactRow> rows = contact_rows(dims, 1);
  const JudgedRow j = judge_row(rows[0], {.detail = detail, .light = true, .judge = false});
  std::string stages;
  for (const StageRecord& stage : j.stages)
    if (stage.cpu_s >= 0.01 * j.cpu_s)
      stages += fmt::format("{}{} {:.1f}", stages.empty() ? "" : ", ", stage.name, stage.cpu_s);
  fmt::print("| {}x{}x{} | {} | {:.0f} s | {:.0f} s | {:.0f} MiB | {} |\n", dims.x, dims.y, dims.z,
             name_in(kDetails, detail), j.wall_s, j.cpu_s, j.peak_mib, stages);
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  if (!a.volumes.empty()) return print_real_volumes(a.volumes) > 0 ? 1 : 0;
  if (a.scanner || a.recipe) {
    fmt::print("{}x{}x{}, seed {}, no options\n", a.dims.x, a.dims.y, a.dims.z, a.seed);
    (a.scanner ? print_scanner_rows : print_recipe_rows)(a.dims, a.seed, a.seeds, a.only);
    return 0;
  }
  if (a.costs || a.large) {
    fmt::print("| voxels | detail | by the clock | processors | most memory | seconds of processors by stage |\n");
    fmt::print("|---|---|---|---|---|---|\n");
    for (const Dims& dims : a.large ? std::vector<Dims>{{935, 499, 861}, {1871, 999, 1723}} : std::vector<Dims>{a.dims})
      for (const Detail detail : {Detail::kHalf, a.large ? Detail::kAuto : Detail::kScan}) print_costs(dims, detail);
    return 0;
  }
  fmt::print("{}x{}x{}, seed {}, no options{}\n", a.dims.x, a.dims.y, a.dims.z, a.seed,
             a.detail == Detail::kAuto ? "" : fmt::format(" but --detail {}", name_in(kDetails, a.detail)));
  print_row_heads();
  Kinds kinds;
  for (int i = 0; i < a.seeds; ++i)
    for (const ContactRow& row : contact_rows(a.dims, a.seed + 1000 * static_cast<std::uint64_t>(i))) {
      if (!a.only.empty() && ("," + a.only + ",").find("," + row.name + ",") == std::string::npos) continue;
      const bool light = row.name == "text";
      kinds[row.name].rows.push_back(
          judge_row(row, {.detail = a.detail, .contact = a.contact, .light = light, .places = a.places}));
      print_row(row, kinds[row.name].rows.back());
    }
  const int failed = print_wanted(kinds);
  if (const auto text = kinds.find("text"); text != kinds.end())
    fmt::print("time and memory of text, everything: {:.0f} s, {:.0f} s of processors, {:.0f} MiB\n",
               text->second.rows[0].wall_s, text->second.rows[0].cpu_s, text->second.rows[0].peak_mib);
  return failed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) {
  if (std::getenv("DUBSAR_VERBOSE") != nullptr)
    dubsar::set_log_handler([](dubsar::LogLevel, std::string_view m) { fmt::print(stderr, "{}\n", m); });
  return dubsar::run(argc, argv);
}
