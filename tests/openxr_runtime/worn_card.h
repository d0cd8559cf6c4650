#pragma once
// A card before the wearer of the made headset, drawn through the display `openxr`.

#include <chrono>
#include <memory>
#include <string>

#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/renderer.h"
#include "display/render/view_array.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/openxr.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"
#include "tests/openxr_runtime/worn_test.h"

namespace dubsar::testing {

class WornCard : public WornTest {
 protected:
  static constexpr Screen kWindow{.window_w = 320, .window_h = 200};
  void SetUp() override {
    WornTest::SetUp();
    if (HasFatalFailure()) return;
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
  }
  void TearDown() override {
    scene_.reset();
    sink_.reset();
    WornTest::TearDown();
  }

  void open(const std::string& spec = "openxr") {
    auto sink = SinkCatalog().make(spec);
    ASSERT_TRUE(sink) << sink.error().message;
    sink_ = std::move(*sink);
    ASSERT_TRUE(sink_->configure(kWindow));
    sink_->views(Observer());  // the nominal cameras
    TriMesh card;              // 30 mm square, upright, its middle at the origin
    add_rectangle(card, {-15, -15, 0}, {30, 0, 0}, {0, 30, 0}, 0);
    scene_ = std::make_unique<Scene>(card);
  }
  /// One picture: cameras, rendering, compose. True when somebody was there to see it.
  bool picture() {
    if (sink_->outdated()) {
      EXPECT_TRUE(sink_->configure(kWindow));
      sink_->views(Observer());
    }
    const std::span<const View> views = sink_->views(Observer());
    EXPECT_TRUE(scene_->renderer.render(scene_->scene, views, 1, scene_->array));
    const auto done = sink_->compose(scene_->array, scene_->mirror.surface());
    EXPECT_TRUE(done) << done.error().message;
    return sink_->wearer().has_value();
  }
  void pictures_until_worn() {
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20); !picture();)
      ASSERT_LT(std::chrono::steady_clock::now(), end) << sink_->note();
  }

  struct Scene {
    explicit Scene(const TriMesh& card)
        : mesh(LodMesh::exact(pack_mesh(card).value()).value()),
          shading([] {
            Shading out = shading_preset("ao").value();
            out.style.base_color = {255, 255, 255};
            out.background.color = {0, 0, 0};
            return out;
          }()),
          scene(mesh, shading, glm::dmat4(1.0)),
          renderer(Renderer::create().value()),
          array(ViewArray::create(kMadeEyePx, kMadeEyePx, 2).value()),
          mirror(OffscreenSurface::create({320, 200}).value()) {}
    LodMesh mesh;
    Shading shading;
    MeshScene scene;
    Renderer renderer;
    ViewArray array;
    OffscreenSurface mirror;
  };
  std::unique_ptr<EglContext> context_;
  std::unique_ptr<OutputSink> sink_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace dubsar::testing
