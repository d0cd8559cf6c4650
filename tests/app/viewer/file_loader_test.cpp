// The files of a session without a window: what is read when.

#include "app/session/file_loader.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/core/volume/temp_folder.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

class FileLoaderTest : public testing_tools::TempFolder {
 protected:
  FileLoaderTest() { write_bytes(file_, "a"); }
  /// Tells something coarse, then reads the rest.
  FileLoader loader() {
    return FileLoader(
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
  static std::optional<TriMesh> coarse_of(FileLoader& loader) {
    for (int i = 0; i < 1000; ++i) {
      if (auto coarse = loader.take_coarse()) return coarse;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::nullopt;
  }

  const fs::path file_ = in("a.exa");
  std::atomic<bool> rest_ = false;
};

TEST_F(FileLoaderTest, TheRestIsReadWhenTheCoarseSurfaceWasShown) {
  FileLoader loader = this->loader();
  ASSERT_TRUE(loader.open({file_}));
  loader.start();
  const auto coarse = coarse_of(loader);
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->triangles.size(), 1u);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(rest_) << "it takes the processor from the first picture";
  loader.coarse_was_shown();
  loader.wait();
  const auto read = loader.take();
  ASSERT_TRUE(read && *read);
  EXPECT_EQ((*read)->mesh.triangles.size(), 2u);
}

TEST_F(FileLoaderTest, WhereNobodyLooksNothingWaits) {
  const auto begun = std::chrono::steady_clock::now();
  FileLoader loader = this->loader();
  ASSERT_TRUE(loader.open({file_}));
  loader.wait();
  ASSERT_TRUE(loader.take());
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(2));
}

TEST_F(FileLoaderTest, ReadingIsStoppedWhileItWaitsToBeSeen) {
  const auto begun = std::chrono::steady_clock::now();
  {
    FileLoader loader = this->loader();
    ASSERT_TRUE(loader.open({file_}));
    loader.start();
    ASSERT_TRUE(coarse_of(loader));
    EXPECT_TRUE(loader.stop());
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(2));
  EXPECT_FALSE(rest_);
}

}  // namespace
}  // namespace dubsar::app
