// Files of surfaces of parts: what is read is what was written, bit for bit, whatever the labels; what is damaged costs
// the contact and is named; bytes that are no code never crash.

#include "core/exa/exa_decode.h"
#include "core/exa/exa_plausible.h"
#include "core/exa/exa_salvage.h"
#include "core/exa/offsets/settle_labelled.h"
#include "core/exa/values/exact.h"
#include "core/extract/cell_box.h"
#include "core/mesh/mesh_check.h"
#include "tests/core/exa/exa_test_models.h"
#include "tests/core/extract/labelled_help.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

/// A model of a tablet in an envelope, as the pipeline leaves it; vertices moved about by up to `moved`.
SurfaceModel labelled_model(const Labels& volume, unsigned seed, float moved, int bits = 4) {
  SilentProgress progress;
  LabelledScene scene(volume, bits);
  scene.draw(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-moved, moved);
  LabelledMesh labelled = scene.build();
  SurfaceModel model;
  model.samples = *scene.samples;
  model.mesh = build_quad_mesh(model.samples, progress).value();
  for (std::size_t v = 0; v < model.mesh.positions.size(); ++v) {
    model.attributes.normals.push_back(glm::vec3(0.0f, 0.0f, 1.0f));
    model.attributes.k_min.push_back(0.0f);
    model.attributes.k_max.push_back(0.0f);
    model.attributes.shape.push_back(0);
    model.attributes.ao.push_back(static_cast<std::uint8_t>(random() % 64));
    model.attributes.evidence.push_back(static_cast<std::uint8_t>(random() % 4));
  }
  for (std::size_t q = 0; q < model.mesh.quads.size(); ++q)
    model.quad_partition.push_back(static_cast<std::uint8_t>(random() % 2));
  model.partitions = {{0, "tablet", "", 0.0, 0.0, false}, {1, "envelope inside", "envelope", 0.0, 0.0, false}};
  LabelledSurface& surface = model.labelled.emplace();
  surface.envelope = *scene.envelope;
  surface.envelope.compact(model.samples.signs);
  surface.contact = scene.contact;
  for (std::size_t v = labelled.first_mixed; v < labelled.mesh.positions.size(); ++v)
    if (!labelled.is_at_air(v)) surface.evidence.push_back(static_cast<std::uint8_t>(2 + random() % 2));
  if (moved > 0.0f)
    for (std::size_t v = 0; v < labelled.mesh.positions.size(); ++v) {
      if (random() % 8 != 0) continue;
      glm::vec3& p = labelled.mesh.positions[v];
      const glm::vec3 wanted = p + glm::vec3(uniform(random), uniform(random), uniform(random));
      p = v < labelled.first_mixed ? escaped(p, *escape_to(p, kept_in_cell(p, wanted))) : wanted;  // as settled ones do
    }
  EXPECT_TRUE(settle_labelled(model, std::move(labelled), CurvatureMethod::kFit, false, progress));
  return model;
}

void expect_same_parts(const SurfaceModel& a, const SurfaceModel& b) {
  expect_equal(a, b);
  ASSERT_TRUE(b.labelled.has_value());
  EXPECT_TRUE(*a.labelled == *b.labelled);
  ASSERT_TRUE(b.drawing.has_value());
  EXPECT_EQ(a.drawing->triangles, b.drawing->triangles);
  EXPECT_EQ(a.drawing->first_triangle, b.drawing->first_triangle);
  EXPECT_TRUE(same_bytes(a.drawing->steiner, b.drawing->steiner));
}

using LabelledFile = ExaFile;

TEST_F(LabelledFile, IsReadAsItWasWrittenWhateverTheLabels) {
  const auto round_trip = [&](const Labels& volume, unsigned seed, float moved, int bits) {
    const SurfaceModel model = labelled_model(volume, seed, moved, bits);
    const std::string file = file_of(encoded(model));
    const auto read = decode_exa(file, progress_);
    ASSERT_TRUE(read) << read.error().message;
    expect_same_parts(model, *read);
    EXPECT_EQ(file_of(encoded(*read)), file) << "written once more";
  };
  for (const unsigned seed : {11u, 12u, 13u}) {
    round_trip(random_labels({9, 8, 7}, seed), seed, 0.0f, 4);
    round_trip(random_labels({12, 10, 9}, seed, {2, 1, 1}), seed, 0.3f, 6);
    round_trip(smooth_labels({33, 30, 28}, seed), seed, 0.2f, 4);
    round_trip(nested_labels(36, 0.3, seed), seed, 0.2f, 4);
    round_trip(all_labellings(seed, static_cast<int>(seed) - 11, 12), seed, 0.1f, 3);
  }
  round_trip(random_labels({129, 5, 6}, 5), 5, 0.0f, 4);
}

TEST_F(LabelledFile, IsNotWrittenOfAnotherMeshThanItsLabelsGive) {
  const SurfaceModel model = labelled_model(nested_labels(30, 0.2, 6), 6, 0.0f);
  SilentProgress progress;
  const auto refused = [&](const SurfaceModel& other) {
    const auto blocks = encode_exa(other, progress);
    return !blocks && blocks.error().kind == ErrorKind::kInternal;
  };
  EXPECT_FALSE(refused(model));
  SurfaceModel turned = model;
  std::swap(turned.mesh.quads[7][0], turned.mesh.quads[7][2]);
  EXPECT_TRUE(refused(turned));
  SurfaceModel doubled = model;
  doubled.mesh.doubled.push_back({static_cast<std::uint32_t>(doubled.mesh.quads.size() - 1), 0, 3});
  EXPECT_TRUE(refused(doubled));
}

