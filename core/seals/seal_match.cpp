#include "core/seals/seal_match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr double kSearchMm = 0.4;       // cells of the search: half a limb
constexpr double kAcrossMm = 4.0;       // a person names the middle of a band better than that
constexpr double kLeastMeetMm2 = 30.0;  // less is chance
constexpr double kMostMoveMm = 0.5;     // in one round
constexpr double kTurnDeg = 2.0;        // the rolling wavers, and people do not draw along it

/// Fewer cells, of what stands out.
SealImpression for_search(const SealImpression& in) {
  std::vector<float> share;
  const std::vector<float> soft =
      weighted_blur(in.raised, in.shown, in.width, in.height, 0.5 * kSearchMm / in.step_mm, &share);
  SealImpression out;
  out.step_mm = kSearchMm;
  out.width = static_cast<int>(in.width * in.step_mm / kSearchMm);
  out.height = static_cast<int>(in.height * in.step_mm / kSearchMm);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto from = [&](int k) { return static_cast<int>((k + 0.5) * kSearchMm / in.step_mm); };
      const std::size_t at = in.index(std::min(from(x), in.width - 1), std::min(from(y), in.height - 1));
      out.mm.push_back(soft[at]);
      out.shown.push_back(share[at] > 0.5f ? 1.0f : 0.0f);
    }
  return out;
}

PlacedOn turned_about_middle(const SealImpression& of, double degrees, bool upside) {
  const double a = degrees * std::numbers::pi / 180.0 + (upside ? std::numbers::pi : 0.0), c = std::cos(a),
               s = std::sin(a);
  PlacedOn out;
  out.turn = glm::dmat2(c, s, -s, c);
  const glm::dvec2 middle(0.5 * of.width * of.step_mm, 0.5 * of.height * of.step_mm);
  out.shift = middle - out.turn * middle;
  return out;
}

/// What a map does besides turning: its stretch, less one.
glm::dmat2 strain_of(const glm::dmat2& m) {
  const double angle = std::atan2(m[0][1] - m[1][0], m[0][0] + m[1][1]), c = std::cos(angle), s = std::sin(angle);
  const glm::dmat2 stretch = m * glm::dmat2(c, -s, s, c);  // as seen in the frame
  return {stretch[0][0] - 1.0, 0.5 * (stretch[0][1] + stretch[1][0]), 0.5 * (stretch[0][1] + stretch[1][0]),
          stretch[1][1] - 1.0};
}

/// Solves a small system; the last column is the right side. Nothing where it says nothing.
template <std::size_t N>
bool solved(std::array<std::array<double, N + 1>, N>& rows) {
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < N; ++r)
      if (std::abs(rows[r][k]) > std::abs(rows[pivot][k])) pivot = r;
    std::swap(rows[k], rows[pivot]);
    if (!(std::abs(rows[k][k]) > 1e-12)) return false;
    for (std::size_t r = 0; r < N; ++r) {
      if (r == k) continue;
      const double f = rows[r][k] / rows[k][k];
      for (std::size_t c = k; c <= N; ++c) rows[r][c] -= f * rows[k][c];
    }
  }
  for (std::size_t k = 0; k < N; ++k) rows[k][N] /= rows[k][k];
  return true;
}

}  // namespace

std::array<double, PlacedOn::kBends> PlacedOn::bend_terms(const glm::dvec2& from_middle) {
  constexpr double kCentimetre = 10.0;
  const double x = from_middle.x / kCentimetre, y = from_middle.y / kCentimetre;
  return {x * x, x * y, y * y, y * y * y};
}

glm::dvec2 PlacedOn::bent(const glm::dvec2& p) const {
  const std::array<double, kBends> terms = bend_terms(p - middle);
  glm::dvec2 out(0.0);
  for (std::size_t k = 0; k < kBends; ++k) out += terms[k] * bend[k];
  return out;
}

glm::dvec2 PlacedOn::back(const glm::dvec2& p) const {
  const glm::dvec2 flat = glm::inverse(turn) * (p - shift);
  glm::dvec2 out = flat;
  for (int round = 0; round < 4; ++round) out = flat - bent(out);  // bends are some tenths of a mm a cm
  return out;
}

PlacedOn after(const PlacedOn& a, const PlacedOn& b) {
  PlacedOn out = b;
  out.turn = a.turn * b.turn;
  out.shift = a.turn * b.shift + a.shift;
  return out;
}

double Likeness::At::weight() const { return likeness * std::sqrt(area_mm2 / kFigureMm2); }

const Likeness::At& Likeness::best() const {
  return *std::max_element(along.begin(), along.end(),
                           [](const At& a, const At& b) { return a.weight() < b.weight(); });
}

