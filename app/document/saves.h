#pragma once
// Which of two copies of somebody's work followed from which.

#include <cstdint>
#include <map>
#include <string>

namespace dubsar::app {

/// How often each session has kept the work, by the session's own name: a version vector (D. Parker et al., Detection
/// of mutual inconsistency in distributed systems, 1983). A copy that contains the other one's saves followed from it;
/// of two that do not contain each other each has what the other one lacks.
struct Saves {
  std::map<std::string, std::int64_t> counts;

  bool contains(const Saves& other) const {
    for (const auto& [session, count] : other.counts)
      if (const auto at = counts.find(session); at == counts.end() || at->second < count) return false;
    return true;
  }
  void join(const Saves& other) {
    for (const auto& [session, count] : other.counts) {
      std::int64_t& mine = counts[session];
      if (mine < count) mine = count;
    }
  }
  friend bool operator==(const Saves&, const Saves&) = default;
};

}  // namespace dubsar::app
