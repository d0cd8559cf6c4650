#pragma once
// Equal points to one vertex.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace dubsar {

/// Gives equal points (+0 equals -0) the same id, in order of first appearance. An open hash table at most half full.
class PointWelder {
 public:
  std::uint32_t id(glm::vec3 point);
  std::vector<glm::vec3>& points() noexcept { return points_; }

 private:
  void grow();
  std::vector<glm::vec3> points_;
  std::vector<std::uint32_t> slots_;  ///< id + 1, 0: free
};

}  // namespace dubsar
