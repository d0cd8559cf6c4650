#include "input/people/person_keeper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dubsar {
namespace {

constexpr double kSameHeadM = 0.30, kSameHandM = 0.12;
// How far a hand that was not seen may have gone: 5000 simulated sessions, 3 spoilt instead of 4 without this bound.
constexpr double kFoundNearM = 0.02, kFoundSpeedMps = 0.25;
constexpr double kLargestTurnTan = 1.43;  // a hand that reaches in from the side points more than 55 degrees off
constexpr double kBodyM = 0.75, kShortestArmM = 0.3, kLongestArmM = 0.9;  // bodies stand 0.75 m from the screen
constexpr double kSameShoulderM = 0.2, kShouldersMinM = 0.15, kShouldersMaxM = 0.55;
constexpr std::size_t kMostStrangers = 16;
constexpr double kClearlyBetterM = 0.25;
constexpr TimestampNs kMakesRoom = 500'000'000;
constexpr double kMoreCentralM = 0.2;
// A hand's shoulder, as its fingers tell it, is on its side of the head, and not far from it; without a camera the head
// is somewhere before the panel's middle.
constexpr double kFarthestShoulderM = 0.33, kWrongSideM = 0.05, kHeadUnknownM = 0.12;
constexpr double kHalfShouldersM = 0.19;
// Bodies that fingers tell of: 95 of 100 within 0.2 m of where they stand, 500 simulated visitors.
constexpr double kBeforeThePanelM = 0.3, kSameBodyM = 0.22, kNearestHeadM = 0.32, kMistakenM = 0.2;
constexpr TimestampNs kOwns = 500'000'000, kOwnerGone = 4'000'000'000;
constexpr double kOwnerFollows = 0.02;  // of the way at each sample
constexpr TimestampNs kFollowedLong = 2'500'000'000;
constexpr double kSquarelyM = 0.18, kNobodyNearM = 0.3;  // below and above what bodies are told wrong by, see above
constexpr double kAtFaceM = 0.22;                        // from between the eyes to the palm that holds the chin
constexpr double kClearlyAnothersM = 0.1;
constexpr TimestampNs kDoubted = 300'000'000;
constexpr double kHeadMarginM = 0.03;  // shoulders of two who stand close are as near to one head as to the other
constexpr double kPairMinM = 0.06, kPairMaxM = 0.70, kPairDepthM = 0.30;

std::optional<glm::dvec3> place_of(const HeadFrame& head) {
  if (head.left_eye_m && head.right_eye_m) return 0.5 * (*head.left_eye_m + *head.right_eye_m);
  return head.left_eye_m ? head.left_eye_m : head.right_eye_m;
}

bool contains(const std::vector<std::uint32_t>& ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

bool points_at_screen(const HandFrame& hand) {
  const glm::dvec3 fingers = hand.palm.rotation * glm::dvec3(0, 0, -1);
  return fingers.z < 0 && std::abs(fingers.x) <= kLargestTurnTan * -fingers.z;
}

/// Roughly where the arm comes from: back along the fingers to where bodies stand.
glm::dvec3 shoulder_of(const HandFrame& hand) {
  const glm::dvec3 back = hand.palm.rotation * glm::dvec3(0, 0, 1);
  const double length = back.z > 0.1 ? (kBodyM - hand.palm.position_m.z) / back.z : kLongestArmM;
  return hand.palm.position_m + std::clamp(length, kShortestArmM, kLongestArmM) * back;
}

/// Where the body stands, to the right of the panel's middle, whose arm this is.
double body_x_m(const HandFrame& hand) {
  const double shoulder = shoulder_of(hand).x;
  if (hand.chirality == Chirality::kUnknown) return shoulder;
  return shoulder + (hand.chirality == Chirality::kRight ? -kHalfShouldersM : kHalfShouldersM);
}

/// How far to the side of the arm's line, seen from above, a head is.
double aside_m(const HandFrame& hand, const glm::dvec3& head_m) {
  const glm::dvec3 back = hand.palm.rotation * glm::dvec3(0, 0, 1), to = head_m - hand.palm.position_m;
  return std::abs(to.x * back.z - to.z * back.x) / std::max(1e-6, std::hypot(back.x, back.z));
}

/// From a body to the nearest head that is not the kept one, sideways.
double nearest_other_m(double body_x_m, std::span<const HeadFrame> heads, const glm::dvec3& kept_head_m) {
  double nearest = std::numeric_limits<double>::max();
  for (const HeadFrame& head : heads)
    if (const auto eyes = place_of(head); eyes && glm::length(*eyes - kept_head_m) > kSameHeadM)
      nearest = std::min(nearest, std::abs(body_x_m - eyes->x));
  return nearest;
}

bool inside(const HandZone& zone, const glm::dvec3& p) {
  for (int i = 0; i < 3; ++i)
    if (p[i] < zone.min_m[i] || p[i] > zone.max_m[i]) return false;
  return true;
}

}  // namespace

namespace {

/// Who stands nearest and most before the middle.
double rank_of(const glm::dvec3& at_m) { return glm::length(at_m) + 2.0 * std::abs(at_m.x); }

const HeadFrame* foremost(std::span<const HeadFrame> heads) {
  const HeadFrame* best = nullptr;
  double least = std::numeric_limits<double>::max();
  for (const HeadFrame& head : heads) {
    const auto at = place_of(head);
    if (!at || !head.tracked || rank_of(*at) >= least) continue;
    least = rank_of(*at);
    best = &head;
  }
  return best;
}

}  // namespace

const HeadFrame* HeadKeeper::update(TimestampNs now, std::span<const HeadFrame> heads, bool rests) {
  seen_ = std::min(seen_, now);  // a clock that was set back
  better_since_ = std::min(better_since_, now);
  const HeadFrame* best = nullptr;
  double least = std::numeric_limits<double>::max();
  if (place_m_ && now - seen_ <= kGone) {
    for (const HeadFrame& head : heads) {
      const auto at = place_of(head);
      if (!at || !head.tracked) continue;
      const double apart = glm::length(*at - *place_m_);
      const double rank = head.id == id_ ? apart : 1.0 + apart;
      if ((head.id == id_ || apart <= kSameHeadM) && rank < least) {
        least = rank;
        best = &head;
      }
    }
  } else {
    place_m_.reset();
    best = foremost(heads);
  }
  const HeadFrame* const other = best != nullptr ? foremost(heads) : nullptr;
  const double margin_m = rests ? kClearlyBetterM : 2.0 * kClearlyBetterM;
  if (other == nullptr || other == best || rank_of(*place_of(*other)) + margin_m > rank_of(*place_of(*best))) {
    better_since_ = -1;
  } else if (better_since_ < 0 || better_ != other->id) {
    better_ = other->id;
    better_since_ = now;
  } else if (now - better_since_ >= (rests ? kMakesRoom : 2 * kMakesRoom)) {
    best = other;
  }
  if (best == nullptr) return nullptr;
  place_m_ = place_of(*best);
  id_ = best->id;
  seen_ = now;
  return best;
}

/// A left hand that is taken for a right one, or the other way round: the kept head has the shoulder that it comes
/// from, and nobody else there has that of the hand as it is called.
bool HandKeeper::is_mistaken(const HandFrame& hand, std::span<const HeadFrame> heads,
                             const std::optional<glm::dvec3>& kept_head_m) {
  if (!kept_head_m || hand.chirality == Chirality::kUnknown) return false;
  const double body = body_x_m(hand), mirrored = 2.0 * shoulder_of(hand).x - body;
  if (std::abs(mirrored - kept_head_m->x) > kSameBodyM) return false;
  return std::none_of(heads.begin(), heads.end(), [&](const HeadFrame& head) {
    const auto eyes = place_of(head);
    return eyes && glm::length(*eyes - *kept_head_m) > kSameHeadM && std::abs(body - eyes->x) <= kMistakenM;
  });
}

bool HandKeeper::is_the_owners(const HandFrame& hand, std::span<const HeadFrame> heads,
                               const std::optional<glm::dvec3>& kept_head_m) const {
  const double body = body_x_m(hand);
  const double unsure = hand.chirality == Chirality::kUnknown ? kHalfShouldersM : 0.0;
  if (!kept_head_m)
    return owner_x_m_ ? std::abs(body - *owner_x_m_) <= kSameBodyM + unsure
                      : std::abs(body) <= kBeforeThePanelM + unsure;
  const double apart = std::abs(body - kept_head_m->x), nearest = nearest_other_m(body, heads, *kept_head_m);
  if (apart <= kNearestHeadM + unsure && apart + kHeadMarginM <= nearest) return true;
  return is_mistaken(hand, heads, kept_head_m);
}

HandStanding HandKeeper::judge(TimestampNs now, const HandFrame& hand, std::span<const HeadFrame> heads,
                               const std::optional<glm::dvec3>& kept_head_m) const {
  HandStanding out;
  // Of two who stand side by side the near shoulders are at the same place: the hand of one, mistaken for his other
  // one, comes from the other body.
  const double body = body_x_m(hand), mirrored = 2.0 * shoulder_of(hand).x - body;
  out.sure = owner_x_m_ && std::abs(body - *owner_x_m_) <= kSameBodyM && now - owner_came_ >= kFollowedLong;
  if (kept_head_m) {
    const double nearest = nearest_other_m(body, heads, *kept_head_m);
    out.sure = out.sure || (std::abs(body - kept_head_m->x) <= kSameBodyM && nearest >= kNobodyNearM);
    out.at_face = glm::length(hand.palm.position_m - *kept_head_m) <= kAtFaceM;
    out.sure = out.sure && nearest_other_m(mirrored, heads, *kept_head_m) > kMistakenM;
  } else {
    out.sure = out.sure || std::abs(body) <= kSquarelyM;
    out.doubtful = others_.near(now, mirrored, kMistakenM);
  }
  return out;
}

/// Hands that came in for the kept head's and turn out to be of another one.
void HandKeeper::let_others_go(TimestampNs now, std::array<const HandFrame*, 2>& kept, std::span<const HeadFrame> heads,
                               const std::optional<glm::dvec3>& kept_head_m) {
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (kept[s] == nullptr) continue;
    const double body = body_x_m(*kept[s]);
    const bool anothers = kept_head_m && nearest_other_m(body, heads, *kept_head_m) + kClearlyAnothersM <=
                                             std::abs(body - kept_head_m->x);
    TimestampNs& since = slots_[s].doubted_since;
    if (!anothers) since = -1;
    if (anothers && since < 0) since = now;
    if (!anothers || now - since < kDoubted) continue;
    slots_[s] = {};
    kept[s] = nullptr;
  }
}

