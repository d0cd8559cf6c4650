// What is said of imprints once they explain the relief together: how deep the clay is, and what is left over.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel.h"
#include "core/mesh/quadratic_sheet.h"
#include "core/script/explain_relief.h"

namespace dubsar {

/// The deepest vertex near T, on the site's patch: what one can put a needle on. Samples of a patch would miss sharp
/// tips.
bool ReliefExplanation::deepest_vertex(const PlacedImprint& one, double& x, double& y, double& height) const {
  constexpr double kNear = 0.22, kSheet = 1.5;  // widths
  const WedgeSite& site = sites_[one.site];
  bool any = false;
  height = 1e30;
  const auto look = [&](const glm::vec3& p) {
    const glm::dvec3 off = (glm::dvec3(p) - site.origin) / scale_.width_mm;
    const double u = glm::dot(off, site.right), v = glm::dot(off, site.up), h = glm::dot(off, site.out);
    const double du = u - one.imprint.p[Imprint::kX], dv = v - one.imprint.p[Imprint::kY];
    if (du * du + dv * dv > kNear * kNear || std::abs(h) > kSheet || h >= height) return;
    any = true;
    x = du, y = dv, height = h;
  };
  fine_->visit(one.foot, 2.0 * kNear * scale_.width_mm + one.imprint.depth() * scale_.width_mm,
               [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const Triangle&) {
                 if (glm::dot(glm::dvec3(glm::cross(b - a, c - a)), site.out) < 0.0) return;  // of another sheet
                 look(a), look(b), look(c);
               });
  return any;
}

void ReliefExplanation::measure(PlacedImprint& one) const {
  constexpr double kGround = 1.9,
                   kTip = 0.22;  // widths around T: where the ground is looked for, and the deepest place
  constexpr std::size_t kFewestGround = 60;
  DepthSamples samples = sites_[one.site].samples;
  look_beside(one.site, samples);
  std::vector<float> model, around;
  imprint_depths(one.imprint, samples, model);
  Imprint wider = one.imprint;  // the clay that was pushed up beside it is no ground
  for (const std::size_t k : {Imprint::kWidth, Imprint::kDepth}) wider.p[k] += 0.2;
  imprint_depths(wider, samples, around);
  struct Ground {
    SheetTerms terms;
    double height, weight;
  };
  std::vector<Ground> ground;
  std::vector<double> off;
  double covered = 0.0, deepest = -1e30;
  SheetTerms tip{};
  const auto terms_at = [&](std::size_t i) {
    return sheet_terms(static_cast<double>(samples.x[i]) - one.imprint.p[Imprint::kX],
                       static_cast<double>(samples.y[i]) - one.imprint.p[Imprint::kY]);
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SheetTerms terms = terms_at(i);
    const double far2 = terms[3] + terms[5], depth = samples.depth[i];
    const double height = static_cast<double>(samples.level[i]) - depth;
    if (far2 < kTip * kTip && depth > deepest) {
      deepest = depth;
      tip = terms;
      one.depth = -height;  // until the ground is known
    }
    if (model[i] > 0.0f) {
      off.push_back(std::abs(depth - static_cast<double>(std::max(model[i], samples.others[i]))));
      covered += samples.others[i] >= model[i] ? 1.0 : 0.0;
    } else if (far2 < kGround * kGround && !(around[i] > 0.0f) && !(samples.others[i] > 0.0f)) {
      ground.push_back({terms, height, 1.0});
    }
  }
  // A hole in it, or the edge of another sheet, is not what the wedge looks like.
  one.misfit = off.empty() ? 1.0 : median(off) / one.imprint.depth();
  one.covered = off.empty() ? 1.0 : covered / static_cast<double>(off.size());
  if (deepest < -1e29) return;
  if (double x = 0.0, y = 0.0, height = 0.0; deepest_vertex(one, x, y, height) && -height > one.depth) {
    one.depth = -height;
    tip = sheet_terms(x, y);
  }
  SheetTerms sheet{};
  bool fitted = ground.size() >= kFewestGround;
  for (int round = 0; round < 5 && fitted; ++round) {
    SheetEquations equations;
    for (const Ground& g : ground)
      if (g.weight > 0.0) equations.add(g.terms, g.height, g.weight);
    equations.regularize();
    const auto solved = equations.solved();
    fitted = solved.has_value();
    if (!fitted) break;
    sheet = *solved;
    std::vector<double> uneven;
    for (const Ground& g : ground) uneven.push_back(std::abs(g.height - sheet_height(sheet, g.terms)));
    const double scale = 4.0 * std::max(median(uneven), 1e-3);
    for (std::size_t i = 0; i < ground.size(); ++i) {
      const double q = std::min(1.0, uneven[i] / scale);
      ground[i].weight = (1.0 - q * q) * (1.0 - q * q);
    }
  }
  one.depth = fitted ? one.depth + sheet_height(sheet, tip) : deepest;
}

std::vector<PlacedImprint> ReliefExplanation::placed() const {
  std::vector<PlacedImprint> out;
  for (std::size_t k = 0; k < sites_.size(); ++k)
    if (fits_[k].active) out.push_back(placed_at(k));
  return out;
}

std::vector<PlacedImprint> ReliefExplanation::measured() const {
  std::vector<PlacedImprint> out = placed();
  parallel_for(static_cast<std::int64_t>(out.size()), 4,
               [&](std::int64_t i) { measure(out[static_cast<std::size_t>(i)]); });
  draw_outlines(out);
  return out;
}

}  // namespace dubsar
