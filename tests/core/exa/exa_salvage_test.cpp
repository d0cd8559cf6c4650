// One turned bit costs the block or the brick that it lies in, and nothing else; blocks that a later program added
// survive; finite nonsense behind right sums is told.

#include "core/exa/exa_salvage.h"

#include <fstream>
#include <limits>
#include <set>

#include "core/exa/exa_plausible.h"
#include "core/exa/offsets/settle.h"
#include "core/exa/signs/topology.h"
#include "core/mesh/evidence.h"
#include "core/mesh/mesh_check.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

/// The file with one bit of a chunk turned.
std::string with_turned_bit(std::string file, const std::string& type, std::size_t chunk) {
  const ExaReader reader = ExaReader::open(file).value();
  const ExaRow* const row = reader.table().find(type);
  EXPECT_NE(row, nullptr) << type;
  const ChunkIndex index =
      ChunkIndex::parse(std::string_view(file).substr(row->offset, row->length), row->length, row->chunks, type)
          .value();
  EXPECT_GT(index.length(chunk), 0U) << type << " chunk " << chunk;
  file[row->offset + index.offset(chunk) + index.length(chunk) / 2] ^= 4;
  return file;
}

using Place = std::array<float, 3>;
std::set<Place> places_of(const SurfaceModel& model) {
  std::set<Place> places;
  for (const glm::vec3& p : model.mesh.positions) places.insert({p.x, p.y, p.z});
  return places;
}

TEST_F(ExaFile, ADamagedBlockThatIsNotNeededIsNamedAndLeftOut) {
  const SurfaceModel model = sample_model({20, 15, 12}, Kind::kBlob, 3);
  const std::string whole = file_of(encoded(model));
  EXPECT_TRUE(decode_salvaged(ExaReader::open(whole).value(), progress_)->lost.empty());
  for (const auto& [type, name] : {std::pair{"PROV", "provenance"},
                                   {"AMBO", "ao"},
                                   {"EVID", "evidence"},
                                   {"SHAP", "shape"},
                                   {"NORM", "normals"},
                                   {"QPAR", "quad_partition"},
                                   {"PART", "partitions"},
                                   {"POSN", "positions"}}) {
    const std::string damaged = with_turned_bit(whole, type, 0);
    ASSERT_FALSE(decode_exa(damaged, progress_)) << type;
    const auto saved = decode_salvaged(ExaReader::open(damaged).value(), progress_);
    ASSERT_TRUE(saved) << type << ": " << saved.error().message;
    ASSERT_FALSE(saved->lost.empty()) << type;
    EXPECT_NE(saved->lost.front().find(name), std::string::npos) << saved->lost.front();
    EXPECT_EQ(saved->model.mesh.quads, model.mesh.quads) << type;
    if (std::string(type) != "POSN") {
      EXPECT_EQ(saved->model.mesh.positions, model.mesh.positions) << type;
    }
    if (std::string(type) != "AMBO") {
      EXPECT_EQ(saved->model.attributes.ao, model.attributes.ao) << type;
    }
    EXPECT_TRUE(encode_exa(saved->model, progress_)) << type << ": what was saved cannot be stored";
  }
}

TEST_F(ExaFile, ADamagedBrickCostsWhatLiesInItAndTheRestStaysToTheBit) {
  SurfaceModel model = sample_model({300, 20, 14}, Kind::kBlob, 4);  // bricks 0 and 2 are known to 1
  model.attributes.evidence.clear();
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  const std::string whole = file_of(encoded(model));
  ASSERT_GT(model.mesh.vertex_count(), 500);
  for (const char* const type : {"SIG0", "SIG2", "FACE", "OFFS"})
    for (const std::size_t brick : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
      const ExaReader reader = ExaReader::open(whole).value();
      if (reader.chunks(type, 0)->chunks[brick].empty()) continue;
      const bool signs = type[0] == 'S';
      const std::string damaged = with_turned_bit(whole, type, brick);
      const auto saved = decode_salvaged(ExaReader::open(damaged).value(), progress_);
      ASSERT_TRUE(saved) << type << brick << ": " << saved.error().message;
      EXPECT_NE(saved->lost.front().find(fmt::format("of brick {}, points {}:", brick, 128 * brick)), std::string::npos)
          << saved->lost.front();
      EXPECT_TRUE(
          check_mesh(make_tri_mesh(saved->model)->positions, make_tri_mesh(saved->model)->triangles).manifold());
      EXPECT_TRUE(encode_exa(saved->model, progress_)) << type << brick;
      // Away from lost bricks every vertex on its crossings is where it was; 1 is lost with those that it knows.
      const float low = 128.0F * static_cast<float>(signs && brick == 2 ? 1 : brick) - 2.0F,
                  high = 128.0F * static_cast<float>(signs && brick == 0 ? 2 : brick + 1) + 2.0F;
      const QuadMesh base = build_quad_mesh(model.samples, progress_).value();
      const std::set<Place> found = places_of(saved->model);
      std::int64_t kept = 0;
      for (std::size_t v = 0; v < base.positions.size(); ++v) {
        const glm::vec3& p = base.positions[v];
        if (p.x > low && p.x < high) continue;
        const glm::vec3& moved = model.mesh.positions[v];
        ASSERT_TRUE(found.contains({p.x, p.y, p.z}) || found.contains({moved.x, moved.y, moved.z}))
            << type << brick << " at " << p.x << " " << p.y << " " << p.z;
        ++kept;
      }
      EXPECT_GT(kept, 50) << type << brick;
      if (type[0] == 'F') continue;  // faces that are not joined are no place
      const auto& evidence = saved->model.attributes.evidence;
      ASSERT_EQ(evidence.size(), saved->model.mesh.positions.size());
      for (std::size_t v = 0; v < evidence.size(); ++v) {
        const float x = saved->model.mesh.positions[v].x;
        if (x > 128.0F * static_cast<float>(brick) + 1.0F && x < 128.0F * static_cast<float>(brick + 1) - 1.0F) {
          EXPECT_EQ(evidence[v], evidence_byte(Evidence::kInferred)) << type << brick << " " << x;
        } else if (x < low || x > high) {
          EXPECT_EQ(evidence[v], evidence_byte(Evidence::kMeasured)) << type << brick << " " << x;
        }
      }
    }
}

