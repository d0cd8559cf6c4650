// What lies between tablet and envelope: the scan shows what the truth says.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/phantom/phantom_source.h"
#include "core/phantom/write_phantom.h"
#include "tests/core/volume/read_all.h"

namespace dubsar::phantom {
namespace {

PhantomOptions small(Contact contact) {
  PhantomOptions options;
  options.dims = {256, 136, 236};
  options.seed = 8021;
  options.contact = contact;
  options.contact_share = 0.3;
  options.snr_db = std::numeric_limits<double>::infinity();
  return options;
}

std::shared_ptr<const Phantom> make(const PhantomOptions& options) { return Phantom::create(options).value(); }

Volume<float> scan(const std::shared_ptr<const Phantom>& phantom) {
  PhantomSource source(phantom);
  return dubsar::testing::read_all(source).value();
}

float value(const Volume<float>& volume, const glm::dvec3& p) {
  const glm::dvec3 f = glm::floor(p), t = p - f;
  double sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    const glm::ivec3 o(k & 1, k >> 1 & 1, k >> 2);
    const glm::dvec3 w(o.x ? t.x : 1.0 - t.x, o.y ? t.y : 1.0 - t.y, o.z ? t.z : 1.0 - t.z);
    sum += w.x * w.y * w.z *
           static_cast<double>(volume.at(static_cast<std::int64_t>(f.x) + o.x, static_cast<std::int64_t>(f.y) + o.y,
                                         static_cast<std::int64_t>(f.z) + o.z));
  }
  return static_cast<float>(sum);
}

/// Places on the tablet's broad sides in the middle of contact, away from writing.
std::vector<std::pair<glm::dvec3, glm::dvec3>> contact_places(const Phantom& phantom) {
  std::vector<std::pair<glm::dvec3, glm::dvec3>> places;
  const Dims d = phantom.options().dims;
  for (std::int64_t z = 40; z < d.z - 40; z += 3)
    for (std::int64_t x = 40; x < d.x - 40; x += 3)
      for (const int sign : {-1, 1}) {
        glm::dvec3 p(x, 0.5 * static_cast<double>(d.y), z);
        for (double y = 0.0; y < 60.0 && phantom.on_tablet_side(p); y += 0.1) p.y += 0.1 * sign;
        glm::dvec3 normal(0.0);
        for (int a = 0; a < 3; ++a) {
          glm::dvec3 e(0.0);
          e[a] = 0.5;
          normal[a] = phantom.tablet_distance(p + e) - phantom.tablet_distance(p - e);
        }
        if (std::abs(phantom.tablet_distance(p)) > 0.2 || !phantom.in_contact(p) || std::abs(normal.y) < 0.9) continue;
        bool inside = true;
        for (const glm::dvec3 e :
             {glm::dvec3(6, 0, 0), glm::dvec3(-6, 0, 0), glm::dvec3(0, 0, 6), glm::dvec3(0, 0, -6)})
          inside = inside && phantom.in_contact(p + e);
        for (const Wedge& w : phantom.wedges()) inside = inside && glm::distance(w.position, p) > 14.0;
        if (inside) places.emplace_back(p, glm::normalize(normal));
      }
  return places;
}

/// Air that a line across the interface meets, in voxels: what the point spread moves about, it does not take away.
double missing_clay(const Volume<float>& volume, const glm::dvec3& p, const glm::dvec3& normal, double reach) {
  constexpr double kStep = 0.25;
  double sum = 0.0;
  for (double h = -reach; h <= reach; h += kStep)
    sum += kStep * (1.0 - static_cast<double>(value(volume, p + h * normal)) / static_cast<double>(kClayDensity));
  return sum;
}

TEST(PhantomContact, FilmTakesItsThicknessFromTheDensity) {
  for (const double film : {0.2, 0.5, 1.0}) {
    PhantomOptions options = small(Contact::kFilm);
    options.film_vox = film;
    const auto phantom = make(options);
    const Volume<float> volume = scan(phantom);
    const auto places = contact_places(*phantom);
    ASSERT_GT(places.size(), 20u);
    double mean = 0.0;
    for (const auto& [p, normal] : places) mean += missing_clay(volume, p, normal, 3.0);
    mean /= static_cast<double>(places.size());
    EXPECT_NEAR(mean, film, 0.1 * film + 0.02);
  }
}

// Else clay of the envelope lies loose in wedges, with a gap over it. Near the tablet's edges the way down is not quite
// that to the nearest place.
TEST(PhantomContact, TheGapIsThatOfThePlaceNotOfTheDepth) {
  int looks = 0, differ = 0;
  for (const std::uint64_t seed : {8021u, 8022u, 8023u}) {
    PhantomOptions options = small(Contact::kFilm);
    options.seed = seed;
    const auto phantom = make(options);
    for (const Wedge& w : phantom->wedges()) {
      if (w.owner != Owner::kTablet) continue;
      const double gap = phantom->gap_width(w.position);
      for (const double share : {0.3, 0.6, 1.0}) {
        ++looks;
        const double deeper = phantom->gap_width(w.position - share * w.depth * w.outward);
        differ += std::abs(deeper - gap) > 0.15 * gap + 0.05;
      }
    }
  }
  EXPECT_GT(looks, 300);
  EXPECT_LT(differ, looks / 50) << looks;
}

TEST(PhantomContact, NothingIsSeenWhereTheEnvelopeFillsTheWedges) {
  const auto phantom = make(small(Contact::kFilled));
  const Volume<float> volume = scan(phantom);
  int filled = 0, seen = 0;
  for (const Wedge& w : phantom->wedges()) {
    // Beside the contact a gap follows the wedges, too; there may also be straw.
    bool inside = w.owner == Owner::kTablet;
    for (const double along : {-7.0, 0.0, 7.0})
      inside = inside && phantom->gap_width(w.position + along * w.tail) < -1.0;
    if (!inside) continue;
    EXPECT_EQ(w.state, WedgeCase::kFilled);
    ++filled;
    seen += missing_clay(volume, w.position - 0.5 * w.depth * w.outward, w.outward, 0.5 * w.depth) > 0.3;
  }
  EXPECT_GT(filled, 10);
  EXPECT_LE(seen, filled / 5);  // pores and straw
}

TEST(PhantomContact, AFilmIsWhatIsNoWiderThanItWasAskedToBe) {
  PhantomOptions options = small(Contact::kFilm);
  options.film_vox = 0.4;
  const auto phantom = make(options);
  int films = 0, gaps = 0;
  for (const Wedge& w : phantom->wedges()) {
    if (w.owner != Owner::kTablet) continue;
    const bool film = phantom->gap_width(w.position) <= 0.4 + 1e-6;
    EXPECT_EQ(w.state, film ? WedgeCase::kFilm : WedgeCase::kFree);
    ++(film ? films : gaps);
  }
  EXPECT_GT(films, 5);
  EXPECT_GT(gaps, 20);
}

TEST(PhantomContact, PocketsAreFullOfAirAndClosed) {
  const auto phantom = make(small(Contact::kPockets));
  const Volume<float> volume = scan(phantom);
  int pockets = 0;
  for (const Wedge& w : phantom->wedges()) {
    if (w.owner != Owner::kTablet || w.state != WedgeCase::kPocket || w.depth < 5.0) continue;
    ++pockets;
    EXPECT_LT(value(volume, w.position - 0.45 * w.depth * w.outward), 0.5f * kClayDensity);
    EXPECT_GT(value(volume, w.position + 2.5 * w.outward), 0.8f * kClayDensity);
  }
  EXPECT_GT(pockets, 5);
}

TEST(PhantomContact, OptionsAreObeyed) {
  PhantomOptions options = small(Contact::kPressed);
  options.dims = {512, 272, 472};
  options.contact_share = 0.25;
  EXPECT_NEAR(make(options)->glued_fraction(), 0.25, 0.06);  // and some touches
  for (const double depth : {5.0, 14.0}) {
    options.wedge_depth_vox = depth;
    std::vector<double> depths;
    const auto phantom = make(options);
    for (const Wedge& w : phantom->wedges())
      if (w.owner == Owner::kTablet) depths.push_back(w.depth);
    ASSERT_GT(depths.size(), 30u);
    std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end());
    EXPECT_NEAR(depths[depths.size() / 2], depth, 0.2 * depth);
  }
  options.writing.written = false;
  const auto unwritten = make(options);
  for (const Wedge& w : unwritten->wedges()) EXPECT_EQ(w.owner, Owner::kEnvelope);
  options.film_vox = 0.0;
  EXPECT_EQ(Phantom::create(options).error().kind, ErrorKind::kUsage);
}