Likeness::At Likeness::near(double shift_mm) const {
  At out;
  for (int k = -2; k <= 2; ++k) {
    const auto at = static_cast<std::int64_t>(std::lround((shift_mm - least_mm) / step_mm)) + k;
    if (at < 0 || at >= static_cast<std::int64_t>(along.size())) continue;
    if (const At& here = along[static_cast<std::size_t>(at)]; out.area_mm2 == 0.0 || here.weight() > out.weight())
      out = here;
  }
  return out;
}

Likeness likeness_of(const SealImpression& first_fine, const SealImpression& second_fine) {
  const SealImpression first = for_search(first_fine), second = for_search(second_fine);
  Likeness out;
  out.step_mm = kSearchMm;
  out.least_mm = -kSearchMm * (second.width - 1);
  const int shifts = first.width + second.width - 1, across = static_cast<int>(kAcrossMm / kSearchMm);
  const int sideways = (first.height - second.height) / 2;
  out.along.resize(static_cast<std::size_t>(std::max(shifts, 1)));
  for (const bool upside : {false, true})
    for (const double degrees : {-kTurnDeg, 0.0, kTurnDeg}) {
      const PlacedOn turn = turned_about_middle(second, degrees, upside);
      SealImpression turned = second;
      for (int y = 0; y < second.height; ++y)
        for (int x = 0; x < second.width; ++x) {
          const Sampled s = sampled(second, turn.back(kSearchMm * glm::dvec2(x, y)));
          turned.mm[turned.index(x, y)] = static_cast<float>(s.mm);
          turned.shown[turned.index(x, y)] = s.weight > 0.5 ? 1.0f : 0.0f;
        }
      parallel_for(shifts, 4, [&](std::int64_t k) {
        const int dx = static_cast<int>(k) - (second.width - 1);
        Likeness::At& best = out.along[static_cast<std::size_t>(k)];
        for (int dy = sideways - across; dy <= sideways + across; ++dy) {
          float ab = 0.0f, aa = 0.0f, bb = 0.0f, sum_a = 0.0f, sum_b = 0.0f, cells = 0.0f;
          for (int y = std::max(0, dy); y < std::min(first.height, turned.height + dy); ++y)
            for (int x = std::max(0, dx); x < std::min(first.width, turned.width + dx); ++x) {
              const std::size_t i = first.index(x, y), j = turned.index(x - dx, y - dy);
              const float both = first.shown[i] * turned.shown[j], a = first.mm[i], b = turned.mm[j];
              ab += both * a * b;
              aa += both * a * a;
              bb += both * b * b;
              sum_a += both * a;
              sum_b += both * b;
              cells += both;
            }
          if (cells > 0.0f) {
            ab -= sum_a * sum_b / cells;
            aa -= sum_a * sum_a / cells;
            bb -= sum_b * sum_b / cells;
          }
          Likeness::At here;
          here.area_mm2 = static_cast<double>(cells) * kSearchMm * kSearchMm;
          if (here.area_mm2 < kLeastMeetMm2 || !(aa > 0.0f) || !(bb > 0.0f)) continue;
          here.likeness = static_cast<double>(ab / std::sqrt(aa * bb));
          here.first_from_second = turn;
          here.first_from_second.shift += kSearchMm * glm::dvec2(dx, dy);
          if (best.area_mm2 == 0.0 || here.weight() > best.weight()) best = here;
        }
      });
    }
  return out;
}

Sampled sampled(const SealImpression& of, const glm::dvec2& at_mm) {
  const double x = at_mm.x / of.step_mm, y = at_mm.y / of.step_mm;
  if (!(x >= 0.0 && y >= 0.0 && x <= of.width - 1 && y <= of.height - 1)) return {};
  const int i = std::min(static_cast<int>(x), of.width - 2), j = std::min(static_cast<int>(y), of.height - 2);
  if (i < 0 || j < 0) return {};
  const double fx = x - i, fy = y - j;
  Sampled out;
  for (const int b : {0, 1})
    for (const int a : {0, 1}) {
      const std::size_t at = of.index(i + a, j + b);
      const double share = (a ? fx : 1 - fx) * (b ? fy : 1 - fy), weight = share * static_cast<double>(of.shown[at]);
      out.weight += weight;
      out.mm += weight * static_cast<double>(of.mm[at]);
      out.figure += of.figure.empty() ? 0.0 : share * static_cast<double>(of.figure[at]);
      out.raised += of.raised.empty() ? 0.0 : share * static_cast<double>(of.raised[at]);
    }
  if (out.weight > 0.0) out.mm /= out.weight;
  return out;
}