TEST_F(ExaFile, WithoutHeaderOrCoarseSignsNothingIsSaved) {
  const std::string whole = file_of(encoded(sample_model({20, 15, 12}, Kind::kBlob, 3)));
  for (const char* const type : {"HEAD", "SIGC"}) {
    const std::string damaged = with_turned_bit(whole, type, 0);
    EXPECT_EQ(decode_salvaged(ExaReader::open(damaged).value(), progress_).error().kind, ErrorKind::kBadData) << type;
  }
}

TEST_F(ExaFile, BlocksOfALaterProgramAreCarriedIntoEveryFileThatIsWritten) {
  std::vector<ExaBlock> blocks = encoded(sample_model({12, 9, 10}, Kind::kBlob, 6));
  const ExaBlock added{"NEW1", 99, 4, 2, join_chunks(std::vector<std::string>{"whatever", "it is"})};
  blocks.push_back(added);
  const auto model = decode_exa(file_of(blocks, kExaMajor, 7), progress_);
  ASSERT_TRUE(model) << model.error().message;
  const std::vector<ExaBlock> again = encoded(*model);
  EXPECT_EQ(again.back().type, added.type);
  EXPECT_EQ(again.back().codec, added.codec);
  EXPECT_EQ(again.back().flags, added.flags);
  EXPECT_EQ(again.back().chunks, added.chunks);
  EXPECT_EQ(again.back().bytes, added.bytes);
  EXPECT_TRUE(decode_salvaged(ExaReader::open(file_of(blocks)).value(), progress_)->lost.empty());
  const auto saved = decode_salvaged(ExaReader::open(with_turned_bit(file_of(blocks), "NEW1", 1)).value(), progress_);
  ASSERT_TRUE(saved);
  EXPECT_TRUE(saved->model.foreign.empty()) << "a damaged block is not handed on";
}

TEST_F(ExaFile, FiniteNonsenseIsTold) {
  const SurfaceModel model = sample_model({20, 15, 12}, Kind::kBlob, 3);
  const auto told = [&](const std::function<void(SurfaceModel&, ExaHeader&)>& change) -> std::string {
    SurfaceModel other = model;
    for (glm::vec3& n : other.attributes.normals) n = glm::vec3(0.0F, 0.0F, 1.0F);
    other.provenance = "{}";
    ExaHeader header;
    header.normals = ExaNormals::kExact;
    change(other, header);
    const auto found = check_plausible(other, header, progress_);
    return found ? "" : found.error().message;
  };
  EXPECT_EQ(told([](SurfaceModel&, ExaHeader&) {}), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.attributes.normals[7] = glm::vec3(1e30F); }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.attributes.normals[7] = glm::vec3(0.0F); }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.attributes.k_max[7] = 1e30F; }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.attributes.normals.clear(); }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.mesh.positions[0].x = 3e38F; }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) {
              std::fill(m.mesh.positions.begin(), m.mesh.positions.end(), glm::vec3(5.0F));
            }),
            "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.provenance = "no JSON"; }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.frame.input_voxel = {glm::dvec3(1e300), "a file"}; }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.patches.push_back({0, 1, {}, {{3, 3, 3}}}); }), "");
  EXPECT_NE(told([](SurfaceModel& m, ExaHeader&) { m.patches.push_back({0, 1, {glm::vec3(1e9F)}, {}}); }), "");
}

TEST_F(ExaFile, NothingIsToldOfGoldenFiles) {
  for (const auto& entry : std::filesystem::directory_iterator(DUBSAR_GOLDEN)) {
    if (entry.path().extension() != ".exa") continue;
    const auto plausible =
        check_plausible(read_exa(entry.path(), progress_).value(), read_exa_info(entry.path())->header, progress_);
    EXPECT_TRUE(plausible) << entry.path() << ": " << plausible.error().message;
  }
}

TEST_F(ExaFile, PlacesBeyondAllGridsAreNeitherStoredNorRead) {
  SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  model.mesh.positions[3].y = 3e38F;
  EXPECT_EQ(encode_exa(model, progress_).error().kind, ErrorKind::kBadData);
  model.mesh.positions[3].y = 9.9e5F;
  EXPECT_TRUE(decode_exa(file_of(encoded(model)), progress_)) << "far, but within what a file may say";
}

}  // namespace
}  // namespace dubsar