TEST_F(LabelledFile, SaysWhichVersionItNeeds) {
  const std::vector<ExaBlock> blocks = encoded(labelled_model(nested_labels(30, 0.2, 1), 1, 0.0f));
  EXPECT_EQ(exa_major_of(blocks), 7);
  EXPECT_EQ(exa_major_of(encoded(sample_model({12, 9, 10}, Kind::kBlob, 6))), 6);
  EXPECT_EQ(exa_major_of(encoded(sample_model({129, 9, 10}, Kind::kBlob, 6))), 7);
  const ExaHeader header = ExaReader::open(file_of(blocks)).value().header().value();
  ASSERT_TRUE(header.sums.contact.has_value());
  EXPECT_GT(header.sums.contact->edges, 500);
}

TEST_F(LabelledFile, IsPlausibleAndHasItsLevelsAndBoxes) {
  const SurfaceModel model = labelled_model(nested_labels(40, 0.2, 2), 2, 0.2f);
  const std::string file = file_of(encoded(model));
  const ExaReader reader = ExaReader::open(file).value();
  const SurfaceModel read = decode_exa(file, progress_).value();
  const auto plausible = check_plausible(read, reader.header().value(), progress_);
  EXPECT_TRUE(plausible) << plausible.error().message;
  const auto level = decode_level(reader, 1, progress_);
  ASSERT_TRUE(level) << level.error().message;
  EXPECT_GT(level->mesh.vertex_count(), 100);
  EXPECT_TRUE(decode_box(reader, {{0, 0, 0}, {20, 20, 20}}, progress_));
  SurfaceModel odd = read;
  odd.patches.front().extra_positions[0] += 20.0f;
  EXPECT_FALSE(check_plausible(odd, reader.header().value(), progress_));
}

std::string with_bit_turned(std::string file, const std::string& type) {
  const ExaReader reader = ExaReader::open(file).value();
  const ExaRow* const row = reader.table().find(type);
  EXPECT_NE(row, nullptr) << type;
  file[row->offset + row->length - 1 - row->length / 8] ^= 4;
  return file;
}

TEST_F(LabelledFile, ADamagedLabelCostsTheContactAndIsNamed) {
  const SurfaceModel model = labelled_model(nested_labels(40, 0.2, 3), 3, 0.2f);
  const std::string whole = file_of(encoded(model));
  const QuadMesh plain = build_quad_mesh(model.samples, progress_).value();
  for (const auto& [type, name, contact] : {std::tuple{"LABL", "\"labels\"", false},
                                            {"LOFS", "\"contact_offsets\"", false},
                                            {"SIG0", "signs_1", false},
                                            {"LEVI", "\"contact_evidence\"", true},
                                            {"ESCP", "\"escapes\"", true},
                                            {"AMBO", "\"ao\"", true}}) {
    const std::string damaged = with_bit_turned(whole, type);
    ASSERT_FALSE(decode_exa(damaged, progress_)) << type;
    const auto saved = decode_salvaged(ExaReader::open(damaged).value(), progress_);
    ASSERT_TRUE(saved) << type << ": " << saved.error().message;
    ASSERT_FALSE(saved->lost.empty()) << type;
    EXPECT_THAT(saved->lost.front(), HasSubstr(name));
    EXPECT_EQ(saved->model.labelled.has_value(), contact) << type;
    if (contact) {
      EXPECT_TRUE(saved->model.mesh.quads == model.mesh.quads) << type;
    } else if (std::string(type) != "SIG0") {
      EXPECT_TRUE(saved->model.mesh.quads == plain.quads) << type;
      EXPECT_TRUE(saved->model.patches.empty()) << type;
    }
    EXPECT_TRUE(make_tri_mesh(saved->model)) << type;
    EXPECT_TRUE(encode_exa(saved->model, progress_)) << type << ": what was saved cannot be stored";
  }
}

TEST_F(LabelledFile, BytesThatAreNoCodeGiveASentence) {
  const SurfaceModel model = labelled_model(nested_labels(26, 0.4, 4), 4, 0.2f);
  const std::vector<ExaBlock> blocks = encoded(model);
  std::mt19937 random(17);
  for (int round = 0; round < 300; ++round) {
    std::vector<ExaBlock> broken = blocks;
    const char* const type = std::array{"LABL", "LOFS", "LEVI", "ESCP", "HEAD"}[static_cast<std::size_t>(round % 5)];
    ExaBlock& block = *std::find_if(broken.begin(), broken.end(), [&](const ExaBlock& b) { return b.type == type; });
    const auto views = split_chunks(block.bytes, block.chunks, type).value();
    std::vector<std::string> chunks(views.begin(), views.end());
    std::string& chunk = chunks[random() % chunks.size()];
    if (chunk.empty()) continue;
    const auto at = random() % chunk.size();
    if (round % 3 == 0)
      chunk.resize(at);
    else if (round % 3 == 1)
      chunk[at] ^= static_cast<char>(1u << random() % 8);
    else
      for (std::size_t i = at; i < chunk.size(); ++i) chunk[i] = static_cast<char>(random());
    block.bytes = join_chunks(chunks);
    const auto read = decode_exa(file_of(broken, 7), progress_);
    if (!read) {
      EXPECT_GT(read.error().message.size(), 20u);
    } else {
      EXPECT_TRUE(make_tri_mesh(*read));
    }
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    std::vector<ExaBlock> fewer = blocks;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(b));
    const auto read = decode_exa(file_of(fewer, 7), progress_);
    if (!read) {
      EXPECT_GT(read.error().message.size(), 20u) << blocks[b].type;
    }
  }
}

}  // namespace
}  // namespace dubsar
