#include "core/exa/paper/paper_profile.h"

#include "core/exa/paper/paper_signs.h"
#include "core/exa/paper/paper_words.h"
#include "core/exa/signs/topology.h"
#include "tests/core/exa/exa_test_models.h"
#include "tests/core/exa/sign_volume.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

std::vector<std::string_view> views_of(const std::vector<std::string>& chunks) {
  return {chunks.begin(), chunks.end()};
}

const Dims kShapes[] = {{1, 1, 1},    {2, 1, 1},    {1, 33, 70},  {64, 64, 1},   {65, 1, 65},
                        {3, 3, 3},    {31, 33, 32}, {5, 3, 9},    {32, 32, 32},  {33, 33, 33},
                        {34, 63, 65}, {129, 5, 2},  {70, 40, 97}, {128, 64, 20}, {257, 9, 130}};

TEST(ExaPaper, TheSignCodeIsLosslessOnEveryLevelForAnyVolume) {
  std::mt19937 random(12);
  for (const Dims& dims : kShapes)
    for (const unsigned density : {0u, 2u, 500u, 1000u}) {
      const BitVolume signs = volume(dims, [&](auto, auto, auto) { return random() % 1000 < density; });
      const std::vector<std::string> code = encode_signs_as_paper(signs);
      for (int level = 0; level <= 3; ++level) {
        const auto back = decode_signs_as_paper(views_of(code), dims, level);
        ASSERT_TRUE(back) << back.error().message;
        ASSERT_EQ(back->dims(), level_dims(dims, level));
        for (std::int64_t z = 0; z < back->dims().z; ++z)
          for (std::int64_t y = 0; y < back->dims().y; ++y)
            for (std::int64_t x = 0; x < back->dims().x; ++x)
              ASSERT_EQ(back->get(x, y, z), signs.get(x << level, y << level, z << level)) << level;
      }
    }
}

TEST(ExaPaper, SpheresTakeWhatThePaperPrints) {
  // Table 1: .869 bits a vertex of 248,426.
  const double c = 127.5;
  const BitVolume signs = volume({256, 256, 256}, [&](auto x, auto y, auto z) {
    return std::hypot(double(x) - c, double(y) - c, double(z) - c) <= 0.9 * c;
  });
  const std::vector<std::string> code = encode_signs_as_paper(signs);
  std::size_t bytes = 0;
  for (const std::string& chunk : code) bytes += chunk.size();
  EXPECT_NEAR(8.0 * static_cast<double>(bytes) / 248426.0, 0.87, 0.01);
  EXPECT_TRUE(decode_signs_as_paper(views_of(code), signs.dims()).value() == signs);
  std::vector<std::string_view> cut = views_of(code);
  cut.back() = cut.back().substr(0, 100);
  EXPECT_THAT(decode_signs_as_paper(cut, signs.dims()).error().message, HasSubstr("cut off"));
  cut.pop_back();
  EXPECT_THAT(decode_signs_as_paper(cut, signs.dims()).error().message, HasSubstr("6 chunks of octets found, 7"));
}

TEST(ExaPaper, WordsHoldAnyNumbersAndWasteNoneOnSmallOnes) {
  std::mt19937 random(4);
  for (const PaperWord word : {PaperWord::k64, PaperWord::k128})
    for (int round = 0; round < 60; ++round) {
      std::vector<std::uint32_t> numbers(random() % 700);
      for (std::uint32_t& n : numbers) n = static_cast<std::uint32_t>(random() >> (random() % 3 * 10 + random() % 12));
      if (round % 3 == 0)
        for (std::uint32_t& n : numbers) n %= 2 + static_cast<std::uint32_t>(round);
      const std::string bytes = pack_words(numbers, word);
      const auto back = unpack_words(bytes, numbers.size(), word, "numbers");
      ASSERT_TRUE(back) << back.error().message;
      ASSERT_EQ(*back, numbers);
      EXPECT_FALSE(unpack_words(bytes + std::string(16, '\0'), numbers.size(), word, "numbers"));
      if (!bytes.empty()) {
        EXPECT_FALSE(unpack_words(std::string_view(bytes).substr(1), numbers.size(), word, "numbers"));
      }
    }
  EXPECT_EQ(pack_words(std::vector<std::uint32_t>(240, 0), PaperWord::k64).size(), 8u);
  EXPECT_EQ(pack_words(std::vector<std::uint32_t>(20, 7), PaperWord::k64).size(), 8u) << "20 codes of 3 bits";
  EXPECT_EQ(pack_words(std::vector<std::uint32_t>(12, 1023), PaperWord::k128).size(), 16u) << "12 codes of 10 bits";
  for (const std::int32_t v : {0, 1, -1, 77, -12345, 2147483647, -2147483647 - 1}) EXPECT_EQ(unfolded(folded(v)), v);
}

