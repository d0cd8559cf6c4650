#include "tests/people/gallery.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar {
namespace {

// A stereo infrared camera below the panel: 150 by 120 degrees, 0.1 to 0.75 m (data sheet of the Leap Motion Controller
// 2).
constexpr glm::dvec3 kTracker_m{0.0, -0.25, 0.15};
constexpr double kNearest_m = 0.08, kFarthest_m = 0.8, kHalfWide = 3.0, kHalfDeep = 1.7;
constexpr std::uint32_t kIdsOfOne = 100'000;

bool in_sight(const glm::dvec3& at_m) {
  const glm::dvec3 d = at_m - kTracker_m;
  const double far = glm::length(d);
  return far > kNearest_m && far < kFarthest_m && d.y > 0.0 && std::abs(d.x) < kHalfWide * d.y &&
         std::abs(d.z) < kHalfDeep * d.y;
}

/// Times at which something is the case, drawn as time goes on.
class Spells {
 public:
  Spells(double per_s, double shortest_s, double longest_s, std::uint64_t seed)
      : per_s_(per_s), shortest_s_(shortest_s), longest_s_(longest_s), random_(seed) {
    draw(0.0);
  }
  bool now(double t_s) {
    while (t_s >= end_s_) {
      ++count_;
      draw(end_s_);
    }
    return t_s >= start_s_;
  }
  std::uint32_t count() const noexcept { return count_; }

 private:
  void draw(double from_s) {
    start_s_ = per_s_ > 0 ? from_s - std::log(1.0 - random_.uniform(0.0, 1.0)) / per_s_ : 1e12;
    end_s_ = start_s_ + random_.uniform(shortest_s_, longest_s_);
  }
  double per_s_, shortest_s_, longest_s_;
  ScriptRandom random_;
  double start_s_ = 0.0, end_s_ = 0.0;
  std::uint32_t count_ = 0;
};

/// Stands beside, with one arm that does things on its own.
struct Bystander {
  explicit Bystander(std::uint64_t seed, int number)
      : random(seed), body(draw_body(random)), arm(put(number), false, seed) {}
  const Body& put(int number) {
    const double side = (number % 2 == 0) == (random.uniform(0.0, 1.0) < 0.5) ? 1.0 : -1.0;
    body.eyes_m.x = side * random.uniform(0.4, 0.75);
    body.eyes_m.z = random.uniform(0.65, 1.1);
    return body;
  }
  void act(double t_s) {
    if (t_s < wakes_s || t_s < arm.busy_until_s()) return;
    const auto spot = [&] {
      return held_up_m(body, false, random.uniform(0.5, 0.95), wants) + glm::dvec3(-0.4 * body.eyes_m.x, 0.0, 0.0) +
             0.08 * glm::dvec3(random.normal(), random.normal(), random.normal());
    };
    double t = arm.raise(t_s, spot());
    for (int i = 0, times = 2 + static_cast<int>(random.uniform(0.0, 5.0)); i < times; ++i) {
      arm.grip(t, random.uniform(0.0, 1.0));
      t = arm.move(t, spot(), 0.08, random.uniform(0.7, 1.6));
    }
    wakes_s = arm.lower(t) + random.uniform(1.0, 8.0);
  }
  ScriptRandom random;
  Body body;
  Arm arm;
  double wakes_s = random.uniform(0.5, 5.0);
  double wants = random.uniform(0.0, 0.6);  // some would like to take it, too
};

/// One hand as a tracker follows it: lost at times, found again under another number.
struct Followed {
  Followed(std::uint32_t first, const Body& body, std::uint64_t seed)
      : id(first),
        random(seed),
        lost(body.sleeves ? 0.35 : 0.1, 0.02, 0.18, seed + 1),
        misread(body.sleeves ? 0.5 : 0.12, 0.01, 0.05, seed + 2),
        size(body.size) {}
  std::uint32_t id;
  ScriptRandom random;
  Spells lost, misread;
  double size;
  double misread_grab = 0.5;
  bool seen = false, wrong_side = false;
};

}  // namespace

