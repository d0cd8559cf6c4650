// The contact is the same wherever and however its object lies on the grid.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "core/contact/clay_sides.h"
#include "core/contact/dents.h"
#include "core/contact/dips.h"
#include "core/contact/film_refine.h"
#include "core/contact/recentre.h"
#include "core/contact/ring_average.h"
#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr int kSheet = 40, kMiddle = kSheet / 2;

/// A sheet across the film of a FilmScene, uneven, whose squares are quadrilaterals divided one way or the other.
InterfaceMesh divided_sheet(const FilmScene& scene, bool other_way) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uneven(-0.4f, 0.4f);
  InterfaceMesh mesh = sheet(kSheet, [&](int x, int y) {
    const float u = 0.5f * static_cast<float>(x - kMiddle), v = 0.5f * static_cast<float>(y - kMiddle);
    return scene.at(u + 0.3f * uneven(random), v + 0.3f * uneven(random), 0.6f + uneven(random));
  });
  for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 2) {
    mesh.quads.push_back(t);
    const std::array<std::uint32_t, 4> c = corners_of_quad(mesh, t);
    if (!other_way) continue;
    mesh.triangles[t] = {c[1], c[2], c[3]};
    mesh.triangles[t + 1] = {c[1], c[3], c[0]};
  }
  return mesh;
}

/// Where a mesh comes to lie in the film.
std::vector<glm::vec3> followed(InterfaceMesh mesh, const FilmScene& scene) {
  const std::vector<bool> moves(mesh.added.size(), true), step(mesh.added.size(), false);
  follow_dips(mesh, InterfaceRings(mesh, 0), {}, {moves, step}, scene.density(), {.most = 2.5f});
  return mesh.added;
}

float farthest(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  float most = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, glm::distance(a[i], b[i]));
  return most;
}

TEST(InterfaceRings, WhichDiagonalDividesAQuadrilateralChangesNothing) {
  const FilmScene scene{.noise = 0.1f};
  InterfaceMesh one = divided_sheet(scene, false), other = divided_sheet(scene, true);
  std::vector<float> value(one.added.size());
  std::mt19937 random(5);
  for (float& v : value) v = std::uniform_real_distribution<float>(0.0f, 1.0f)(random);
  std::vector<float> again = value;
  const InterfaceRings rings(one, 0), rings_again(other, 0);
  average_rings(rings, 5, value);
  average_rings(rings_again, 5, again);
  for (std::size_t i = 0; i < value.size(); ++i) ASSERT_NEAR(value[i], again[i], 1e-5f);
  EXPECT_LT(farthest(unit_normals(one, rings, {}, 1), unit_normals(other, rings_again, {}, 1)), 1e-4f);
  const std::vector<float> depth = dent_depths(one, rings, {}), depth_again = dent_depths(other, rings_again, {});
  for (std::size_t i = 0; i < depth.size(); ++i) ASSERT_NEAR(depth[i], depth_again[i], 1e-3f);
  EXPECT_LT(farthest(followed(one, scene), followed(other, scene)), 2e-3f);
  one.quads.clear();
  other.quads.clear();
  EXPECT_GT(farthest(followed(one, scene), followed(other, scene)), 0.1f) << "as where triangles decide";
}

/// How an object lies on its grid: axes exchanged, mirrored, then shifted.
struct Placement {
  std::array<int, 3> axis{0, 1, 2};  ///< of the object, along x, y, z of the grid
  glm::bvec3 mirrored{false};
  glm::ivec3 shift{0};

  template <class Vector>
  Vector placed(const Vector& p, float edge) const {
    Vector q;
    for (int k = 0; k < 3; ++k) {
      const auto at = p[axis[static_cast<std::size_t>(k)]];
      q[k] = (mirrored[k] ? static_cast<decltype(at)>(edge - 1.0f) - at : at) + static_cast<decltype(at)>(shift[k]);
    }
    return q;
  }
  glm::vec3 turned(const glm::vec3& direction) const {
    glm::vec3 q;
    for (int k = 0; k < 3; ++k) q[k] = (mirrored[k] ? -1.0f : 1.0f) * direction[axis[static_cast<std::size_t>(k)]];
    return q;
  }
  std::string text() const {
    std::string text = "axes ";
    for (int k = 0; k < 3; ++k)
      text += std::string(mirrored[k] ? "-" : "+") + "xyz"[axis[static_cast<std::size_t>(k)]] +
              std::to_string(shift[k]) + " ";
    return text;
  }
};

/// Clay with a film of air that lies off the patch, with a dent in it, and noise that belongs to the object.
struct PlacedFilm {
  static constexpr int kEdge = 45;                  ///< odd: what is halved has the same points in a mirror image
  static constexpr int kPad = 16, kPadOfHalf = 32;  ///< steps of clay around it that nothing reaches beyond
  Placement place;
  Volume<float> scan;
  BitVolume inside;

