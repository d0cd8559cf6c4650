// Views made from others: the arithmetic against projections, the pictures against drawn ones.

#include "display/render/reproject.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>

#include "display/optics/off_axis.h"
#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/multi_view.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kWidth = 240, kHeight = 160;
constexpr Screen kScreen{.width_mm = 90,
                         .height_mm = 60,
                         .width_px = kWidth,
                         .height_px = kHeight,
                         .window_x = 0,
                         .window_y = 0,
                         .window_w = kWidth,
                         .window_h = kHeight};

View seen_from(const glm::dvec3& eye) { return viewer_view(kScreen.window_rect(), Observer(), eye); }

std::vector<View> row_of_views(int count, double cone_deg = 40) {
  std::vector<View> out;
  for (const glm::dvec3& eye : cone_eyes(count, cone_deg * std::numbers::pi / 180, 300)) out.push_back(seen_from(eye));
  return out;
}

glm::dvec3 pixel_of(const View& view, const glm::dvec3& p) {
  const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(p, 1.0);
  return {0.5 * kWidth * (clip.x / clip.w + 1), 0.5 * kHeight * (clip.y / clip.w + 1), 0.5 * (clip.z / clip.w + 1)};
}

TEST(RowShift, MovesEveryPointWhereTheOtherViewSeesIt) {
  const View from = seen_from({-40, 25, 300}), to = seen_from({17, 25, 300});
  const auto shift = row_shift(from, to, kWidth, kHeight);
  ASSERT_TRUE(shift);
  for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), {20, -10, 50}, {-30, 12, -80}, {5, 5, 120}}) {
    const glm::dvec3 a = pixel_of(from, p), b = pixel_of(to, p);
    EXPECT_NEAR(a.x + shift->at(a.z), b.x, 1e-6);
    EXPECT_NEAR(a.y, b.y, 1e-9);
  }
  EXPECT_NEAR(shift->at(pixel_of(from, {7, 7, 0}).z), 0.0, 1e-9) << "nothing moves in the panel's plane";
}

TEST(RowShift, IsForCamerasInOneRowOnly) {
  const View view = seen_from({0, 0, 300});
  EXPECT_TRUE(row_shift(view, seen_from({30, 0, 300}), kWidth, kHeight));
  EXPECT_FALSE(row_shift(view, seen_from({30, 5, 300}), kWidth, kHeight)) << "higher";
  EXPECT_FALSE(row_shift(view, seen_from({30, 0, 320}), kWidth, kHeight)) << "farther away";
  View turned = view;
  turned.view_from_world = glm::rotate(turned.view_from_world, 0.05, {0, 1, 0});
  EXPECT_FALSE(row_shift(view, turned, kWidth, kHeight)) << "turned";
}

TEST(DepthRange, HoldsTheWholeBox) {
  const View view = seen_from({30, 10, 300});
  const DepthRange range = depth_range(view, {{-20, -15, -40}, {20, 15, 30}});
  EXPECT_NEAR(range.nearest, pixel_of(view, {1, 2, 30}).z, 1e-12);
  EXPECT_NEAR(range.farthest, pixel_of(view, {-3, 4, -40}).z, 1e-12);
}

struct Difference {
  double psnr_db = 0.0, share = 0.0;  ///< share of pixels with a channel more than 8 off
};
Difference difference(const Image& a, const Image& b) {
  double squares = 0.0;
  int far = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
    int most = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const int d = a.pixels[c] - b.pixels[c];
      squares += d * d;
      most = std::max(most, std::abs(d));
    }
    far += most > 8;
  }
  const double pixels = static_cast<double>(a.pixels.size()) / 4;
  return {10 * std::log10(255.0 * 255.0 * 3 * pixels / std::max(squares, 1e-9)), far / pixels};
}

class Reproject : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
  }
  /// Layers `drawn` are drawn, the others made from them; exact ones beside.
  void make(const TriMesh& mesh, const Shading& shading, const std::vector<View>& views, const std::vector<int>& drawn,
            bool layered = true) {
    const LodMesh gpu = LodMesh::exact(pack_mesh(mesh).value()).value();
    auto renderer = Renderer::create(layered).value();
    auto reprojector = Reprojector::create().value();
    auto array = ViewArray::create(kWidth, kHeight, static_cast<int>(views.size())).value();
    std::vector<View> keys;
    for (const int layer : drawn) keys.push_back(views[static_cast<std::size_t>(layer)]);
    ASSERT_TRUE(renderer.render_layers(MeshScene(gpu, shading), keys, drawn, array));
    const auto filled = reprojector.fill(array, renderer.layer_depths(), views, drawn, gpu.box_mm());
    ASSERT_TRUE(filled) << filled.error().message;
    made_.clear();
    exact_.clear();
    for (int i = 0; i < array.layers(); ++i) made_.push_back(array.read_layer(i).value());
    std::vector<int> all(views.size());
    for (int i = 0; i < array.layers(); ++i) all[static_cast<std::size_t>(i)] = i;
    ASSERT_TRUE(renderer.render_layers(MeshScene(gpu, shading), views, all, array));
    for (int i = 0; i < array.layers(); ++i) exact_.push_back(array.read_layer(i).value());
  }
  std::unique_ptr<EglContext> context_;
  std::vector<Image> made_, exact_;
};

