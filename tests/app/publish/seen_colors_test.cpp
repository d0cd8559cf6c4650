#include "app/publish/seen_colors.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {

/// Two triangles: a measured one, and a patch that shares an edge with it.
TriMesh two_triangles() {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  mesh.triangle_inferred = {0, 1};
  mesh.shape = {0, 9, 40, 100};
  mesh.ao = {63, 20, 0, 63};
  return mesh;
}

TEST(SeenColours, AreThoseOfTheTableThatPicturesAreDrawnWith) {
  for (const std::string_view name : shading_preset_names()) {
    const Style style = shading_preset(name)->style;
    const auto table = color_table(style);
    TriMesh mesh = two_triangles();
    color_as_seen(mesh, style);
    for (std::size_t v = 0; v < 3; ++v)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(mesh.colors[v][c], table[mesh.ao[v] * std::size_t{128} + mesh.shape[v]][c]) << name << " " << v;
    EXPECT_EQ(mesh.colors[3], style.mark_inferred ? style.hatch.whole() : mesh.colors[3]) << name;
  }
}

TEST(SeenColours, AMeshWithoutShapesKeepsItsOwnColours) {
  TriMesh mesh = two_triangles();
  mesh.shape.clear();
  mesh.ao.clear();
  mesh.triangle_inferred.clear();
  mesh.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {10, 20, 30}};
  Style white;
  white.map = ColorMap::kPlain;
  white.base_color = {255, 255, 255};
  const auto before = mesh.colors;
  color_as_seen(mesh, white);
  EXPECT_EQ(mesh.colors, before);
}

TEST(CoincidentTriangles, ArePatchesThatTwoPartsShare) {
  TriMesh mesh = two_triangles();
  EXPECT_EQ(coincident_triangles(mesh), 0);
  mesh.positions.insert(mesh.positions.end(), {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  mesh.triangles.push_back({4, 6, 5});  // the patch again, turned the other way, with vertices of its own
  mesh.triangle_inferred.push_back(1);
  EXPECT_EQ(coincident_triangles(mesh), 2);
}

}  // namespace
}  // namespace dubsar::app
