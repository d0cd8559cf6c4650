#include <ctime>

#include "core/base/files/atomic_file.h"
#include "core/exa/offsets/settle.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

TEST_F(ExaFile, EveryTruncationBitFlipAndExtraByteIsRefused) {
  SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  const std::string whole = file_of(encoded(model));
  ASSERT_TRUE(decode_exa(whole, progress_));
  const auto refused = [&](const std::string& bytes) {
    const auto read = decode_exa(bytes, progress_);
    return !read && read.error().kind == ErrorKind::kBadData && read.error().message.size() > 20;
  };
  for (std::size_t length = 0; length < whole.size(); ++length) ASSERT_TRUE(refused(whole.substr(0, length))) << length;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string flipped = whole;
    flipped[at] ^= static_cast<char>(1u << at % 8);
    if (at == 10 || at == 11) continue;  // the minor version is covered by the checksum below
    ASSERT_TRUE(refused(flipped)) << at;
  }
  std::string minor = whole;
  minor[10] ^= 1;
  EXPECT_TRUE(refused(minor));
  EXPECT_TRUE(refused(whole + '\0'));
  EXPECT_TRUE(refused("x" + whole));
  EXPECT_THAT(decode_exa("", progress_).error().message, HasSubstr("the file is empty"));
}

TEST_F(ExaFile, LaterVersionsAreRefusedOrSkippedAsTheirNumberSays) {
  SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  std::vector<ExaBlock> blocks = encoded(model);
  EXPECT_THAT(decode_exa(file_of(blocks, 8), progress_).error().message,
              HasSubstr("format version 8 found, expected 3 to 7; it needs a later dubsar"));
  EXPECT_THAT(decode_exa(file_of(blocks, 2), progress_).error().message, HasSubstr("process the scan again"));
  blocks.push_back({"NEW1", 99, 0, 1, join_chunks(std::vector<std::string>{"whatever"})});
  const auto later = decode_exa(file_of(blocks, kExaMajor, 7), progress_);
  ASSERT_TRUE(later) << later.error().message;
  expect_equal(model, *later);
  blocks.back().flags = kExaRequired;
  EXPECT_THAT(decode_exa(file_of(blocks), progress_).error().message, HasSubstr("\"NEW1\" is needed and not known"));
  blocks.pop_back();
  blocks.push_back(blocks[2]);
  EXPECT_THAT(decode_exa(file_of(blocks), progress_).error().message, HasSubstr("two blocks"));
  blocks.pop_back();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    std::vector<ExaBlock> other = blocks;
    other[b].codec = 77;
    const auto read = decode_exa(file_of(other), progress_);
    if (!read)
      EXPECT_THAT(read.error().message, HasSubstr("codec 77"));
    else
      EXPECT_EQ(blocks[b].type, "none of the blocks may ignore its codec");
    if (!(blocks[b].flags & kExaRequired) || blocks[b].type == "POSN" || blocks[b].type == "ESCP") continue;
    other = blocks;
    other.erase(other.begin() + static_cast<std::ptrdiff_t>(b));
    EXPECT_THAT(decode_exa(file_of(other), progress_).error().message, HasSubstr("is missing"));
  }
}

TEST_F(ExaFile, DamageBehindRepairedSumsNeverCrashes) {
  for (const bool settled : {false, true}) {
    SurfaceModel model = sample_model({14, 9, 10}, Kind::kNoise, 6);
    if (settled) {
      ASSERT_TRUE(settle_for_exa(model, {}, progress_));
    }
    const std::vector<ExaBlock> blocks = encoded(model);
    std::mt19937 random(1);
    int accepted = 0;
    for (int round = 0; round < 500; ++round) {
      std::vector<ExaBlock> damaged = blocks;
      if (!damage_a_chunk(damaged, round, random)) continue;
      const auto read = decode_exa(file_of(damaged), progress_);
      if (!read) {
        ASSERT_TRUE(read.error().kind == ErrorKind::kBadData || read.error().kind == ErrorKind::kTryAgain)
            << read.error().message;
        continue;
      }
      ++accepted;  // a flipped attribute or text: a valid file all the same
      ASSERT_EQ(read->mesh.quads, model.mesh.quads);
      ASSERT_TRUE(same_bytes(read->mesh.positions, model.mesh.positions));
      if (const auto mesh = make_tri_mesh(*read); !mesh) {
        ASSERT_EQ(mesh.error().kind, ErrorKind::kBadData) << "a flipped partition id";
      }
    }
    EXPECT_LT(accepted, 350);
  }
}

