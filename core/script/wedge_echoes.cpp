#include "core/script/wedge_echoes.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr double kEchoTurned = 0.966;      // cosine of 15 degrees
constexpr double kEchoBeside = 1.0 / 3.0;  // of the deeper one's width
constexpr double kEchoDepth = 2.0 / 3.0;   // the groove of a phantom's tail is .5 of its head, of tablets less

bool is_echo_of(const ScriptWedge& one, const ScriptWedge& deeper) {
  if (one.depth_mm > kEchoDepth * deeper.depth_mm) return false;
  if (glm::dot(one.direction, deeper.direction) < kEchoTurned || glm::dot(one.normal, deeper.normal) < 0.5)
    return false;
  const glm::dvec3 off = one.tip_mm - deeper.tip_mm;
  const double along = glm::dot(off, deeper.direction),
               across = glm::dot(off, glm::cross(deeper.normal, deeper.direction));
  const double end = glm::dot(deeper.tail_mm - deeper.tip_mm, deeper.direction);
  return along > 0.0 && along < end && std::abs(across) < kEchoBeside * deeper.width_mm;
}

}  // namespace

void drop_echoes(std::vector<ScriptWedge>& wedges) {
  std::vector<ScriptWedge> kept;
  for (const ScriptWedge& one : wedges) {
    bool echo = false;
    for (const ScriptWedge& other : wedges) echo = echo || is_echo_of(one, other);
    if (!echo) kept.push_back(one);
  }
  wedges = std::move(kept);
}

}  // namespace dubsar
