// Contact between tablet and envelope, traced in scans of phantoms whose truth is known.

#include "core/contact/trace.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>

#include "core/mesh/evidence.h"
#include "core/mesh/exact_crossings.h"
#include "core/mesh/mesh_check.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"
#include "tests/core/phantom/contact_score.h"

namespace dubsar {
namespace {

/// A model of a scan, and the truth about it.
struct TracedScan {
  PipelineResult result;
  std::unique_ptr<const phantom::Phantom> truth;

  TriMesh body(const char* name) const { return make_tri_mesh(result.model, {.body = name}).value(); }
  phantom::ContactScore score() const {
    const TriMesh tablet = body("tablet");
    std::vector<glm::vec3> positions;
    for (const glm::vec3& p : tablet.positions) positions.push_back(glm::vec3(tablet.frame.input_vox_from_grid(p)));
    return judge_contact(*truth, {positions, tablet.triangles, {}, result.report.detail.resample() ? 2.0 : 1.0},
                         tablet.evidence);
  }
};

struct ScanKind {
  Dims scan{224, 128, 208};
  Detail detail = Detail::kScan;
  double glued = 0.2;             ///< share of the tablet
  std::string_view scanner = {};  ///< words of `phantom --scanner`; none: 17 dB of the recipe
};
constexpr ScanKind kHalved{{384, 208, 360}, Detail::kHalf};

TracedScan traced_scan(phantom::Contact contact, double film, std::uint64_t seed, bool trace = true,
                       bool written = true, const ScanKind& kind = {}) {
  phantom::PhantomOptions wanted;
  wanted.dims = kind.scan;
  wanted.seed = seed;
  wanted.contact = contact;
  wanted.film_vox = film;
  wanted.contact_share = kind.glued;
  wanted.writing.written = written;
  if (!kind.scanner.empty()) wanted.scanner = phantom::parse_scanner(kind.scanner).value();
  const auto path = std::filesystem::temp_directory_path() / fmt::format("dubsar_trace_{}_{}.h5", ::getpid(), seed);
  SilentProgress progress;
  phantom::write_phantom(path, std::nullopt, wanted, progress).value();
  PipelineOptions options;
  options.import.path = path;
  options.detail = kind.detail;
  options.occlusion = std::nullopt;
  if (!trace) options.contact.reset();
  TracedScan made{run_pipeline(options, progress).value(), phantom::Phantom::create(wanted).value()};
  std::filesystem::remove(path);
  return made;
}

/// And no two triangles touch.
void expect_closed_and_mating(const TracedScan& made) {
  for (const char* name : {"tablet", "envelope"}) {
    const TriMesh mesh = made.body(name);
    EXPECT_TRUE(check_mesh(mesh.positions, mesh.triangles).watertight()) << name;
    EXPECT_EQ(check_exactly(mesh.positions, mesh.triangles), ExactCheck{}) << name;
  }
  // Every triangle of the contact is in both, once each way round.
  using Place = std::array<float, 3>;
  std::map<std::array<Place, 3>, int> uses;
  const auto add = [&](const TriMesh& mesh, int sense) {
    for (const Triangle& t : mesh.triangles) {
      bool contact = false;
      std::array<Place, 3> places;
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3& p = mesh.positions[t[i]];
        places[i] = {p.x, p.y, p.z};
        contact = contact || mesh.evidence[t[i]] >= evidence_byte(Evidence::kFilm);
      }
      if (!contact) continue;
      if (sense < 0) std::swap(places[1], places[2]);
      std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
      uses[places] += sense;
    }
  };
  add(made.body("tablet"), 1);
  add(made.body("envelope"), -1);
  std::int64_t without_mate = 0;
  for (const auto& [places, net] : uses) without_mate += net != 0;
  EXPECT_GT(uses.size(), 1000u);
  EXPECT_EQ(without_mate, 0);
}

TEST(TraceContact, FilmOfHalfAVoxelIsFollowed) {
  constexpr std::uint64_t kSeeds[] = {60617, 60641, 60661};
  double near = 0.0, film = 0.0;
  int invented = 0;
  for (const std::uint64_t seed : kSeeds) {
    const TracedScan made = traced_scan(phantom::Contact::kFilm, 0.5, seed);
    ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
    expect_closed_and_mating(made);
    const phantom::ContactScore score = made.score();
    near += score.near_fraction() / static_cast<double>(std::size(kSeeds));
    film += static_cast<double>(score.evidence[2]) / static_cast<double>(score.contact_vertices) /
            static_cast<double>(std::size(kSeeds));
    invented += score.false_wedges();
  }
  RecordProperty("near", fmt::format("{:.3f}", near));
  RecordProperty("film", fmt::format("{:.3f}", film));
  EXPECT_GE(near, 0.92);
  EXPECT_GE(film, 0.8);
  EXPECT_LE(invented, 1);  // of one seed
  EXPECT_LT(traced_scan(phantom::Contact::kFilm, 0.5, kSeeds[0], false).score().near_fraction(), 0.8)
      << "a smooth contact does as well";
}

TEST(TraceContact, SmoothContactClosesPartsOfWhichNoTwoTrianglesTouch) {
  for (const ScanKind& kind : {ScanKind{}, kHalved}) {
    const TracedScan made = traced_scan(phantom::Contact::kPressed, 0.5, 60733, false, true, kind);
    ASSERT_TRUE(made.result.report.contact && !made.result.report.contact->traced);
    expect_closed_and_mating(made);
    EXPECT_EQ(made.score().evidence[2], 0) << "a film that nobody looked for";
  }
}

TEST(TraceContact, NothingIsInventedWhereTheEnvelopeFillsTheWedges) {
  const TracedScan made = traced_scan(phantom::Contact::kFilled, 0.5, 60631);
  ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
  expect_closed_and_mating(made);
  const phantom::ContactScore score = made.score();
  EXPECT_EQ(score.false_wedges(), 0);
  EXPECT_GE(static_cast<double>(score.evidence[3]), 0.85 * static_cast<double>(score.contact_vertices));
}

// A reconstruction makes dips without air that hang together, whatever its noise.
TEST(TraceContact, NoFilmIsMadeOfWhatAScannerLeaves) {
  for (const char* scanner : {"good,turn=half,cone=0", "strong,turn=half,cone=0"}) {
    const TracedScan made =
        traced_scan(phantom::Contact::kPressed, 0.5, 60811, true, true, {.glued = 0.3, .scanner = scanner});
    ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
    const phantom::ContactScore score = made.score();
    EXPECT_LE(static_cast<double>(score.evidence[2]), 0.01 * static_cast<double>(score.contact_vertices)) << scanner;
    EXPECT_EQ(score.false_wedges(), 0) << scanner;
  }
}

TEST(TraceContact, NothingIsReadOnATabletThatNobodyWroteOn) {
  const TracedScan made = traced_scan(phantom::Contact::kFilm, 0.5, 60673, true, false);
  ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
  const phantom::ContactScore score = made.score();
  EXPECT_GE(score.near_fraction(), 0.98);
  EXPECT_EQ(score.false_wedges(), 0);
  // Where the tablet is free, nothing stands out of the noise: a wedge is 7 voxels deep, a stroke of 1 can be read.
  const TriMesh tablet = made.body("tablet");
  std::int64_t free = 0, off = 0;
  for (std::size_t i = 0; i < tablet.positions.size(); ++i) {
    const glm::dvec3 p = tablet.frame.input_vox_from_grid(glm::dvec3(tablet.positions[i]));
    if (tablet.evidence[i] != evidence_byte(Evidence::kMeasured) || made.truth->gap_width(p) < 2.0) continue;
    ++free;
    off += std::abs(made.truth->tablet_distance(p)) > 1.0;
  }
  EXPECT_GT(free, 1000);
  EXPECT_LE(static_cast<double>(off), 0.002 * static_cast<double>(free));
}

TEST(TraceContact, PocketsBelongToTheTablet) {
  const TracedScan made = traced_scan(phantom::Contact::kPockets, 0.5, 60649);
  ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
  expect_closed_and_mating(made);
  const phantom::CaseScore pockets = made.score().cases[static_cast<std::size_t>(phantom::WedgeCase::kPocket)];
  ASSERT_GT(pockets.wedges, 3);
  EXPECT_GE(pockets.shown_fraction(), 0.9);
}

/// Of places from the surface, voxels.
struct Offsets {
  double sum = 0.0, squares = 0.0;
  std::int64_t count = 0;
  void add(double off) {
    sum += off;
    squares += off * off;
    ++count;
  }
  double mean() const { return sum / static_cast<double>(count); }
  double rms() const { return std::sqrt(squares / static_cast<double>(count)); }
};

TEST(TraceContact, SmoothContactLeansToNeitherSide) {
  Offsets offsets;
  for (const std::uint64_t seed : {60703u, 60719u, 60727u}) {
    const TracedScan made = traced_scan(phantom::Contact::kPressed, 0.5, seed, false);
    const TriMesh tablet = made.body("tablet");
    for (std::size_t i = 0; i < tablet.positions.size(); ++i) {
      if (tablet.evidence[i] != evidence_byte(Evidence::kInferred)) continue;
      const double off = made.truth->tablet_distance(tablet.frame.input_vox_from_grid(glm::dvec3(tablet.positions[i])));
      offsets.add(off);
    }
  }
  ASSERT_GT(offsets.count, 5000);
  RecordProperty("mean", fmt::format("{:.2f}", offsets.mean()));
  RecordProperty("rms", fmt::format("{:.2f}", offsets.rms()));
  EXPECT_LT(std::abs(offsets.mean()), 0.5) << "towards the envelope, voxels";
  EXPECT_LT(offsets.rms(), 1.6);
}

TEST(TraceContact, TheContactOfAThinFilmRunsThroughNothing) {
  const TracedScan made = traced_scan(phantom::Contact::kFilm, 0.3, 60659);
  ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
  expect_closed_and_mating(made);
}

TEST(TraceContact, PartsTouchNowhereHoweverMuchIsGluedAndHoweverThinTheFilm) {
  struct Case {
    double glued, film;
    std::uint64_t seed;  // of the sweep over shares of .1 to .6 and films of .2 to 1
    Dims scan{192, 128, 176};
  };
  for (const Case& one : {Case{0.1, 1.0, 391103},
                          {0.2, 0.2, 391105},
                          {0.4, 0.35, 391101},
                          {0.4, 0.7, 391102},
                          {0.6, 0.3, 391007, {256, 160, 240}}}) {
    SCOPED_TRACE(fmt::format("seed {}", one.seed));
    const TracedScan made =
        traced_scan(phantom::Contact::kFilm, one.film, one.seed, true, true, {one.scan, Detail::kScan, one.glued});
    ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
    expect_closed_and_mating(made);
  }
}

TEST(TraceContact, FilmsAreFollowedAtHalfTheResolution) {
  const TracedScan made = traced_scan(phantom::Contact::kFilm, 0.5, 61126, true, true, kHalved);
  ASSERT_TRUE(made.result.report.detail.resample());
  ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
  expect_closed_and_mating(made);
  const phantom::ContactScore score = made.score();
  EXPECT_GE(score.near_fraction(), 0.8);  // a voxel is half a step of this grid
  const auto film = static_cast<double>(score.evidence[2]), all = static_cast<double>(score.contact_vertices);
  EXPECT_GE(film, 0.8 * all);
  EXPECT_EQ(score.false_wedges(), 0);
  EXPECT_LT(traced_scan(phantom::Contact::kFilm, 0.5, 61126, false, true, kHalved).score().near_fraction(), 0.65)
      << "a smooth contact does as well";
}

TEST(TraceContact, PocketsBelongToTheTabletAtHalfTheResolution) {
  const TracedScan made = traced_scan(phantom::Contact::kPockets, 0.5, 61151, true, true, kHalved);
  ASSERT_TRUE(made.result.report.contact && made.result.report.contact->traced);
  expect_closed_and_mating(made);
  const phantom::CaseScore pockets = made.score().cases[static_cast<std::size_t>(phantom::WedgeCase::kPocket)];
  ASSERT_GT(pockets.wedges, 3);
  EXPECT_GE(pockets.shown_fraction(), 0.9);
}

/// Distance from a place to the tablet's surface along the axis on which it is nearest, voxels, positive outside. The
/// truth itself says no more than a few.
double far_distance(const phantom::Phantom& truth, const glm::dvec3& at) {
  constexpr double kFarthest = 60.0, kSure = 3.0;
  const double near = truth.tablet_distance(at);
  if (std::abs(near) < kSure) return near;
  double best = kFarthest;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sense : {-1.0, 1.0})
      for (double way = kSure; way < best; way += 1.0) {
        glm::dvec3 there = at;
        there[axis] += sense * way;
        if ((truth.tablet_distance(there) > 0.0) != (near > 0.0)) best = way;
      }
  return near > 0.0 ? best : -best;
}

