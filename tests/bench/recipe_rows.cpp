#include "tests/bench/recipe_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace dubsar {
namespace {

/// A column of the table.
struct Figure {
  const char* head;
  int digits;
  double (*of)(const JudgedRow&);
};
constexpr Figure kFigures[] = {
    {"wedges within 20 %", 3, [](const JudgedRow& r) { return r.seen.wedges.kept_fraction(); }},
    {"mean depth of true", 2, [](const JudgedRow& r) { return r.seen.wedges.mean_ratio; }},
    {"tablet's error after the best shift, RMS", 3, [](const JudgedRow& r) { return r.tablet.settled.rms; }},
    {"recall of the tablet", 3, [](const JudgedRow& r) { return r.seen.owner[0].recall(); }},
    {"its surface seen", 4, [](const JudgedRow& r) { return r.tablet.cover.measured; }},
    {"called contact", 4, [](const JudgedRow& r) { return r.tablet.cover.patch; }},
    {"called envelope", 4, [](const JudgedRow& r) { return r.tablet.cover.envelope; }},
    {"1 to 3 voxels off", 4, [](const JudgedRow& r) { return r.tablet.cover.off; }},
    {"not there", 4, [](const JudgedRow& r) { return r.tablet.cover.nothing; }},
    {"vertices of pores that noise made, %", 3,
     [](const JudgedRow& r) { return 100.0 * r.tablet.settled.noise_pores; }},
    {"sharpened by", 2, [](const JudgedRow& r) { return static_cast<double>(r.sharpen); }},
    {"and widely by", 2, [](const JudgedRow& r) { return static_cast<double>(r.sharpen_wide); }},
};

}  // namespace

std::vector<ContactRow> recipe_rows(const Dims& dims, std::uint64_t seed) {
  std::vector<ContactRow> rows;
  const auto add = [&](std::string name, const auto& change) {
    phantom::PhantomOptions o;
    o.dims = dims;
    o.seed = seed;
    o.wedge_depth_vox = 5.0;
    o.rings = 0.01;
    o.artefacts.cupping = 0.05;
    change(o);
    rows.push_back({std::move(name), o});
  };
  add("recipe", [](auto&) {});
  add("cupping .15", [](auto& o) { o.artefacts.cupping = 0.15; });
  add("streaks .06", [](auto& o) { o.artefacts.streaks = 0.06; });
  add("rings .05", [](auto& o) { o.rings = 0.05; });
  add("blur .9", [](auto& o) { o.blur_vox = 0.9; });
  add("14 dB", [](auto& o) { o.snr_db = 14.0; });
  add("holder .3", [](auto& o) { o.artefacts.holder = 0.3; });
  add("holder .7", [](auto& o) { o.artefacts.holder = 0.7; });
  const auto hard = [](auto& o) {
    o.artefacts.cupping = 0.15;
    o.artefacts.streaks = 0.02;
    o.rings = 0.05;
    o.blur_vox = 0.9;
    o.snr_db = 14.0;
    o.artefacts.holder = 0.3;
    o.contact_share = 0.25;
  };
  add("hard", hard);
  add("hard, streaks .06", [&](auto& o) {
    hard(o);
    o.artefacts.streaks = 0.06;
  });
  return rows;
}

void print_recipe_rows(const Dims& dims, std::uint64_t seed, int seeds, const std::string& only) {
  fmt::print("| scan |");
  for (const Figure& figure : kFigures) fmt::print(" {} |", figure.head);
  fmt::print(" of how many wedges |\n|---|");
  for (std::size_t i = 0; i <= std::size(kFigures); ++i) fmt::print("---|");
  fmt::print("\n");
  const std::size_t count = recipe_rows(dims, seed).size();
  for (std::size_t row = 0; row < count; ++row) {
    std::vector<std::vector<double>> found(std::size(kFigures));
    int wedges = 0;
    std::string name, remarks;
    for (int i = 0; i < seeds; ++i) {
      const ContactRow one = recipe_rows(dims, seed + 1000 * static_cast<std::uint64_t>(i))[row];
      name = one.name;
      if (!only.empty() && ("," + only + ",").find("," + name + ",") == std::string::npos) break;
      const JudgedRow judged = judge_row(one, {.light = true, .cover = true});
      wedges += judged.seen.wedges.wedges;
      if (judged.tablet.settled.rms <= 0.0) {
        remarks += fmt::format(", seed {}: {}", one.options.seed, judged.remark);
        continue;
      }
      for (std::size_t f = 0; f < found.size(); ++f) found[f].push_back(kFigures[f].of(judged));
    }
    if (found[0].empty() && remarks.empty()) continue;
    fmt::print("| {} |", name);
    for (std::size_t f = 0; f < found.size(); ++f)
      fmt::print(" {} |", found[f].empty() ? "" : spread_text(found[f], kFigures[f].digits));
    fmt::print(" {}{} |\n", wedges, remarks);
    std::fflush(stdout);
  }
}

}  // namespace dubsar
