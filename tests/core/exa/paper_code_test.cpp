#include "core/exa/exa_text.h"
#include "core/exa/signs/topology.h"
#include "core/extract/extract.h"
#include "tests/bench/paper/paper_profile.h"
#include "tests/bench/paper/paper_signs.h"
#include "tests/bench/paper/paper_words.h"
#include "tests/core/exa/chunk_views.h"
#include "tests/core/exa/exa_test_models.h"
#include "tests/core/exa/sign_volume.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

const Dims kShapes[] = {{1, 1, 1},    {2, 1, 1},    {1, 33, 70},  {64, 64, 1},   {65, 1, 65},
                        {3, 3, 3},    {31, 33, 32}, {5, 3, 9},    {32, 32, 32},  {33, 33, 33},
                        {34, 63, 65}, {129, 5, 2},  {70, 40, 97}, {128, 64, 20}, {257, 9, 130}};

TEST(PaperCode, TheSignCodeIsLosslessOnEveryLevelForAnyVolume) {
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

TEST(PaperCode, SpheresTakeWhatThePaperPrints) {
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

TEST(PaperCode, WordsHoldAnyNumbersAndWasteNoneOnSmallOnes) {
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

TEST_F(ExaFile, AllThatThePapersCodeHoldsOfASurfaceComesBackToTheLastBit) {
  unsigned seed = 100;
  for (const Dims& dims : {Dims{1, 1, 1}, Dims{30, 1, 17}, Dims{33, 20, 41}, Dims{65, 3, 2}})
    for (const Kind kind : {Kind::kNoise, Kind::kBlob, Kind::kEmpty, Kind::kFull}) {
      ++seed;
      SurfaceModel model = sample_model(dims, kind, seed, seed % 2 == 0, 1 + static_cast<int>(seed % 16));
      ASSERT_TRUE(settle_for_paper(model, {}, progress_));
      const QuadMesh base = build_quad_mesh(model.samples, progress_).value();

      const auto places = encode_paper_positions(base.positions, model.mesh.positions, progress_);
      ASSERT_TRUE(places);
      std::vector<glm::vec3> positions = base.positions;
      ASSERT_TRUE(decode_paper_positions(views_of(*places), positions, progress_));
      EXPECT_TRUE(same_bytes(positions, model.mesh.positions));

      const auto steps = encode_paper_normals(model.attributes.normals, progress_);
      ASSERT_TRUE(steps);
      const auto normals = decode_paper_normals(views_of(*steps), model.attributes.normals.size(), progress_);
      ASSERT_TRUE(normals);
      EXPECT_TRUE(same_bytes(*normals, model.attributes.normals));

      const int bits = model.samples.offset_bits;
      std::vector<std::uint16_t> offsets(model.samples.offsets.size());
      const auto chunks = encode_paper_bits(model.samples.offsets, bits, progress_);
      ASSERT_TRUE(decode_paper_bits(views_of(chunks), bits, "offsets", offsets));
      EXPECT_EQ(offsets, model.samples.offsets);

      const PaperWords words = encode_paper_words(model, true, progress_);
      SurfaceModel back;
      back.mesh = model.mesh;
      if (!words.words.empty()) {
        ASSERT_TRUE(decode_paper_words(views_of(words.words), views_of(words.exceptions), back));
      }
      EXPECT_EQ(back.attributes.shape, model.attributes.shape);
      EXPECT_EQ(back.attributes.ao, model.attributes.ao);
      EXPECT_EQ(back.quad_partition, model.quad_partition);
    }
}

TEST_F(ExaFile, SettlingForThePapersCodeTwiceIsTheSameAsOnce) {
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
}

TEST_F(ExaFile, FilesThatAreCodedAsInThePaperAreRefusedWithWhatToDo) {
  const auto read = parse_exa_header(R"({"profile":"paper","dims":[3,3,3]})", 1000);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(read.error().message, HasSubstr("process the scan again"));
}

}  // namespace
}  // namespace dubsar