/// Where no head is seen: who stands before the middle for a while takes the place of one who reaches in from beside.
bool HandKeeper::make_room(TimestampNs now, std::span<const HandFrame* const> others) {
  const bool better = owner_x_m_ && std::any_of(others.begin(), others.end(), [&](const HandFrame* hand) {
                        return hand != nullptr && inside(zone_, hand->palm.position_m) && points_at_screen(*hand) &&
                               std::abs(body_x_m(*hand)) + kMoreCentralM <= std::abs(*owner_x_m_);
                      });
  if (!better) {
    better_since_ = -1;
  } else if (better_since_ < 0) {
    better_since_ = now;
  } else if (now - better_since_ >= kMakesRoom) {
    let_go();
    better_since_ = -1;
    return true;
  }
  return false;
}

void HandKeeper::remember_owner(TimestampNs now, const std::array<const HandFrame*, 2>& kept) {
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (kept[s] == nullptr || now - slots_[s].came < kOwns) continue;
    const double body = body_x_m(*kept[s]);
    if (!owner_x_m_) owner_came_ = now;
    owner_x_m_ = owner_x_m_ ? std::lerp(*owner_x_m_, body, kOwnerFollows) : body;
    owner_seen_ = now;
  }
}

bool HandKeeper::may_enter(const HandFrame& hand, const Slot& other, std::span<const HeadFrame> heads,
                           const std::optional<glm::dvec3>& kept_head_m) const {
  const glm::dvec3 &at = hand.palm.position_m, shoulder = shoulder_of(hand);
  if (!inside(zone_, at) || !points_at_screen(hand)) return false;
  if (kept_head_m)
    for (const HeadFrame& head : heads) {
      const auto eyes = place_of(head);
      if (eyes && glm::length(*eyes - *kept_head_m) > kSameHeadM &&
          aside_m(hand, *eyes) + kHeadMarginM < aside_m(hand, *kept_head_m))
        return false;
    }
  if (!is_the_owners(hand, heads, kept_head_m)) return false;
  const double beside = shoulder.x - (kept_head_m ? kept_head_m->x : 0.0);
  const double unsure = kept_head_m ? 0.0 : kHeadUnknownM;
  if (std::abs(beside) > kFarthestShoulderM + 0.5 * unsure) return false;
  if (hand.chirality != Chirality::kUnknown && !is_mistaken(hand, heads, kept_head_m) &&
      (hand.chirality == Chirality::kRight ? beside : -beside) < -kWrongSideM - unsure)
    return false;
  if (!other.taken) return true;
  const bool known = hand.chirality != Chirality::kUnknown && other.chirality != Chirality::kUnknown;
  if (known && hand.chirality == other.chirality) return false;
  const glm::dvec3 apart = at - other.place_m;
  if (known && (apart.x > 0) != (hand.chirality == Chirality::kRight)) return false;
  const double shoulders = shoulder.x - other.shoulder_m.x;
  if (std::abs(shoulders) > kShouldersMaxM || std::abs(shoulders) < kShouldersMinM) return false;
  if (known && (shoulders > 0) != (hand.chirality == Chirality::kRight)) return false;
  const double distance = glm::length(apart);
  return distance >= kPairMinM && distance <= kPairMaxM && std::abs(apart.z) <= kPairDepthM;
}

