// Pictures that exist already in a window, and whose eye gets which.

#include "display/sinks/view_pictures.h"
#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {

constexpr std::array<std::uint8_t, 3> kBoth{255, 255, 255}, kLeftOnly{255, 0, 0}, kRightOnly{0, 255, 255};

std::array<std::uint8_t, 3> middle_of(const Image& image) {
  const std::uint8_t* const at = image.at(kWidth / 2, kHeight / 2);
  return {at[0], at[1], at[2]};
}

/// A side-by-side picture: what the left eye sees, what the right one sees.
std::shared_ptr<const ViewPictures> pair_of(std::uint8_t left, std::uint8_t right) {
  Image picture(128, 48, 3);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 128; ++x) std::fill_n(picture.at(x, y), 3, x < 64 ? left : right);
  return std::make_shared<const ViewPictures>(split_picture(picture, layout_of_name("pair_sbs.png")).value());
}

bool swapped(const ViewMoment& moment) { return moment.viewer.stage().viewer().swap_eyes; }

TEST_F(Live, APairOfPicturesIsShownInAWindowAndAKeyExchangesTheEyes) {
  options_.stage.display = testing::spec("anaglyph:red_cyan_full");
  options_.stage.pictures = pair_of(255, 0);
  Image before, exchanged, back;
  const auto done = play({
      look(before),
      {[&] { person_->key("x"); }, [](const ViewMoment& m) { return swapped(m); }},
      look(exchanged),
      {[&] { person_->key("x"); }, [](const ViewMoment& m) { return !swapped(m); }},
      look(back),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(middle_of(before), kLeftOnly) << "the left eye's red glass lets the left picture through";
  EXPECT_EQ(middle_of(exchanged), kRightOnly);
  EXPECT_EQ(back.pixels, before.pixels);
}

TEST_F(Live, AKeyExchangesTheEyesOfASurfaceToo) {
  options_.stage.display = {"anaglyph"};
  Image before, exchanged;
  const auto done = play({
      look(before),
      {[&] { person_->key("x"); }, [](const ViewMoment& m) { return swapped(m); }},
      look(exchanged),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(before.pixels, offscreen("anaglyph", ViewState()).pixels);
  options_.stage.viewer.swap_eyes = true;
  EXPECT_EQ(exchanged.pixels, offscreen("anaglyph", ViewState()).pixels);
  EXPECT_GT(differing_share(before, exchanged), 0.01);
}

TEST_F(Live, OneViewHasNoEyesToExchange) {
  options_.stage.pictures = pair_of(255, 255);
  Image before, after;
  const auto done = play({
      look(before),
      {[&] { person_->key("x"); }, [](const ViewMoment&) { return true; }},
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.ui().help; }},
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.ui().help; }},
      look(after),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(middle_of(before), kBoth);
  EXPECT_EQ(after.pixels, before.pixels);
}

}  // namespace
}  // namespace dubsar::app