TEST_F(ExaFile, HeadersThatLieAreRefusedWithASentence) {
  const SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  const std::vector<ExaBlock> blocks = encoded(model);
  const auto says = [&](const std::string& from, const std::string& to) {
    std::vector<ExaBlock> lying = blocks;
    const std::size_t at = lying[0].bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::string text = chunks_of(lying[0])[0];
    text.replace(text.find(from), from.size(), to);
    lying[0].bytes = join_chunks(std::vector<std::string>{text});
    const auto read = decode_exa(file_of(lying), progress_);
    return read ? std::string("accepted") : read.error().message;
  };
  EXPECT_THAT(says("[12,9,10]", "[65535,65535,16]"), HasSubstr("65535 x 65535 x 16 grid points in a file of"));
  EXPECT_THAT(says("[12,9,10]", "[8,8192,8192]"), HasSubstr("8 x 8192 x 8192 grid points in a file of"));
  EXPECT_THAT(says("[12,9,10]", "[1300,1300,1300]"), HasSubstr("2629640000 with 256 for each row, expected at most"));
  EXPECT_THAT(says("[12,9,10]", "[64,1700,1700]"), HasSubstr("1700 x 1700 grid rows in a file of"));
  EXPECT_THAT(says("\"edges\":", "\"edges\":99999999"), HasSubstr("edges in a file of"));
  EXPECT_THAT(says("[12,9,10]", "[65535,65535,65535]"), HasSubstr("2^36"));
  EXPECT_THAT(says("[12,9,10]", "[0,9,10]"), HasSubstr("dimension 0"));
  EXPECT_THAT(says("[12,9,10]", "[12,9]"), HasSubstr("\"dims\""));
  EXPECT_THAT(says("[12,9,10]", "[12,9,1e999]"), HasSubstr("the number 1e999 is too large"));
  EXPECT_THAT(says("\"offset_bits\":4", "\"offset_bits\":5"), HasSubstr("not the one that was written"));
  EXPECT_THAT(says("\"offset_bits\":4", "\"offset_bits\":17"), HasSubstr("17 offset bits"));
  EXPECT_THAT(says("\"closed\":true", "\"closed\":false"), HasSubstr("the header says"));
  EXPECT_THAT(says("\"closed\":true", "\"closed\":1"), HasSubstr("\"closed\""));
  EXPECT_THAT(says("\"vertices\":", "\"vertices\":1"), HasSubstr("the header says"));
  EXPECT_THAT(says("{", std::string(100, '[')), HasSubstr("nested"));
}

// Behind the end of a code all bits are 1: a byte a brick would be millions of signs.
TEST_F(ExaFile, BricksThatCodeMoreSignsThanTheirSurfaceNeedsAreRefusedAtTheFirst) {
  SurfaceModel model;
  model.samples.dims = {1000, 1000, 1000};
  model.samples.signs = BitVolume(model.samples.dims);
  model.mesh = build_quad_mesh(model.samples, progress_).value();
  model.frame.input_voxel = {{1, 1, 1}, ""};
  std::vector<ExaBlock> blocks = encoded(model);
  for (ExaBlock& block : blocks) {
    if (block.type == "SIG2") block.bytes = join_chunks(std::vector<std::string>(512, std::string(1, '\0')));
    if (block.type != "HEAD") continue;
    std::string text = chunks_of(block)[0];
    const std::string from = "\"edges\":0";
    text.replace(text.find(from), from.size(), "\"edges\":4000000");
    block.bytes = join_chunks(std::vector<std::string>{text});
  }
  const std::clock_t start = std::clock();
  const auto read = decode_exa(file_of(blocks), progress_);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("more signs than its surface can need"));
  EXPECT_LT(std::clock() - start, 20 * CLOCKS_PER_SEC) << "512 bricks of two million signs would take a minute";
}

}  // namespace
}  // namespace dubsar
