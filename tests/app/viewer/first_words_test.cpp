// What stands on the desk when a surface is opened: how it is turned, and what is said of it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/first_document.h"
#include "app/viewer/view_options.h"

namespace dubsar::app {
namespace {
using ::testing::HasSubstr;

/// A closed box, on which nobody wrote.
TriMesh blank() {
  TriMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back(20.0f * static_cast<float>(k & 1), 30.0f * static_cast<float>(k >> 1 & 1),
                                9.0f * static_cast<float>(k >> 2));
  for (const std::array<std::uint32_t, 4>& f : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                                                {4, 5, 7, 6},
                                                {0, 1, 5, 4},
                                                {2, 6, 7, 3},
                                                {0, 4, 6, 2},
                                                {1, 3, 7, 5}}) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

TEST(FirstDocument, SaysWhereTheWayUpIsNotSureAndWhichKeyTurnsIt) {
  ViewOptions options;
  EXPECT_EQ(first_document(options, blank()).doubt, "") << "it is shown as it was scanned";
  options.work.upright = true;
  options.work.doubt = first_document(options, blank()).doubt;
  EXPECT_THAT(first_words(options.work, false), HasSubstr("No writing was found that says which way is up"));
  for (const char* key : {"Shift+Home", "Ctrl+Shift+Home", "Ctrl+Home"})
    EXPECT_THAT(first_words(options.work, false), HasSubstr(key));
  options.work.restored = true;
  EXPECT_THAT(first_words(options.work, false), ::testing::Not(HasSubstr("Home"))) << "somebody has turned it already";
  EXPECT_THAT(first_words(SessionWork(), false), HasSubstr("Drag to turn"));
  EXPECT_THAT(first_words(SessionWork(), true), HasSubstr("close your hand")) << "who wears a headset sees no keys";
}

}  // namespace
}  // namespace dubsar::app