PlacedOn refined(const SealImpression& frame, const SealImpression& impression, const PlacedOn& start,
                 double period_mm) {
  constexpr int kLooseRounds = 7, kRounds = 14, kBendRounds = 4;  // bends after that many
  constexpr double kLooseFirstMm = 0.2, kLooseMm = 0.08;  // of the loss: half of what figures stand out, then noise
  // Rest of .08 mm over 33 places of the raster a figure, against strains and bends of .1 mm a cm: 33 (.08 / .1)^2.
  constexpr double kHeld = 21.0, kTurnHeld = 1.0;
  constexpr std::size_t kTerms = 3 + PlacedOn::kBends, kUnknown = 2 * kTerms;
  PlacedOn place = start;
  place.middle = 0.5 * impression.step_mm * glm::dvec2(impression.width, impression.height);
  const int stride = std::max(1, static_cast<int>(0.35 / impression.step_mm));
  const double h = std::max(0.15, frame.step_mm);
  for (int round = 0; round < kRounds; ++round) {
    const double loose = round < kLooseRounds ? kLooseFirstMm : kLooseMm;
    std::array<std::array<double, kUnknown + 1>, kUnknown> rows{};
    for (int y = 0; y < impression.height; y += stride)
      for (int x = 0; x < impression.width; x += stride) {
        const std::size_t at = impression.index(x, y);
        if (impression.shown[at] < 0.5f) continue;
        const glm::dvec2 q = impression.step_mm * glm::dvec2(x, y);
        glm::dvec2 p = place(q);
        if (period_mm > 0.0) p.x -= period_mm * std::floor(p.x / period_mm);
        const Sampled here = sampled(frame, p), east = sampled(frame, p + glm::dvec2(h, 0)),
                      west = sampled(frame, p - glm::dvec2(h, 0)), north = sampled(frame, p + glm::dvec2(0, h)),
                      south = sampled(frame, p - glm::dvec2(0, h));
        if (std::min({here.weight, east.weight, west.weight, north.weight, south.weight}) < 0.3) continue;
        const double value = static_cast<double>(impression.raised[at]), rest = here.raised - value, t = rest / loose,
                     loss = 1.0 / ((1.0 + t * t) * (1.0 + t * t));
        const double gx = (east.raised - west.raised) / (2 * h), gy = (north.raised - south.raised) / (2 * h);
        const glm::dvec2 d = q - place.middle;
        const auto bends = PlacedOn::bend_terms(d);
        const glm::dvec2 in_frame = place.turn * d;  // so that strains are those of the frame, upside down, too
        std::array<double, kTerms> terms{1.0, 0.1 * in_frame.x, 0.1 * in_frame.y};
        std::copy(bends.begin(), bends.end(), terms.begin() + 3);
        std::array<double, kUnknown> slope{};
        for (std::size_t k = 0; k < kTerms; ++k) {
          slope[2 * k] = gx * terms[k];
          slope[2 * k + 1] = gy * terms[k];
        }
        for (std::size_t r = 0; r < kUnknown; ++r) {
          for (std::size_t c = 0; c < kUnknown; ++c) rows[r][c] += loss * slope[r] * slope[c];
          rows[r][kUnknown] -= loss * slope[r] * rest;
        }
      }
    // What is not a turn is held near 0 in all, not from round to round.
    const glm::dmat2 strain = strain_of(place.turn);
    const double xx = 10.0 * strain[0][0], yy = 10.0 * strain[1][1], xy = 10.0 * strain[1][0];
    constexpr std::size_t kRight = kUnknown;
    rows[2][2] += kHeld, rows[2][kRight] -= kHeld * xx;
    rows[5][5] += kHeld, rows[5][kRight] -= kHeld * yy;
    for (const std::size_t r : {3, 4}) {
      for (const std::size_t c : {3, 4}) rows[r][c] += 0.5 * kHeld;
      rows[r][kRight] -= kHeld * xy;
      rows[r][r] += kTurnHeld;
    }
    for (std::size_t k = 0; k < PlacedOn::kBends; ++k) {
      const glm::dvec2 bent = place.turn * place.bend[k];
      for (const std::size_t axis : {0, 1}) {
        const std::size_t r = 6 + 2 * k + axis;
        rows[r][r] += round < kBendRounds ? 1e9 : kHeld;
        if (round >= kBendRounds) rows[r][kRight] -= kHeld * bent[static_cast<int>(axis)];
      }
    }
    for (const std::size_t r : {0, 1}) rows[r][r] += 1e-9;
    if (!solved<kUnknown>(rows)) break;
    const auto term = [&](std::size_t k) {
      return glm::clamp(glm::dvec2(rows[2 * k][kUnknown], rows[2 * k + 1][kUnknown]), -kMostMoveMm, kMostMoveMm);
    };
    const glm::dmat2 to_own = glm::inverse(place.turn);
    for (std::size_t k = 0; k < PlacedOn::kBends; ++k) place.bend[k] += to_own * term(3 + k);
    const glm::dvec2 at_middle = place(place.middle);
    place.turn += 0.1 * glm::dmat2(term(1), term(2)) * place.turn;
    place.shift = at_middle + term(0) - place.turn * place.middle;
  }
  return place;
}

}  // namespace dubsar
