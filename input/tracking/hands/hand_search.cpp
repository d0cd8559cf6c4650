#include "input/tracking/hands/hand_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace dubsar {
namespace {

constexpr double kRadiusAtScale1 = 0.043;  // of the palm's circle
constexpr double kSideFist = 0.15;         // the thumb of a fist shifts that circle, in radii
constexpr double kOpenFlexion = 0.05, kFistFlexion = 0.95;
// Misfit of a coarse fit that may do, of a final one that needs no other start, and of one that is no hand.
constexpr double kFits = 0.13, kFitsWell = 0.095, kNoHand = 0.18;
constexpr int kSureVotes = 3, kMostVotes = 10;

/// Turn that makes directions of tips fit a spread hand, and how badly they do.
struct Alignment {
  double turn_rad = 0.0, cost = 0.0;
};
Alignment align_fingers(const std::vector<double>& tips_rad, bool left) {
  // Right hand, little finger to thumb, seen from the centre of the palm's circle.
  constexpr std::array<double, 5> kNominal{-0.65, -0.22, 0.08, 0.45, 1.6};
  constexpr double kTurnSd = 0.2, kAngleSd = 0.07, kThumbSd = 0.2;
  const std::size_t tips = tips_rad.size();
  if (tips == 0 || tips > 5) return {};
  Alignment best{0.0, 1e9};
  for (unsigned chosen = 0; chosen < 32; ++chosen) {
    if (static_cast<std::size_t>(std::popcount(chosen)) != tips) continue;
    std::array<double, 5> difference{}, weight{};
    double sum = 0.0, total = 1.0 / (kTurnSd * kTurnSd);
    for (std::size_t finger = 0, tip = 0; finger < 5; ++finger) {
      if ((chosen >> finger & 1U) == 0) continue;
      difference[finger] = (left ? -tips_rad[tips - 1 - tip] : tips_rad[tip]) - kNominal[finger];
      ++tip;
      weight[finger] = finger == 4 ? 1.0 / (kThumbSd * kThumbSd) : 1.0 / (kAngleSd * kAngleSd);
      sum += weight[finger] * difference[finger];
      total += weight[finger];
    }
    const double turn = sum / total;
    double cost = turn * turn / (kTurnSd * kTurnSd);
    for (std::size_t finger = 0; finger < 5; ++finger)
      cost += weight[finger] * (difference[finger] - turn) * (difference[finger] - turn);
    if (cost < best.cost) best = {left ? -turn : turn, cost};
  }
  return best;
}

double misfit(const HandFitResult& result, std::span<const EyeSamples> eyes) {
  double noise = 0.0;
  for (const EyeSamples& eye : eyes) noise = std::max(noise, eye.noise);
  return std::sqrt(std::max(0.0, result.mean_error * result.mean_error - noise * noise));
}

HandPrior prior_of(const HandMemory& memory, double grab) {
  HandPrior prior;
  const double known = std::sqrt(1.0 + memory.frames);
  prior.pose.scale = memory.scale;
  prior.pose.finger_length = memory.finger_length;
  prior.pose.palm_width = memory.palm_width;
  prior.scale_sd = std::max(0.015, prior.scale_sd / known);
  prior.shape_sd = std::max(0.015, prior.shape_sd / known);
  prior.pose.spread = 0.8;
  prior.pose.flexion.fill(glm::mix(kOpenFlexion, kFistFlexion, grab));
  prior.flexion_sd = 0.15 - 0.08 * grab;
  return prior;
}

void remember(const HandPose& pose, const HandGuess& guess, HandMemory& memory) {
  memory.frames = std::min(memory.frames + 1, 60);
  const auto learn = [&](double& mean, double value) { mean += (value - mean) / memory.frames; };
  learn(memory.scale, pose.scale);
  learn(memory.finger_length, pose.finger_length);
  learn(memory.palm_width, pose.palm_width);
  memory.last = HandMemory::Last{pose, guess.palm_m};
}

}  // namespace

