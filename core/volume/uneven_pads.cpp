#include "core/volume/uneven_pads.h"

#include <algorithm>

namespace dubsar {
namespace {

constexpr std::size_t kMostOfRun = 32, kMostRuns = 6, kMostUnions = 16;

}  // namespace

std::vector<std::vector<float>> pad_runs(const BorderValues& values) {
  std::vector<std::vector<float>> runs;
  std::set<float> left = values.frequent;
  while (!left.empty()) {
    std::vector<float> run{*left.begin()};
    if (values.whole.contains(run.front())) {
      while (run.size() <= kMostOfRun && values.whole.contains(run.front() - 1.0f))
        run.insert(run.begin(), run.front() - 1.0f);
      while (run.size() <= kMostOfRun && values.whole.contains(run.back() + 1.0f)) run.push_back(run.back() + 1.0f);
    }
    for (const float value : run) left.erase(value);
    if (run.size() <= kMostOfRun) runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<std::vector<float>> pad_unions(const std::vector<std::vector<float>>& runs, const std::set<float>& found) {
  std::vector<std::vector<float>> out;
  if (runs.size() < 2 || runs.size() > kMostRuns) return out;
  const auto known = [&](const std::vector<float>& run) {
    return std::all_of(run.begin(), run.end(), [&](float v) { return found.contains(v); });
  };
  const auto add = [&](std::set<float> all) {
    if (out.size() < kMostUnions) out.emplace_back(all.begin(), all.end());
  };
  for (std::size_t a = 0; a < runs.size(); ++a) {
    std::set<float> one(found.begin(), found.end());
    one.insert(runs[a].begin(), runs[a].end());
    if (!found.empty() && !known(runs[a])) add(one);
    for (std::size_t b = a + 1; found.empty() && b < runs.size(); ++b) {
      std::set<float> two(one);
      two.insert(runs[b].begin(), runs[b].end());
      add(two);
    }
  }
  return out;
}

}  // namespace dubsar
