// People who have never seen an object follow a hand, before the kiosk as it is. They share no constant with the
// recogniser; a failed figure is repeated by its seed: ./do visitors SEED.

#include <gtest/gtest.h>

#include "tests/app/kiosk/gallery_visit.h"

namespace dubsar::app::test {
namespace {

constexpr std::uint64_t kFreshSeeds = 9'640'000;  // drawn after the last change of the recogniser
constexpr int kOfEachKind = 40;

TEST(NaiveVisitors, TurnTheTabletBringItNearerAndReachWhatIsInside) {
  GalleryFigures all;
  for (std::size_t kind = 0; kind < kNaiveKinds.size(); ++kind)
    for (int i = 0; i < kOfEachKind; ++i)
      all.add(visit(draw_gallery(kNaiveKinds[kind], kFreshSeeds + 1000 * kind + static_cast<unsigned>(i))));
  EXPECT_GE(all.turned, 176) << "of " << all.visitors << " within 20 s";
  EXPECT_GE(all.zoomed, 168) << "of " << all.visitors << ": 90 % less three standard deviations of so few";
  EXPECT_GE(all.opened, 160) << "of " << all.visitors << " within 60 s";
  EXPECT_LE(all.unwanted / all.minutes, 0.08) << "movements a minute that nobody wanted";
  EXPECT_LE(all.takeovers, 4) << "movements by bystanders' hands, of " << all.visitors << " visits";
}

TEST(NaiveVisitors, AVisitRepeatsToTheLastBit) {
  const GalleryOptions room = draw_gallery(NaiveKind::kPushes, 11);
  const GalleryVisit a = visit(room), b = visit(room);
  EXPECT_EQ(a.turned_s, b.turned_s);
  EXPECT_EQ(a.zoomed_s, b.zoomed_s);
  EXPECT_EQ(a.opened_s, b.opened_s);
  EXPECT_EQ(a.unwanted, b.unwanted);
}

TEST(NaiveVisitors, NobodyTurnsAnythingWithoutHands) {  // else the figures above show nothing
  GalleryOptions room = draw_gallery(NaiveKind::kImitates, 3);
  room.bystanders = 0;
  room.reflections = false;
  room.arrives_s = 100.0;
  room.leaves_s = 60.0;
  const GalleryVisit nothing = visit(room);
  EXPECT_FALSE(nothing.turned_s);
  EXPECT_FALSE(nothing.zoomed_s);
  EXPECT_FALSE(nothing.opened_s);
}

}  // namespace
}  // namespace dubsar::app::test
