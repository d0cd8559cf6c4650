#include "tests/bench/scanner_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

struct NamedScanner {
  const char *name, *scanner;
  double wedge_vox = 7.0;  ///< depth of a usual wedge
};

constexpr const char* kHalf = "turn=half,cone=0";
constexpr NamedScanner kOfHalfATurn[] = {
    {"clean", "ideal"},
    {"hardening", "ideal,mono=0,kv=120,filter=0.5"},
    {"scatter 3 %", "ideal,scatter=0.03"},
    {"scatter 6 %", "ideal,scatter=0.06"},
    {"scatter 12 %", "ideal,scatter=0.12"},
    {"scatter 25 %", "ideal,scatter=0.25"},
    {"glare 3 %", "ideal,glare=0.03"},
    {"axis .25", "ideal,axis=0.25"},
    {"axis 1", "ideal,axis=1"},
    {"gains .4 %", "ideal,rings=0.004"},
    {"gains 1.2 %", "ideal,rings=0.012,bad=0.0005"},
    {"few photons", "ideal,photons=20000,electronic=20"},
    {"few views", "ideal"},
    {"blur .8", "ideal,blur=0.8"},
    {"good", "good"},
    {"mild", "mild"},
    {"medium", "medium"},
    {"strong", "strong"},
    {"medium small wedges", "medium", 4.0},
    {"strong small wedges", "strong", 4.0},
    {"dense clay", "strong,scatter=0.3,clay=2.4"},
    {"strong but 180 kV", "strong,kv=180,filter=2"},
    {"strong but scatter 3 %", "strong,scatter=0.03,glare=0"},
};
constexpr NamedScanner kOfAFullTurn[] = {{"cone", "ideal"},
                                         {"cone 10 degrees", "ideal,cone=10"},
                                         {"cone axis 1", "ideal,axis=1"},
                                         {"cone good", "good"},
                                         {"cone mild", "mild"},
                                         {"cone medium", "medium"},
                                         {"cone strong", "strong"},
                                         {"cone 10 degrees medium", "medium,cone=10"},
                                         {"cone 10 degrees strong", "strong,cone=10"},
                                         {"cone strong small wedges", "strong", 4.0}};

}  // namespace

std::vector<ContactRow> scanner_rows(const Dims& dims, std::uint64_t seed) {
  std::vector<ContactRow> rows;
  const auto add = [&](const char* name, const std::string& scanner, double wedge_vox) {
    phantom::PhantomOptions o;
    o.dims = dims;
    o.seed = seed;
    o.wedge_depth_vox = wedge_vox;
    o.scanner = phantom::parse_scanner(scanner).value();
    rows.push_back({name, o});
  };
  for (const NamedScanner& row : kOfHalfATurn) add(row.name, fmt::format("{},{}", row.scanner, kHalf), row.wedge_vox);
  for (ContactRow& row : rows)
    if (row.name == "few views") row.options.scanner->turn.views_per_voxel = 0.7;
  for (const NamedScanner& row : kOfAFullTurn) add(row.name, row.scanner, row.wedge_vox);
  return rows;
}

void print_scanner_rows(const Dims& dims, std::uint64_t seed, int seeds, const std::string& only) {
  fmt::print(
      "| scan | wedges within 20 % | mean depth of true | tablet's error after the best shift, RMS | that shift | "
      "recall of the "
      "tablet | vertices of pores that noise made, % | of how many wedges |\n|---|---|---|---|---|---|---|---|\n");
  const std::size_t count = scanner_rows(dims, seed).size();
  for (std::size_t row = 0; row < count; ++row) {
    std::vector<double> kept, ratio, rms, shift, recall, pores;
    int wedges = 0;
    std::string name, remarks;
    for (int i = 0; i < seeds; ++i) {
      const ContactRow one = scanner_rows(dims, seed + 1000 * static_cast<std::uint64_t>(i))[row];
      name = one.name;
      if (!only.empty() && ("," + only + ",").find("," + name + ",") == std::string::npos) break;
      const JudgedRow judged = judge_row(one, {});
      wedges += judged.seen.wedges.wedges;
      if (judged.tablet.settled.rms <= 0.0) {
        remarks += fmt::format(", seed {}: {}", one.options.seed, judged.remark);
        continue;
      }
      kept.push_back(judged.seen.wedges.kept_fraction());
      ratio.push_back(judged.seen.wedges.mean_ratio);
      rms.push_back(judged.tablet.settled.rms);
      shift.push_back(glm::length(judged.tablet.settled.shift));
      recall.push_back(judged.seen.owner[0].recall());
      pores.push_back(100.0 * judged.tablet.settled.noise_pores);
    }
    if (kept.empty() && remarks.empty()) continue;
    if (kept.empty())
      fmt::print("| {} | 0 | | | | | | {}{} |\n", name, wedges, remarks);
    else
      fmt::print("| {} | {} | {} | {} | {} | {} | {} | {}{} |\n", name, spread_text(kept, 3), spread_text(ratio, 2),
                 spread_text(rms, 3), spread_text(shift, 2), spread_text(recall, 3), spread_text(pores, 2), wedges,
                 remarks);
    std::fflush(stdout);
  }
}

}  // namespace dubsar
