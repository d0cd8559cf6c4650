// The files of a session without a window: what is read when.

#include "app/session/shelf.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/core/volume/temp_folder.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

class ShelfTest : public testing_tools::TempFolder {
 protected:
  ShelfTest() { write_bytes(file_, "a"); }
  /// Tells something coarse, then reads the rest.
  Shelf shelf() {
    return Shelf(
        [this](const fs::path&, Progress& progress, const TellCoarse& tell) -> Result<OpenedSurface> {
          TriMesh coarse;
          coarse.triangles.resize(1);
          tell(std::move(coarse));
          if (progress.cancelled()) return cancelled_error();
          rest_ = true;
          OpenedSurface out;
          out.mesh.triangles.resize(2);
          return out;
        },
        {});
  }
  static std::optional<TriMesh> coarse_of(Shelf& shelf) {
    for (int i = 0; i < 1000; ++i) {
      if (auto coarse = shelf.take_coarse()) return coarse;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::nullopt;
  }

  const fs::path file_ = in("a.exa");
  std::atomic<bool> rest_ = false;
};

TEST_F(ShelfTest, TheRestIsReadWhenTheCoarseSurfaceWasShown) {
  Shelf shelf = this->shelf();
  ASSERT_TRUE(shelf.open({file_}));
  shelf.start();
  const auto coarse = coarse_of(shelf);
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->triangles.size(), 1u);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(rest_) << "it takes the processor from the first picture";
  shelf.coarse_was_shown();
  shelf.wait();
  const auto read = shelf.take();
  ASSERT_TRUE(read && *read);
  EXPECT_EQ((*read)->mesh.triangles.size(), 2u);
}

TEST_F(ShelfTest, WhereNobodyLooksNothingWaits) {
  const auto begun = std::chrono::steady_clock::now();
  Shelf shelf = this->shelf();
  ASSERT_TRUE(shelf.open({file_}));
  shelf.wait();
  ASSERT_TRUE(shelf.take());
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(2));
}

TEST_F(ShelfTest, ReadingIsStoppedWhileItWaitsToBeSeen) {
  const auto begun = std::chrono::steady_clock::now();
  {
    Shelf shelf = this->shelf();
    ASSERT_TRUE(shelf.open({file_}));
    shelf.start();
    ASSERT_TRUE(coarse_of(shelf));
    EXPECT_TRUE(shelf.stop());
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(2));
  EXPECT_FALSE(rest_);
}

}  // namespace
}  // namespace dubsar::app
