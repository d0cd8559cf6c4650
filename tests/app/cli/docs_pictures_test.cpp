// The pictures of sessions in docs/ are what the program shows today: made anew and compared.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/image_io/picture_file.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

constexpr int kCell = 8;  // pixels: other drivers and fonts move edges by less

/// Means of cells of kCell x kCell pixels, all channels.
std::vector<double> cells(const Image& image) {
  std::vector<double> out;
  for (int top = 0; top + kCell <= image.height; top += kCell)
    for (int left = 0; left + kCell <= image.width; left += kCell)
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (int y = 0; y < kCell; ++y)
          for (int x = 0; x < kCell; ++x) sum += image.at(left + x, top + y)[c];
        out.push_back(sum / (kCell * kCell));
      }
  return out;
}

TEST(DocsPictures, AreWhatTheProgramShowsToday) {
  const fs::path docs = fs::path(DUBSAR_SOURCE_DIR) / "docs";
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_docs_{}", ::getpid());
  fs::create_directories(folder);
  const std::string command =
      fmt::format("'{}' '{}' '{}'", (docs / "scripts/make_pictures.sh").string(), DUBSAR_PROGRAM, folder.string());
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  for (const char* name : {"reading.png", "film.png"}) {
    const auto kept = read_picture(docs / name), fresh = read_picture(folder / name);
    ASSERT_TRUE(kept && fresh) << name;
    ASSERT_EQ(kept->width, fresh->width) << name;
    ASSERT_EQ(kept->height, fresh->height) << name;
    const std::vector<double> a = cells(*kept), b = cells(*fresh);
    double sum = 0.0, varies = 0.0, mean = 0.0;
    int far = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += std::abs(a[i] - b[i]);
      far += std::abs(a[i] - b[i]) > 40.0 ? 1 : 0;
      mean += b[i] / static_cast<double>(b.size());
    }
    for (const double v : b) varies += (v - mean) * (v - mean) / static_cast<double>(b.size());
    EXPECT_LT(sum / static_cast<double>(a.size()), 4.0) << name << " has changed; ./do pictures makes it anew";
    EXPECT_LT(far, static_cast<int>(a.size()) / 50) << name << " has changed; ./do pictures makes it anew";
    EXPECT_GT(std::sqrt(varies), 20.0) << name << " shows nothing";
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dubsar::test
