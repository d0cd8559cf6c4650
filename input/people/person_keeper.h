#pragma once
// Who is tracked: the person who came first, nearest and most central, is kept; bystanders are ignored until that
// person is gone.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "input/hand_frame.h"
#include "input/hand_standing.h"
#include "input/input_source.h"
#include "input/people/other_bodies.h"

namespace dubsar {

/// Keeps one head.
class HeadKeeper {
 public:
  /// The kept head if it is in `heads`, else null. It is known again by its tracker's id, or, where the tracker gave a
  /// new one, by its place (300 mm). When it has been away for `gone_ns`, the head with the least distance plus twice
  /// its sideways offset takes over; when `rests`, which is when the kept person's hands are down, also one for whom
  /// that is less by 250 mm for 0.5 s: who looked on from beside makes room for who stands before the panel.
  const HeadFrame* update(TimestampNs now, std::span<const HeadFrame> heads, bool rests = false);
  std::optional<glm::dvec3> place_m() const noexcept { return place_m_; }

 private:
  static constexpr TimestampNs kGone = 1'000'000'000;
  std::optional<glm::dvec3> place_m_;
  std::uint32_t id_ = 0, better_ = 0;
  TimestampNs seen_ = 0, better_since_ = -1;
};

struct HandZone {
  glm::dvec3 min_m{-0.35, -0.25, -0.2}, max_m{0.35, 0.35, 0.6};
};

/// Keeps up to two hands of one person, each in its slot.
class HandKeeper {
 public:
  explicit HandKeeper(const HandZone& zone = {}) : zone_(zone) {}

  /// The kept hands, null where a slot's hand is not seen now. A hand is let in when it first shows itself inside the
  /// zone, points roughly at the screen, belongs to the kept head rather than to another one (where heads are known)
  /// and, as the second hand, is the other hand of a plausible pair: not crossed, 60 to 700 mm apart, not 300 mm
  /// behind, and both arms come from shoulders of one body (back along the fingers). A slot is free again when its hand
  /// has been away for 1.5 s. Where no head is seen, the body whose fingers point here must stand before the panel, and
  /// owns it until no hand of it was seen for 4 s, or until the hand of one who stands 200 mm more before the middle
  /// was seen for 0.5 s. A kept hand that is clearly another head's for 0.3 s is let go. A hand that is called left and
  /// comes from the kept head's right shoulder is let in, unless it could be the left one of another head; trackers
  /// mistake some, for as long as they see them.
  std::array<const HandFrame*, 2> update(TimestampNs now, std::span<const HandFrame> hands,
                                         std::span<const HeadFrame> heads, std::optional<glm::dvec3> kept_head_m);
  /// Of the hands that update() gave.
  const std::array<HandStanding, 2>& standing() const noexcept { return standing_; }
  /// All slots are free.
  void let_go() {
    slots_ = {};
    owner_x_m_.reset();
  }
  /// Nobody's hand is kept.
  bool empty() const noexcept { return !slots_[0].taken && !slots_[1].taken; }

 private:
  static constexpr TimestampNs kGone = 1'500'000'000;
  struct Slot {
    bool taken = false;
    std::uint32_t id = 0;
    Chirality chirality = Chirality::kUnknown;
    glm::dvec3 place_m{0.0}, shoulder_m{0.0};
    TimestampNs seen = 0, came = 0;
    std::vector<std::uint32_t> strangers;  // seen beside this hand, so never it under a new id; the newest 16
    TimestampNs doubted_since = -1;        // it looks like somebody else's
  };
  bool may_enter(const HandFrame& hand, const Slot& other, std::span<const HeadFrame> heads,
                 const std::optional<glm::dvec3>& kept_head_m) const;
  bool is_the_owners(const HandFrame& hand, std::span<const HeadFrame> heads,
                     const std::optional<glm::dvec3>& kept_head_m) const;
  static bool is_mistaken(const HandFrame& hand, std::span<const HeadFrame> heads,
                          const std::optional<glm::dvec3>& kept_head_m);
  bool make_room(TimestampNs now, std::span<const HandFrame* const> others);
  void let_others_go(TimestampNs now, std::array<const HandFrame*, 2>& kept, std::span<const HeadFrame> heads,
                     const std::optional<glm::dvec3>& kept_head_m);
  HandStanding judge(TimestampNs now, const HandFrame& hand, std::span<const HeadFrame> heads,
                     const std::optional<glm::dvec3>& kept_head_m) const;
  void remember_owner(TimestampNs now, const std::array<const HandFrame*, 2>& kept);
  HandZone zone_;
  std::array<Slot, 2> slots_{};
  std::optional<double> owner_x_m_;  // where the body stands whose hands were kept last
  TimestampNs owner_seen_ = 0, owner_came_ = 0;
  TimestampNs better_since_ = -1;  // somebody more before the middle is there
  OtherBodies others_;
  std::array<HandStanding, 2> standing_{};
};

/// The person that is kept, as seen now.
struct KeptPerson {
  std::optional<HeadFrame> head;            ///< none: not in this frame
  std::array<const HandFrame*, 2> hands{};  ///< of the frame; null where a hand is not seen
  std::array<HandStanding, 2> standing{};   ///< of these hands
};

/// Keeps one person: head and hands.
class PersonKeeper {
 public:
  explicit PersonKeeper(const HandZone& zone = {}) : hands_(zone) {}
  /// The hands are good as long as `frame`.
  KeptPerson update(TimestampNs now, const InputFrame& frame);

 private:
  HeadKeeper head_;
  HandKeeper hands_;
};

}  // namespace dubsar
