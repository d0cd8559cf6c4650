#pragma once
// Why wedges are missed, and what is drawn where none was pressed: by place and by cause, counted.

#include <array>
#include <map>
#include <span>
#include <string>

#include "core/mesh/tri_mesh.h"
#include "core/script/find_wedges.h"
#include "tests/core/script/wedge_score.h"

namespace dubsar {

/// Wedges that were wanted, of those missed; and wedges drawn that are not real.
class WedgeCauses {
 public:
  /// `every`: what was found on the same mesh without a bound of confidence.
  void add(const phantom::Phantom& truth, const TriMesh& mesh, const WedgesFound& found, const WedgesFound& every,
           const WedgeScore& score);
  /// Two tables, lines of "what: missed of wanted (share)" and "cause: count".
  std::string text() const;

 private:
  struct Tally {
    int wanted = 0, missed = 0;
  };
  std::map<std::string, Tally> places_;
  std::map<std::string, int> causes_, false_causes_;
  int wanted_ = 0, missed_ = 0, drawn_ = 0, false_ = 0;
};

}  // namespace dubsar