TEST(PhantomContact, RingsAndDensityOfTheEnvelopeAreInTheScan) {
  PhantomOptions options = small(Contact::kPressed);
  const Volume<float> plain = scan(make(options));
  options.rings = 0.05;
  const Volume<float> ringed = scan(make(options));
  double squares = 0.0;
  for (std::int64_t i = 0; i < plain.dims.count(); ++i) {
    const double difference =
        static_cast<double>(ringed.voxels[i] - plain.voxels[i]) / static_cast<double>(kClayDensity);
    squares += difference * difference;
  }
  const double deviation = std::sqrt(squares / static_cast<double>(plain.dims.count()));
  EXPECT_GT(deviation, 0.02);
  EXPECT_LT(deviation, 0.08);
  options.rings = 0.0;
  options.envelope_density = 0.9;
  const auto phantom = make(options);
  const Volume<float> two = scan(phantom);
  const Dims d = options.dims;
  EXPECT_NEAR(two.at(d.x / 2, d.y / 2, d.z / 2), kClayDensity, 0.3f * kClayDensity);
  int envelope = 0;
  for (std::int64_t z = 20; z < d.z; z += 7)
    for (std::int64_t y = 10; y < d.y; y += 5)
      for (std::int64_t x = 20; x < d.x; x += 7) {
        const glm::dvec3 p(x, y, z);
        const Fields f = phantom->fields(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        if (phantom->label(p) != Label::kEnvelope ||
            std::min({std::abs(f.outer.v), std::abs(f.wall.v), f.pore.v, f.organic.v, f.grain.v}) < 5.0f ||
            phantom->cracked())
          continue;
        ++envelope;
        EXPECT_NEAR(two.at(x, y, z), 0.9f * kClayDensity, 1e-3f * kClayDensity);
      }
  EXPECT_TRUE(envelope > 0 || phantom->cracked());
}

}  // namespace
}  // namespace dubsar::phantom
