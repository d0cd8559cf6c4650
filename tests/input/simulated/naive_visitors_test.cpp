// People who have never seen an object follow a hand, before the program's own mapping. They share no constant with the
// recogniser; a failed figure is repeated by its seed.

#include <gtest/gtest.h>

#include "input/simulated/gallery.h"
#include "tests/input/simulated/naive_visit.h"

namespace dubsar::test {
namespace {

constexpr std::uint64_t kFreshSeeds = 7'310'000;  // drawn after the last change of the recogniser
constexpr int kOfEachKind = 100;

TEST(NaiveVisitors, TurnTheTabletOnPurposeAndBringItNearer) {
  NaiveFigures all;
  for (std::size_t kind = 0; kind < kNaiveKinds.size(); ++kind) {
    NaiveFigures figures;
    for (int i = 0; i < kOfEachKind; ++i) {
      const NaiveVisit seen =
          visit(draw_gallery(kNaiveKinds[kind], kFreshSeeds + 1000 * kind + static_cast<unsigned>(i)));
      figures.add(seen);
      all.add(seen);
    }
    EXPECT_GE(figures.turned, 75) << "kind " << kind << ", seeds from " << kFreshSeeds + 1000 * kind;
    EXPECT_GE(figures.zoomed, 90) << "kind " << kind << ", seeds from " << kFreshSeeds + 1000 * kind;
  }
  EXPECT_GE(all.turned, 430) << "of " << all.visitors << " within 20 s";
  EXPECT_GE(all.zoomed, 465) << "of " << all.visitors;
  EXPECT_LE(all.unwanted / all.minutes, 0.7) << "movements a minute that nobody wanted";
  EXPECT_LE(all.takeovers, 400) << "movements by bystanders' hands, of " << all.visitors << " visits";
  RecordProperty("turned_of_500", all.turned);
  RecordProperty("zoomed_of_500", all.zoomed);
  RecordProperty("unwanted_a_minute", std::to_string(all.unwanted / all.minutes));
  RecordProperty("takeovers", all.takeovers);
}

TEST(NaiveVisitors, AVisitRepeatsToTheLastBit) {
  const GalleryOptions room = draw_gallery(NaiveKind::kPushes, 11);
  const NaiveVisit a = visit(room), b = visit(room);
  EXPECT_EQ(a.turned_s, b.turned_s);
  EXPECT_EQ(a.zoomed_s, b.zoomed_s);
  EXPECT_EQ(a.unwanted, b.unwanted);
}

TEST(NaiveVisitors, NobodyTurnsAnythingWithoutHands) {  // else the figures above show nothing
  GalleryOptions room = draw_gallery(NaiveKind::kImitates, 3);
  room.bystanders = 0;
  room.reflections = false;
  room.arrives_s = 100.0;
  room.leaves_s = 60.0;
  const NaiveVisit nothing = visit(room);
  EXPECT_FALSE(nothing.turned_s);
  EXPECT_FALSE(nothing.zoomed_s);
}

}  // namespace
}  // namespace dubsar::test