std::array<const HandFrame*, 2> HandKeeper::update(TimestampNs now, std::span<const HandFrame> hands,
                                                   std::span<const HeadFrame> heads,
                                                   std::optional<glm::dvec3> kept_head_m) {
  owner_seen_ = std::min(owner_seen_, now);  // a clock that was set back
  owner_came_ = std::min(owner_came_, now);
  better_since_ = std::min(better_since_, now);
  for (Slot& slot : slots_) {
    slot.seen = std::min(slot.seen, now);
    slot.came = std::min(slot.came, now);
    slot.doubted_since = std::min(slot.doubted_since, now);
  }
  if (owner_x_m_ && now - owner_seen_ > kOwnerGone) owner_x_m_.reset();
  std::array<const HandFrame*, 2> kept{};
  std::array<const HandFrame*, kMaxHands> left{};
  std::size_t count = 0;
  for (const HandFrame& hand : hands)
    if (hand.valid && hand.tracked && count < left.size()) left[count++] = &hand;
  const auto take = [&](std::size_t slot, std::size_t i) {
    const TimestampNs came = slots_[slot].taken ? slots_[slot].came : now;
    slots_[slot] = {true,
                    left[i]->id,
                    left[i]->chirality,
                    left[i]->palm.position_m,
                    shoulder_of(*left[i]),
                    now,
                    came,
                    std::move(slots_[slot].strangers),
                    slots_[slot].doubted_since};
    kept[slot] = std::exchange(left[i], nullptr);
  };
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (now - slots_[s].seen > kGone) slots_[s] = {};
    for (std::size_t i = 0; i < count && slots_[s].taken && kept[s] == nullptr; ++i)
      if (left[i] != nullptr && left[i]->id == slots_[s].id) take(s, i);
  }
  const auto reach_m = [&](const Slot& slot) {
    return std::min(kSameHandM, kFoundNearM + kFoundSpeedMps * 1e-9 * static_cast<double>(now - slot.seen));
  };
  for (std::size_t s = 0; s < slots_.size(); ++s)  // the tracker lost the hand and gave it a new id
    for (std::size_t i = 0; i < count && slots_[s].taken && kept[s] == nullptr; ++i)
      if (left[i] != nullptr && !contains(slots_[s].strangers, left[i]->id) &&
          glm::length(left[i]->palm.position_m - slots_[s].place_m) <= reach_m(slots_[s]) &&
          glm::length(shoulder_of(*left[i]) - slots_[s].shoulder_m) <= kSameShoulderM &&
          (left[i]->chirality == slots_[s].chirality || left[i]->chirality == Chirality::kUnknown))
        take(s, i);
  let_others_go(now, kept, heads, kept_head_m);
  if (!kept_head_m && make_room(now, {left.data(), count})) kept = {};
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (slots_[s].taken) continue;
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < count; ++i)
      if (left[i] != nullptr && may_enter(*left[i], slots_[1 - s], heads, kept_head_m) &&
          (!best || std::abs(left[i]->palm.position_m.x) < std::abs(left[*best]->palm.position_m.x)))
        best = i;
    if (best) take(s, *best);
  }
  for (std::size_t s = 0; s < slots_.size(); ++s)
    for (std::size_t i = 0; i < hands.size() && kept[s] != nullptr; ++i) {
      std::vector<std::uint32_t>& strangers = slots_[s].strangers;
      if (hands[i].id == kept[s]->id || contains(strangers, hands[i].id)) continue;
      if (strangers.size() == kMostStrangers) strangers.erase(strangers.begin());
      strangers.push_back(hands[i].id);
    }
  for (const HandFrame* const hand : left)
    if (hand != nullptr && hand->chirality != Chirality::kUnknown && !is_the_owners(*hand, heads, kept_head_m))
      others_.see(now, body_x_m(*hand));
  for (std::size_t s = 0; s < slots_.size(); ++s)
    standing_[s] = kept[s] == nullptr ? HandStanding() : judge(now, *kept[s], heads, kept_head_m);
  remember_owner(now, kept);
  return kept;
}

KeptPerson PersonKeeper::update(TimestampNs now, const InputFrame& frame) {
  KeptPerson out;
  const auto before = head_.place_m();
  if (const HeadFrame* const head = head_.update(now, frame.heads, hands_.empty())) out.head = *head;
  const auto place = head_.place_m();
  if (before && place && glm::length(*place - *before) > kSameHeadM) hands_.let_go();  // somebody else's
  out.hands = hands_.update(now, frame.hands, frame.heads, head_.place_m());
  out.standing = hands_.standing();
  return out;
}

}  // namespace dubsar