/// A bowl of hills: no jumps of depth inside, slopes everywhere.
TriMesh hills() {
  TriMesh mesh = testing::sphere(25, 120, 240);
  for (glm::vec3& p : mesh.positions) p *= 1.0f + 0.04f * std::sin(0.7f * p.x) * std::sin(0.6f * p.y);
  mesh.normals.clear();
  return mesh;
}

TEST_F(Reproject, ViewsBetweenAreFarBetterThanCopiesOfTheNearest) {
  // A surface with slopes everywhere: 20 % of the pixels of a copy are wrong, 0.4 % of a reprojected view.
  const std::vector<int> drawn{0, 4, 8, 12};
  make(hills(), Shading(), row_of_views(13), drawn);
  for (const int layer : drawn) EXPECT_EQ(made_[layer].pixels, exact_[layer].pixels) << "drawn ones stay";
  for (int i = 0; i < 13; ++i) {
    if (i % 4 == 0) continue;
    const Difference made = difference(made_[i], exact_[i]), copied = difference(exact_[(i + 1) / 4 * 4], exact_[i]);
    EXPECT_GT(made.psnr_db, std::max(31.0, copied.psnr_db + 4)) << "view " << i;
    EXPECT_LT(made.share, std::min(0.006, copied.share / 20)) << "view " << i;
  }
}

TEST_F(Reproject, EdgesAreNoWorseThanAPixelOff) {
  // Flat faces of one colour with letters: only edges can be wrong.
  Shading letters = shading_preset("phong").value();
  color_partitions(letters.parts, distinct_partition_colors());
  make(testing::lettered_box(), letters, row_of_views(13), {0, 4, 8, 12});
  double made_db = 0.0, copied_db = 0.0;
  for (int i = 0; i < 13; ++i) {
    if (i % 4 == 0) continue;
    const Difference made = difference(made_[i], exact_[i]);
    EXPECT_LT(made.share, 0.012) << "view " << i;
    made_db += made.psnr_db / 9;
    copied_db += difference(exact_[(i + 1) / 4 * 4], exact_[i]).psnr_db / 9;
  }
  EXPECT_GT(made_db, copied_db + 4);
}

TEST_F(Reproject, WhatAppearsBehindAnEdgeComesFromTheOtherSideAndHolesShowWhatIsBehind) {
  // A card far before a wall: each key hides another part of the wall, and a part is hidden from both.
  TriMesh mesh;
  testing::add_rectangle(mesh, {-40, -25, -30}, {80, 0, 0}, {0, 50, 0}, 0);
  testing::add_rectangle(mesh, {-10, -15, 40}, {20, 0, 0}, {0, 30, 0}, 1);
  Shading shading = shading_preset("ao").value();
  color_partitions(shading.parts, {Rgb8{255, 0, 0}, {0, 255, 0}});
  shading.background.color = {0, 0, 0};
  make(mesh, shading, row_of_views(9, 20), {0, 8});
  for (int i = 1; i < 8; ++i) {
    const Difference off = difference(made_[i], exact_[i]);
    EXPECT_LT(off.share, 0.012) << "edges may be a pixel off, view " << i;
    int neither = 0;
    for (int y = 30; y < kHeight - 30; ++y)
      for (int x = kWidth / 2 - 40; x < kWidth / 2 + 40; ++x)
        neither += made_[i].at(x, y)[0] + made_[i].at(x, y)[1] < 100;
    EXPECT_EQ(neither, 0) << "no holes down to the background, view " << i;
  }
}

TEST_F(Reproject, WithoutLayersInVertexShadersThePicturesAreTheSame) {
  make(hills(), Shading(), row_of_views(7), {0, 3, 6});
  const std::vector<Image> layered = made_;
  make(hills(), Shading(), row_of_views(7), {0, 3, 6}, false);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_LT(difference(made_[i], layered[i]).share, 0.001) << i;
}

TEST_F(Reproject, EyesThatDoNotStandInARowAreDrawn) {
  std::vector<View> views = row_of_views(12);
  views[5] = seen_from({3, 40, 300});
  const PackedMesh mesh = pack_mesh(hills()).value();
  const LodMesh gpu = LodMesh::exact(mesh).value();
  const MeshScene scene(gpu, Shading());
  auto multi = MultiView::create({.cell_px = 0, .key_views = 3}).value();
  auto array = ViewArray::create(kWidth, kHeight, 12).value(), exact = ViewArray::create(kWidth, kHeight, 12).value();
  ASSERT_TRUE(multi.draw_moving(scene, views, array));
  auto renderer = Renderer::create().value();
  ASSERT_TRUE(renderer.render(scene, views, 1, exact));
  for (int i = 0; i < 12; ++i)
    EXPECT_LT(difference(array.read_layer(i).value(), exact.read_layer(i).value()).share, 0.001) << i;
}

}  // namespace
}  // namespace dubsar
