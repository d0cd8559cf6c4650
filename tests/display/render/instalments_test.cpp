// Exact pictures that are drawn in pieces, and meshes that come piece by piece: the same bytes as in one go.

#include "display/render/passes/instalments.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <string>

#include "display/optics/off_axis.h"
#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/multi_view.h"
#include "tests/display/render/grown_mesh.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr TimestampNs kOver = 0;  // an end that is past: each instalment is as short as can be
constexpr int kMostInstalments = 1000;

class InstalmentsGl : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
    PackedMesh mesh = pack_mesh(testing::sphere(25, 150, 300)).value();
    sort_into_chunks(mesh);
    mesh_ = std::make_unique<LodMesh>(testing::grown_mesh(std::move(mesh)));
  }
  static View view(double aside_mm) {
    const Screen screen{
        .width_mm = 90, .height_mm = 60, .width_px = 90, .height_px = 60, .window_w = 90, .window_h = 60};
    return viewer_view(screen.window_rect(), Observer(), {aside_mm, 0, 300});
  }
  std::unique_ptr<EglContext> context_;
  std::unique_ptr<LodMesh> mesh_;
};

TEST_F(InstalmentsGl, APictureInPiecesIsThatOfOneGoWhateverElseIsDrawnInBetween) {
  auto renderer = Renderer::create().value();
  const View wanted = view(0), other = view(80);
  for (const std::string look : {"relief", "raking", "transparent", "cut"}) {
    Shading shading = shading_preset(look == "raking" ? "raking" : "relief").value();
    if (look == "transparent") shading.parts[0].opacity = 0.4;
    if (look == "cut") shading.clips = {{{1, 0, 0}, {4, 0, 0}}};
    const MeshScene scene(*mesh_, shading);
    auto whole = ViewArray::create(90, 60, 1).value(), pieces = ViewArray::create(90, 60, 3).value(),
         small = ViewArray::create(7, 5, 1).value();
    ASSERT_TRUE(renderer.render(scene, std::span(&wanted, 1), 2, whole));
    const int layer = 0;
    ASSERT_TRUE(renderer.render_layers(scene, std::span(&wanted, 1), std::span(&layer, 1), pieces, 12.0));
    const auto coarse = pieces.read_layer(0).value().pixels;
    renderer.restart_pieces();
    int instalments = 1;
    while (!renderer.render_some(scene, wanted, 2, pieces, 0, kOver).value() && instalments < kMostInstalments) {
      ++instalments;
      ASSERT_EQ(pieces.read_layer(0).value().pixels, coarse) << look << ": nothing half done is to be seen";
      ASSERT_TRUE(renderer.render(scene, std::span(&other, 1), 1, small));
      ASSERT_TRUE(renderer.render_layers(scene, std::span(&other, 1), std::span(&layer, 1), small, 3.0));
    }
    EXPECT_EQ(pieces.read_layer(0).value().pixels, whole.read_layer(0).value().pixels) << look;
    EXPECT_GT(instalments, 10) << look;
    EXPECT_LT(instalments, kMostInstalments) << look;
  }
}

TEST_F(InstalmentsGl, WhatMovesInBetweenBeginsThePictureAnew) {
  auto multi = MultiView::create({.cell_px = 4}).value();
  auto renderer = Renderer::create().value();
  const Shading shading = shading_preset("raking").value();
  const MeshScene scene(*mesh_, shading);
  const View before = view(60), after = view(-60);
  auto array = ViewArray::create(90, 60, 1).value(), exact = ViewArray::create(90, 60, 1).value();
  ASSERT_TRUE(multi.draw_moving(scene, std::span(&before, 1), array));
  for (int i = 0; i < 9; ++i)
    ASSERT_EQ(multi.refine_until(kOver, scene, std::span(&before, 1), 2, array).value(), 1) << "after " << i;
  ASSERT_TRUE(multi.draw_moving(scene, std::span(&after, 1), array));
  int left = 1;
  for (int i = 0; left > 0 && i < kMostInstalments; ++i)
    left = multi.refine_until(kOver, scene, std::span(&after, 1), 2, array).value();
  ASSERT_TRUE(renderer.render(scene, std::span(&after, 1), 2, exact));
  EXPECT_EQ(array.read_layer(0).value().pixels, exact.read_layer(0).value().pixels);
}

TEST_F(InstalmentsGl, AMeshThatComesPieceByPieceIsTheSame) {
  TriMesh source = testing::sphere(25, 30, 60);
  for (std::size_t i = 0; i < source.positions.size(); ++i)
    source.colors.push_back({static_cast<std::uint8_t>(i % 251), static_cast<std::uint8_t>(i % 13 * 19), 90});
  PackedMesh mesh = pack_mesh(source).value();
  const std::size_t bytes = mesh.vertices.size() * (sizeof(PackedVertex) + 4) + mesh.triangles.size() * 12;
  const auto read = [](const GpuMesh& gpu) {  // all three buffers
    std::vector<std::byte> out;
    const auto add = [&](GLint name) {
      GLint64 size = 0;
      glGetNamedBufferParameteri64v(static_cast<GLuint>(name), GL_BUFFER_SIZE, &size);
      const std::size_t at = out.size();
      out.resize(at + static_cast<std::size_t>(size));
      glGetNamedBufferSubData(static_cast<GLuint>(name), 0, size, out.data() + at);
    };
    GLint name = 0;
    glGetVertexArrayiv(gpu.vertex_array(), GL_ELEMENT_ARRAY_BUFFER_BINDING, &name);
    add(name);
    glBindVertexArray(gpu.vertex_array());
    for (const GLuint attribute : {0u, 3u}) {
      glGetVertexAttribiv(attribute, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &name);
      add(name);
    }
    glBindVertexArray(0);
    return out;
  };
  const GpuMesh whole = GpuMesh::upload(mesh).value();
  GpuMesh pieces = GpuMesh::reserve(mesh).value();
  constexpr std::size_t kPiece = 1003;
  std::size_t calls = 1;
  while (!pieces.upload_some(mesh, kPiece).value() && calls < bytes) ++calls;
  EXPECT_EQ(read(whole).size(), bytes);
  EXPECT_EQ(calls, (bytes + kPiece - 1) / kPiece);
  EXPECT_TRUE(read(pieces) == read(whole));
}

}  // namespace
}  // namespace dubsar