FoundHand search_hand(HandFit& fit, std::span<const EyeSamples> eyes, const HandGuess& guess, HandMemory& memory) {
  std::size_t tiles = 0;
  for (const EyeSamples& eye : eyes) tiles += eye.tiles.size();
  const std::array<HandFitStep, 2> coarse{
      {{std::max(0.008, 2.5 * guess.pixel_m), 4, std::clamp<std::size_t>(tiles / 120, 1, 4), 20.0},
       {std::max(0.004, 1.2 * guess.pixel_m), 4, std::clamp<std::size_t>(tiles / 240, 1, 2)}}};
  const std::array<HandFitStep, 1> fine{{{std::max(0.002, 0.7 * guess.pixel_m), 4}}};
  const std::span<const HandFitStep> near = std::span(coarse).last(1);

  struct Try {
    HandFitResult result{};
    HandPrior prior{};
  };
  std::array<Try, 2> best;  // right, left
  best[0].result.cost = best[1].result.cost = 1e9;
  const auto attempt = [&](const HandPrior& prior, const HandPose& start, std::span<const HandFitStep> steps) {
    const HandFitResult result = fit.fit(eyes, prior, start, steps);
    if (result.cost < best[start.left].result.cost) best[start.left] = {result, prior};
    return misfit(result, eyes) < kFits;
  };
  const std::array<Alignment, 2> alignment{align_fingers(guess.finger_rad, false),
                                           align_fingers(guess.finger_rad, true)};
  const auto start_of = [&](bool left, double turn, double forward, double grab) {
    HandPrior prior = prior_of(memory, grab);
    prior.pose.left = left;
    prior.pose.palm.rotation =
        glm::angleAxis(guess.turn_rad + turn + (grab < 0.5 ? alignment[left].turn_rad : 0.0), glm::dvec3(0, 1, 0));
    HandPose start = prior.pose;
    start.palm.position_m =
        guess.palm_m +
        guess.radius_m * (start.palm.rotation * glm::dvec3((left ? -kSideFist : kSideFist) * grab, 0.0, -forward));
    if (memory.frames == 0) start.scale = std::clamp(guess.radius_m / kRadiusAtScale1, 0.85, 1.15);
    return std::pair(prior, start);
  };
  const auto guessed = [&](bool left) {
    const auto [prior, start] = start_of(left, 0.0, 0.0, guess.grab);
    return attempt(prior, start, coarse);
  };

  bool fits = false;
  if (memory.last) {
    HandPose start = memory.last->pose;
    start.palm.position_m += guess.palm_m - memory.last->guess_m;
    HandPrior prior = prior_of(memory, 0.0);
    prior.pose.flexion = start.flexion;
    prior.pose.spread = start.spread;
    prior.pose.left = start.left;
    fits = attempt(prior, start, near);
  }
  const bool sure = std::abs(memory.right_votes) >= kSureVotes;
  const bool first = memory.right_votes != 0 ? memory.right_votes < 0 : alignment[1].cost < alignment[0].cost;
  if (!fits || !sure) {
    if (!fits || !memory.last) fits = guessed(first);
    // Open hands that fit are told left from right by their thumb; fists are looked at both ways.
    if (!fits || (guess.grab > 0.5 && !sure)) fits = guessed(!first) || fits;
  }
  const auto finish = [&] {
    const bool left = best[1].result.cost < best[0].result.cost;
    const HandFitResult result = fit.fit(eyes, best[left].prior, best[left].result.pose, fine);
    return FoundHand{result.pose, misfit(result, eyes), false};
  };
  FoundHand found = finish();
  if (found.misfit > kFitsWell) {
    // The first, cheap step from every other start, the rest from the best two of them.
    struct Start {
      double turn, forward, grab;
    };
    const double other = guess.grab > 0.5 ? 0.0 : 1.0;
    const std::array<Start, 4> starts{
        {{0.0, -0.6, guess.grab}, {0.0, 0.0, other}, {0.25, 0.0, guess.grab}, {-0.25, 0.0, guess.grab}}};
    std::vector<Try> tries;
    for (const Start& s : starts)
      for (const bool left : {false, true}) {
        const auto [prior, start] = start_of(left, s.turn, s.forward, s.grab);
        tries.push_back({fit.fit(eyes, prior, start, std::span(coarse).first(1)), prior});
      }
    std::partial_sort(tries.begin(), tries.begin() + 2, tries.end(),
                      [](const Try& a, const Try& b) { return a.result.cost < b.result.cost; });
    const double before = std::min(best[0].result.cost, best[1].result.cost);
    for (const std::size_t i : {0U, 1U}) attempt(tries[i].prior, tries[i].result.pose, near);
    if (std::min(best[0].result.cost, best[1].result.cost) < before)
      if (const FoundHand again = finish(); again.misfit < found.misfit) found = again;
  }
  const bool left = found.pose.left;
  found.fits = found.misfit < kNoHand;
  if (found.fits) {
    const bool clear = best[left].result.cost < 0.85 * best[!left].result.cost;
    if (clear) memory.right_votes = std::clamp(memory.right_votes + (left ? -1 : 1), -kMostVotes, kMostVotes);
    remember(found.pose, guess, memory);
  } else {
    memory.last.reset();
    found.pose = prior_of(memory, guess.grab).pose;
    found.pose.left = memory.right_votes < 0;
    found.pose.palm.position_m = guess.palm_m;
    found.pose.palm.rotation = glm::angleAxis(guess.turn_rad, glm::dvec3(0, 1, 0));
  }
  return found;
}

}  // namespace dubsar
