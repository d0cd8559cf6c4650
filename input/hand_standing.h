#pragma once
// What is known of a hand beside where it is and what it does.

namespace dubsar {

struct HandStanding {
  /// It is the hand of who stands before the panel: so say the heads that are seen, or its arm, or that this person's
  /// hands have been followed for long. Not of one that may be the other hand of somebody whose head is seen beside,
  /// mistaken.
  bool sure = false;
  /// Likewise of somebody beside of whom nothing but hands was seen.
  bool doubtful = false;
  bool at_face = false;  ///< of its own person: it scratches, or holds the chin
};

}  // namespace dubsar
