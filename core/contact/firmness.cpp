#include "core/contact/firmness.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

#include "core/contact/ring_average.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr int kOwn = 2;          ///< steps from the contact within which dips are its own
constexpr float kWeaker = 0.5f;  ///< deviations: twice that of a mean over five rings
constexpr float kReachOfDoubt = 4.5f;
/// Steps from what is asked about: a contact that would move is held by what stays around it for some steps only.
constexpr float kAsked = 32.0f;

/// Nodes within kOwn steps along the grid of the contact.
std::vector<bool> beside_contact(const ContactBand& band, const std::vector<ClaySide>& side) {
  std::vector<bool> beside(band.nodes.size(), false);
  for (std::uint32_t n = 0; n < beside.size(); ++n)
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m != ContactBand::kNone && side[m] != side[n]) beside[n] = true;
    });
  grow(band, kOwn - 1, beside);
  return beside;
}

/// Leaves those that are marked within kAsked steps of a place, and none beyond twice that along an axis.
void keep_near(const ContactBand& band, std::span<const glm::vec3> places, std::vector<bool>& marked) {
  const auto cube = [middle = middle_of(band.samples)](const glm::vec3& p) {
    return glm::ivec3(glm::round((p - middle) / kAsked));
  };
  std::set<std::array<int, 3>> cubes;
  for (const glm::vec3& place : places)
    for (int k = 0; k < 27; ++k) {
      const glm::ivec3 c = cube(place);
      cubes.insert({c.x + k % 3 - 1, c.y + k / 3 % 3 - 1, c.z + k / 9 - 1});
    }
  for (std::uint32_t n = 0; n < marked.size(); ++n) {
    if (!marked[n]) continue;
    const glm::ivec3 c = cube(glm::vec3(band.point(n)));
    marked[n] = cubes.count({c.x, c.y, c.z}) != 0;
  }
}

}  // namespace

Result<std::vector<bool>> find_unfirm(const ContactBand& band, ClayDivision& division,
                                      const std::vector<ClaySide>& side, std::span<const glm::vec3> asked,
                                      Progress& progress) {
  const std::vector<bool> own = beside_contact(band, side);
  std::vector<bool> weaker = own;
  keep_near(band, asked, weaker);
  DUBSAR_ASSIGN(const std::vector<ClaySide> again, division.sides_if_weaker(weaker, kWeaker, progress));
  std::vector<bool> unfirm(own.size());
  for (std::size_t n = 0; n < own.size(); ++n) unfirm[n] = !own[n] && again[n] != side[n];
  return unfirm;
}

void doubt_unfirm(const ContactBand& band, const std::vector<bool>& unfirm, std::span<const glm::vec3> cut,
                  std::vector<std::uint8_t>& evidence) {
  constexpr int kReach = static_cast<int>(kReachOfDoubt) + 1;
  const auto near_unfirm = [&](const glm::vec3& p) {
    const glm::ivec3 middle(glm::round(p));
    for (int z = -kReach; z <= kReach; ++z)
      for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
          const glm::ivec3 q = middle + glm::ivec3(x, y, z);
          if (glm::distance(glm::vec3(q), p) >= kReachOfDoubt) continue;
          const std::uint32_t n = band.at(q);
          if (n != ContactBand::kNone && unfirm[n]) return true;
        }
    return false;
  };
  each_vertex(evidence.size(), [&](std::size_t i) {
    if (evidence[i] == evidence_byte(Evidence::kFilm) && near_unfirm(cut[i]))
      evidence[i] = evidence_byte(Evidence::kInferred);
  });
}

}  // namespace dubsar
