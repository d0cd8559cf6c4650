#include "core/contact/firmness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr int kEdge = 48;
constexpr int kPlane = 24;  ///< height of the patch
constexpr int kHigh = kPlane + 3, kLow = kPlane - 3;

/// Clay with a flat patch through it, and two sheets of dips along it.
class TwoSheets {
 public:
  TwoSheets(float high, float low) : band_(make_band()) {
    dips_.strength.assign(band_.nodes.size(), 0.0f);
    for (std::uint32_t n = 0; n < dips_.strength.size(); ++n) {
      // The cut runs between two points, and both show the dip.
      const int z = band_.point(n).z;
      if (z == kHigh || z == kHigh + 1) dips_.strength[n] = high;
      if (z == kLow || z == kLow - 1) dips_.strength[n] = low;
    }
    SilentProgress progress;
    side_ = ClayDivision({band_, dips_, {}, {}, {}}).sides(progress).value();
  }

  /// Is all above some height the envelope's, and all below the tablet's, but for the rim of the patch?
  bool parts_at(int low, int high) const {
    for (std::uint32_t n = 0; n < side_.size(); ++n) {
      const glm::ivec3 p = band_.point(n);
      if (!amid(glm::vec3(p))) continue;
      const int z = p.z;
      if (z >= high && side_[n] != ClaySide::kEnvelope) return false;
      if (z <= low && side_[n] != ClaySide::kTablet) return false;
    }
    return true;
  }

  /// Asked about one place.
  std::vector<glm::vec3> unfirm(const glm::vec3& asked = {24.0f, 24.0f, 24.0f}) const {
    SilentProgress progress;
    ClayDivision division({band_, dips_, {}, {}, {}});
    EXPECT_EQ(division.sides(progress).value(), side_);
    const std::vector<bool> found = find_unfirm(band_, division, side_, std::span(&asked, 1), progress).value();
    std::vector<glm::vec3> places;
    for (std::uint32_t n = 0; n < found.size(); ++n)
      if (const glm::vec3 p(band_.point(n)); found[n] && amid(p)) places.push_back(p);
    return places;
  }
  const ContactBand& band() const { return band_; }

 private:
  static bool amid(const glm::vec3& p) { return std::max(std::abs(p.x - 23.5f), std::abs(p.y - 23.5f)) < 8.0f; }
  static ContactBand make_band() {
    BitVolume inside(Dims{kEdge, kEdge, kEdge});
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) inside.set(x, y, z, true);
    std::vector<PatchPoint> samples;
    for (int y = 13; y < kEdge - 12; ++y)
      for (int x = 13; x < kEdge - 12; ++x) samples.push_back({{x, y, kPlane}, {0.0f, 0.0f, 1.0f}});
    SilentProgress progress;
    return ContactBand::make(inside, std::move(samples), 10.0f, progress).value();
  }

  ContactBand band_;
  Dips dips_;
  std::vector<ClaySide> side_;
};

TEST(FindUnfirm, OneOfTwoSheetsThatAreAboutAsStrongIsChance) {
  const TwoSheets scene(1.5f, 1.7f);
  ASSERT_TRUE(scene.parts_at(kLow - 1, kLow)) << "the stronger one is lower";
  const std::vector<glm::vec3> places = scene.unfirm();
  ASSERT_GT(places.size(), 100u);
  for (const glm::vec3& p : places) {
    EXPECT_GT(p.z, static_cast<float>(kLow) + 1.0f) << "what lies beside the contact says nothing";
    EXPECT_LE(p.z, static_cast<float>(kHigh)) << "the other sheet is there";
  }
}

TEST(FindUnfirm, NobodyLooksFarFromWhatIsAskedAbout) {
  EXPECT_TRUE(TwoSheets(1.5f, 1.7f).unfirm(glm::vec3(24.0f, 24.0f, 200.0f)).empty());
}

TEST(FindUnfirm, AContactThatIsMuchStrongerThanAnyOtherIsFirm) {
  const TwoSheets scene(1.5f, 2.6f);
  ASSERT_TRUE(scene.parts_at(kLow - 1, kLow));
  EXPECT_TRUE(scene.unfirm().empty());
}

TEST(FindUnfirm, TheOnlySheetIsFirm) {
  const TwoSheets scene(1.5f, 0.0f);
  ASSERT_TRUE(scene.parts_at(kHigh, kHigh + 1));
  EXPECT_TRUE(scene.unfirm().empty());
}

TEST(DoubtUnfirm, AFilmBesideUnfirmNodesIsInferredAndNothingElse) {
  const TwoSheets scene(1.5f, 0.0f);
  std::vector<bool> unfirm(scene.band().nodes.size(), false);
  const glm::vec3 place(20.0f, 25.0f, static_cast<float>(kPlane));
  unfirm[scene.band().at(glm::ivec3(place))] = true;
  std::vector<glm::vec3> cut;
  for (int i = 0; i < 40; ++i) cut.push_back(place + glm::vec3(0.3f, 0.2f * static_cast<float>(i), 1.0f));
  std::vector<std::uint8_t> films(cut.size(), evidence_byte(Evidence::kFilm));
  std::vector<std::uint8_t> pockets(cut.size(), evidence_byte(Evidence::kPocket));
  doubt_unfirm(scene.band(), unfirm, cut, films);
  doubt_unfirm(scene.band(), unfirm, cut, pockets);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const bool near = glm::distance(cut[i], place) < 4.5f;
    EXPECT_EQ(films[i], evidence_byte(near ? Evidence::kInferred : Evidence::kFilm)) << i;
    EXPECT_EQ(pockets[i], evidence_byte(Evidence::kPocket));
  }
}

}  // namespace
}  // namespace dubsar