  explicit PlacedFilm(const Placement& where, int pad = kPad)
      : place(where), scan(grid(where, pad)), inside(scan.dims) {
    place.shift += pad;
    std::mt19937 random(17);
    std::normal_distribution<float> noise(0.0f, 0.14f);
    for (float& v : scan.voxels.span()) v = 1.0f;
    for (std::int64_t z = 0; z < scan.dims.z; ++z)
      for (std::int64_t y = 0; y < scan.dims.y; ++y)
        for (std::int64_t x = 0; x < scan.dims.x; ++x) inside.set(x, y, z, true);
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
          const glm::ivec3 p(x, y, z), q = place.placed(p, kEdge);
          const float u = static_cast<float>(x - 22) / 5.0f, v = static_cast<float>(y - 18) / 4.0f,
                      film = 25.0f + 0.08f * static_cast<float>(x - 22) - 5.0f * std::exp(-u * u - v * v),
                      off = (static_cast<float>(z) - film) / 0.75f;
          scan.at(q.x, q.y, q.z) = 1.0f - 0.35f * std::exp(-0.5f * off * off) + noise(random);
        }
  }

  std::vector<PatchPoint> patch() const {
    std::vector<PatchPoint> samples;
    for (float y = 7.1f; y < 38.0f; y += 0.71f)
      for (float x = 7.2f; x < 38.0f; x += 0.69f) {
        const glm::vec3 normal = glm::normalize(glm::vec3(0.02f, 0.05f * std::sin(0.1f * y), 1.0f));
        samples.push_back({place.placed(glm::vec3(x, y, 22.3f + 0.02f * x), kEdge), place.turned(normal)});
      }
    return samples;
  }

  /// Of all points of the object: 0 off the band, 1 tablet, 2 envelope.
  std::vector<int> sides() const {
    SilentProgress progress;
    const ContactBand band = ContactBand::make(inside, patch(), 12.0f, progress).value();
    VolumeSource source(scan);
    const BandDensity density = BandDensity::read(band, source, progress).value();
    const Dips dips = find_dips(band, inside, density, progress).value();
    const std::vector<ClaySide> side = ClayDivision({band, dips, {}, {}, {}}).sides(progress).value();
    std::vector<int> found;
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
          const std::uint32_t n = band.at(place.placed(glm::ivec3(x, y, z), kEdge));
          found.push_back(n == ContactBand::kNone ? 0 : side[n] == ClaySide::kTablet ? 1 : 2);
        }
    return found;
  }

  /// How far the samples of the patch move along their normals.
  std::vector<float> heights(decltype(recentre_samples)* recentre) const {
    SilentProgress progress;
    std::vector<PatchPoint> samples = patch(), before = samples;
    VolumeSource source(scan);
    recentre(samples, inside, source, progress, {}).value();
    std::vector<float> ways;
    for (std::size_t i = 0; i < before.size(); ++i)
      ways.push_back(glm::dot(samples[i].position - before[i].position, before[i].normal));
    return ways;
  }

 private:
  static Volume<float> grid(const Placement& where, int pad) {
    const glm::ivec3 all = kEdge + 2 * pad + where.shift;
    return Volume<float>(Dims{all.x, all.y, all.z});
  }
};

const std::vector<Placement> kExact{
    {.shift = {8, 0, 16}}, {.mirrored = {true, false, true}}, {.axis = {2, 1, 0}, .mirrored = {false, true, false}}};
const std::vector<Placement> kUneven{{.shift = {1, 0, 0}}, {.shift = {7, 11, 5}}};

TEST(Placement, ClayHasTheSameSidesWhereverItLies) {
  const std::vector<int> plain = PlacedFilm({}).sides();
  const auto differ = [&](const Placement& place) {
    const std::vector<int> found = PlacedFilm(place).sides();
    std::int64_t count = 0;
    for (std::size_t i = 0; i < found.size(); ++i) count += found[i] != plain[i];
    return count;
  };
  ASSERT_GT(std::count(plain.begin(), plain.end(), 1), 10000);
  for (const Placement& place : kExact) EXPECT_EQ(differ(place), 0) << place.text();
  for (const Placement& place : kUneven) EXPECT_LE(differ(place), 60) << place.text();
}

TEST(Placement, PatchesComeToTheSameGroundWhereverTheyLie) {
  for (const auto recentre : {recentre_samples, recentre_samples_at_half}) {
    const int pad = recentre == recentre_samples ? PlacedFilm::kPad : PlacedFilm::kPadOfHalf;
    const std::vector<float> plain = PlacedFilm({}, pad).heights(recentre);
    const auto farthest_off = [&](const Placement& place) {
      const std::vector<float> found = PlacedFilm(place, pad).heights(recentre);
      float most = 0.0f;
      for (std::size_t i = 0; i < found.size(); ++i) most = std::max(most, std::abs(found[i] - plain[i]));
      return most;
    };
    ASSERT_GT(*std::max_element(plain.begin(), plain.end()), 1.0f) << "nothing is found";
    for (const Placement& place : kExact) EXPECT_LT(farthest_off(place), 1e-2f) << place.text();
    if (recentre != recentre_samples) continue;
    for (const Placement& place : kUneven) EXPECT_LT(farthest_off(place), 0.1f) << place.text();
  }
}

}  // namespace
}  // namespace dubsar