GalleryOptions draw_gallery(NaiveKind kind, std::uint64_t seed) {
  ScriptRandom random(seed * 77 + 5);
  GalleryOptions room;
  room.kind = kind;
  room.seed = seed;
  room.arrives_s = random.uniform(0.5, 3.0);
  room.leaves_s = room.arrives_s + random.uniform(50.0, 70.0);
  room.bystanders = static_cast<int>(random.uniform(0.0, 5.0));
  room.camera = random.uniform(0.0, 1.0) < 0.5;
  room.sun = random.uniform(0.0, 1.0) < 0.2;
  room.reflections = random.uniform(0.0, 1.0) < 0.14;
  return room;
}

struct Gallery::Parts {
  explicit Parts(const GalleryOptions& given)
      : options(given),
        random(given.seed * 13 + 3),
        visitor(given.kind, given.seed, given.leaves_s - given.arrives_s),
        blind(given.sun ? 0.05 : 0.0, 0.2, 1.5, given.seed + 17),
        ghost(given.reflections ? 0.2 : 0.0, 0.05, 0.4, given.seed + 19) {
    rate_hz = random.uniform(60.0, 115.0);
    if (given.rate_hz > 0.0) rate_hz = given.rate_hz;
    late_s = random.uniform(0.01, 0.035);
    noise_m = 0.001 * random.uniform(0.4, 1.6);
    for (std::uint32_t i = 0; i < 2; ++i) hands.emplace_back(1 + i * kIdsOfOne / 2, visitor.body(), given.seed * 5 + i);
    for (int i = 0; i < given.bystanders; ++i) {
      others.push_back(std::make_unique<Bystander>(given.seed * 101 + static_cast<std::uint64_t>(i), i));
      hands.emplace_back(static_cast<std::uint32_t>(i + 1) * kIdsOfOne + 1, others.back()->body,
                         given.seed * 7 + 50 + static_cast<std::uint64_t>(i));
    }
  }

  void see_hand(const Arm& arm, std::size_t which, double t_s, InputFrame& frame) {
    Followed& hand = hands[which];
    const auto is = arm.at(t_s);
    const bool lost = hand.lost.now(t_s) || blind.now(t_s);
    if (!is || lost || !in_sight(is->palm.position_m) || frame.hands.size() == kMaxHands) {
      hand.seen = false;
      return;
    }
    if (!hand.seen) {
      ++hand.id;
      hand.wrong_side = random.uniform(0.0, 1.0) < 0.03;
    }
    hand.seen = true;
    HandFrame out;
    out.time = frame.time;
    out.id = hand.id;
    out.chirality = arm.left() != hand.wrong_side ? Chirality::kLeft : Chirality::kRight;
    out.valid = out.tracked = true;
    out.confidence = 0.9;
    out.palm = is->palm;
    const auto jitter = [&] {
      return glm::dvec3(hand.random.normal(), hand.random.normal(), 1.5 * hand.random.normal());
    };
    out.palm.position_m += noise_m * jitter();
    const bool misread = hand.misread.now(t_s);
    if (!misread) hand.misread_grab = hand.random.uniform(0.0, 1.0);
    out.grab_strength = std::clamp((misread ? hand.misread_grab : is->grab) + 0.025 * hand.random.normal(), 0.0, 1.0);
    out.pinch_distance_m = std::max(0.005, is->pinch_m + 0.002 * hand.random.normal());
    const double thumb = arm.left() ? 1.0 : -1.0;
    const auto joint = [&](HandJoint which_joint, const glm::dvec3& at) {
      out.joint(which_joint) = {compose(out.palm, Pose{hand.size * at, {1, 0, 0, 0}}), 0.008, true, true};
    };
    joint(HandJoint::kPalm, {0, 0, 0});
    joint(HandJoint::kWrist, {0, 0, 0.062});
    joint(HandJoint::kIndexProximal, {0.022 * thumb, 0, -0.04});
    joint(HandJoint::kMiddleProximal, {0, 0, -0.044});
    joint(HandJoint::kIndexTip, {0.022 * thumb, -0.03 * is->index, -0.04 - 0.075 + 0.05 * is->index});
    frame.hands.push_back(out);
  }