TEST_F(ExaFile, ModelsInThePapersProfileComeBackToTheLastBit) {
  unsigned seed = 100;
  for (const Dims& dims : {Dims{1, 1, 1}, Dims{30, 1, 17}, Dims{33, 20, 41}, Dims{65, 3, 2}})
    for (const Kind kind : {Kind::kNoise, Kind::kBlob, Kind::kEmpty, Kind::kFull})
      for (const bool settled : {false, true}) {
        ++seed;
        SurfaceModel model = sample_model(dims, kind, seed, seed % 2 == 0, 1 + static_cast<int>(seed % 16));
        if (settled) {
          ASSERT_TRUE(settle_for_paper(model, {}, progress_));
        }
        const auto path = folder_ / "a.exa";
        ASSERT_TRUE(write_exa(path, model, progress_, ExaProfile::kPaper));
        const auto read = read_exa(path, progress_);
        ASSERT_TRUE(read) << read.error().message;
        expect_equal(model, *read);
        EXPECT_EQ(read_exa_info(path)->header.profile, ExaProfile::kPaper);
        EXPECT_EQ(file_of(encoded(*read, ExaProfile::kPaper)), file_of(encoded(model, ExaProfile::kPaper)));
      }
}

TEST_F(ExaFile, SettlingForThePapersProfileTwiceIsTheSameAsOnce) {
  SurfaceModel model = sample_model({30, 28, 26}, Kind::kBlob, 8);
  const SurfaceModel before = model;
  const auto stats = settle_for_paper(model, {}, progress_);
  ASSERT_TRUE(stats);
  EXPECT_LT(stats->max_error_vox, 0.5 * kPaperStep * std::sqrt(3.0) + 1e-5);
  EXPECT_GT(stats->mean_error_vox, 0.0);
  EXPECT_LT(stats->normal_error_deg, 0.5);
  EXPECT_EQ(model.samples.offsets, before.samples.offsets);
  const SurfaceModel once = model;
  const auto again = settle_for_paper(model, {}, progress_);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->max_error_vox, 0.0);
  expect_equal(model, once);
  const auto blocks = read_exa_info([&] {
                        write_exa(folder_ / "a.exa", model, progress_, ExaProfile::kPaper).value();
                        return folder_ / "a.exa";
                      }())
                          ->stats.blocks;
  const auto has = [&](const char* name) {
    return std::any_of(blocks.begin(), blocks.end(), [&](const ExaBlockStats& b) { return b.name == name; });
  };
  for (const char* name : {"paper_octets", "paper_offsets", "paper_places", "paper_normals", "paper_words"})
    EXPECT_TRUE(has(name)) << name;
  for (const char* name : {"positions", "normals", "curvatures", "shape", "ao", "signs_8"})
    EXPECT_FALSE(has(name)) << name;
}

TEST_F(ExaFile, LevelsOfThePapersProfileAreThoseOfTheCompactOneAndBoxesAreRefused) {
  const SurfaceModel model = sample_model({50, 41, 37}, Kind::kBlob, 9);
  const auto compact = folder_ / "compact.exa", paper = folder_ / "paper.exa";
  ASSERT_TRUE(write_exa(compact, model, progress_));
  ASSERT_TRUE(write_exa(paper, model, progress_, ExaProfile::kPaper));
  for (int level = 1; level <= 3; ++level) {
    const auto a = read_exa_level(compact, level, progress_), b = read_exa_level(paper, level, progress_);
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(same_bytes(a->mesh.positions, b->mesh.positions));
    EXPECT_EQ(a->mesh.quads, b->mesh.quads);
  }
  const auto box = read_exa_box(paper, {{1, 1, 1}, {9, 9, 9}}, progress_);
  ASSERT_FALSE(box);
  EXPECT_EQ(box.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(box.error().message, HasSubstr("recompress"));
}

TEST_F(ExaFile, DamageOfThePapersProfileIsRefusedOrGivesTheSameMesh) {
  SurfaceModel model = sample_model({14, 9, 10}, Kind::kBlob, 6);
  ASSERT_TRUE(settle_for_paper(model, {}, progress_));
  const std::vector<ExaBlock> blocks = encoded(model, ExaProfile::kPaper);
  std::mt19937 random(2);
  int refused = 0;
  for (int round = 0; round < 800; ++round) {
    std::vector<ExaBlock> damaged = blocks;
    if (!damage_a_chunk(damaged, round, random)) continue;
    const auto read = decode_exa(file_of(damaged), progress_);
    if (!read) {
      ASSERT_TRUE(read.error().kind == ErrorKind::kBadData || read.error().kind == ErrorKind::kTryAgain)
          << read.error().message;
      ++refused;
      continue;
    }
    ASSERT_EQ(read->mesh.quads, model.mesh.quads);
    ASSERT_TRUE(same_bytes(read->mesh.positions, model.mesh.positions));
  }
  EXPECT_GT(refused, 350);
}

}  // namespace
}  // namespace dubsar