TEST(TraceContact, SmoothContactOverAThirdOfATabletStaysNearIt) {
  double area = 0.0, sum = 0.0, squares = 0.0;
  for (const std::uint64_t seed : {61211u, 61223u}) {
    const TracedScan made =
        traced_scan(phantom::Contact::kPressed, 0.5, seed, false, true, {{448, 256, 416}, Detail::kScan, 0.33});
    const TriMesh tablet = made.body("tablet");
    for (std::size_t t = 0; t < tablet.triangles.size(); t += 3) {
      const Triangle& corners = tablet.triangles[t];
      if (std::none_of(corners.begin(), corners.end(),
                       [&](std::uint32_t v) { return tablet.evidence[v] == evidence_byte(Evidence::kInferred); }))
        continue;
      const glm::dvec3 a(tablet.positions[corners[0]]), b(tablet.positions[corners[1]]),
          c(tablet.positions[corners[2]]);
      const double of_this = glm::length(glm::cross(b - a, c - a));
      const double off = far_distance(*made.truth, tablet.frame.input_vox_from_grid((a + b + c) / 3.0));
      area += of_this;
      sum += of_this * off;
      squares += of_this * off * off;
    }
  }
  ASSERT_GT(area, 4000.0);
  RecordProperty("mean", fmt::format("{:.2f}", sum / area));
  RecordProperty("rms", fmt::format("{:.2f}", std::sqrt(squares / area)));
  EXPECT_LT(std::abs(sum / area), 1.75);
  EXPECT_LT(std::sqrt(squares / area), 4.0);
}

}  // namespace
}  // namespace dubsar