  void see_ghost(double t_s, InputFrame& frame) {
    if (!ghost.now(t_s)) {
      ghost_at = {random.uniform(-0.3, 0.3), random.uniform(-0.15, 0.2), random.uniform(0.05, 0.4)};
      return;
    }
    HandFrame out;
    out.time = frame.time;
    out.id = 90 * kIdsOfOne + ghost.count();
    out.chirality = ghost.count() % 2 == 0 ? Chirality::kLeft : Chirality::kRight;
    out.valid = out.tracked = true;
    out.confidence = random.uniform(0.2, 1.0);
    out.palm.position_m = ghost_at + 0.01 * glm::dvec3(random.normal(), random.normal(), random.normal());
    out.grab_strength = random.uniform(0.0, 1.0);
    out.pinch_distance_m = random.uniform(0.01, 0.08);
    if (frame.hands.size() < kMaxHands) frame.hands.push_back(out);
  }

  void see_head(const glm::dvec3& eyes_m, std::uint32_t id, InputFrame& frame) {
    HeadFrame head;
    head.time = frame.time;
    head.id = id;
    head.tracked = true;
    head.confidence = 1.0;
    const auto jitter = [&] { return 0.004 * glm::dvec3(random.normal(), random.normal(), 2.0 * random.normal()); };
    head.left_eye_m = eyes_m - glm::dvec3(0.0315, 0, 0) + jitter();
    head.right_eye_m = eyes_m + glm::dvec3(0.0315, 0, 0) + jitter();
    frame.heads.push_back(head);
  }

  const GalleryOptions options;
  ScriptRandom random;
  NaiveVisitor visitor;
  std::vector<std::unique_ptr<Bystander>> others;
  std::vector<Followed> hands;  // the visitor's two, then one of each other
  Spells blind, ghost;
  glm::dvec3 ghost_at{0.0};
  double rate_hz = 90.0, late_s = 0.02, noise_m = 0.001;
  std::int64_t sample = -1;
};

Gallery::Gallery(const GalleryOptions& options) : parts_(std::make_unique<Parts>(options)) {}
Gallery::~Gallery() = default;

const NaiveVisitor& Gallery::visitor() const noexcept { return parts_->visitor; }
bool Gallery::visitor_is_here(double t_s) const noexcept {
  return t_s >= parts_->options.arrives_s && t_s < parts_->options.leaves_s + 3.0;
}
bool Gallery::is_the_visitors(std::uint32_t id) noexcept { return id < kIdsOfOne; }

bool Gallery::step(double t_s, const SeenScreen& seen, InputFrame& frame) {
  Parts& p = *parts_;
  const double here_s = t_s - p.options.arrives_s;
  if (visitor_is_here(t_s)) p.visitor.look(here_s, seen);
  for (const auto& other : p.others) other->act(t_s);
  const auto sample = static_cast<std::int64_t>(std::floor((t_s - p.late_s) * p.rate_hz));
  if (sample < 0 || sample == p.sample) return false;
  p.sample = sample;
  const double seen_s = static_cast<double>(sample) / p.rate_hz;
  frame.time = static_cast<TimestampNs>(1e9 * seen_s);
  frame.hands.clear();
  frame.heads.clear();
  if (visitor_is_here(seen_s)) {
    const double at_s = seen_s - p.options.arrives_s;
    for (std::size_t i = 0; i < 2; ++i) p.see_hand(p.visitor.arms()[i], i, at_s, frame);
    if (p.options.camera) p.see_head(p.visitor.eyes_m(at_s), 1, frame);
  }
  for (std::size_t i = 0; i < p.others.size(); ++i) {
    p.see_hand(p.others[i]->arm, 2 + i, seen_s, frame);
    if (p.options.camera) p.see_head(p.others[i]->body.eyes_m, static_cast<std::uint32_t>(2 + i), frame);
  }
  p.see_ghost(seen_s, frame);
  return true;
}

}  // namespace dubsar
