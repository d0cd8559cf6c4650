// Whose clay is whose and where the contact crosses its edges come back to the last bit, whatever the labels; damaged
// bytes give a sentence or other labels, never a crash.

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

#include "core/exa/labels/contact_offsets.h"
#include "core/exa/labels/label_plane.h"
#include "tests/core/exa/chunk_views.h"
#include "tests/core/extract/labelled_help.h"

namespace dubsar {
namespace {

KnownContact known_of(const LabelledScene& scene) {
  return {*scene.samples, *scene.index, *scene.labels, *scene.edges};
}

struct CodedLabels {
  std::size_t plane = 0, offsets = 0;
};

/// Both come back; bytes of them.
CodedLabels expect_same(LabelledScene& scene) {
  SilentProgress progress;
  const BitVolume& signs = scene.samples->signs;
  const auto plane = encode_label_plane(signs, *scene.envelope, progress).value();
  const std::uint64_t most =
      most_coded_labels(scene.samples->offsets.size(), static_cast<std::uint64_t>(scene.contact.size()));
  const auto read = decode_label_plane(views_of(plane), signs, most, progress);
  EXPECT_TRUE(read) << read.error().message;
  if (!read) return {};
  EnvelopeBits wanted = *scene.envelope;
  wanted.compact(signs);
  EXPECT_TRUE(*read == wanted);
  const auto offsets = encode_contact_offsets(known_of(scene), scene.contact, progress).value();
  EXPECT_EQ(decode_contact_offsets(views_of(offsets), known_of(scene), progress).value(), scene.contact);
  return {bytes_of(plane), bytes_of(offsets)};
}

TEST(ExaLabels, ComeBackWhateverTheyAre) {
  for (const Dims& dims :
       {Dims{1, 1, 1}, Dims{2, 3, 1}, Dims{5, 4, 7}, Dims{131, 9, 6}, Dims{7, 130, 9}, Dims{33, 20, 129}})
    for (const unsigned seed : {1u, 2u, 3u})
      for (const int bits : {1, 4, 9}) {
        LabelledScene scene(random_labels(dims, seed, {1 + seed, 2, 1}), bits);
        SCOPED_TRACE(fmt::format("{} {} {}, seed {}, {} bits", dims.x, dims.y, dims.z, seed, bits));
        expect_same(scene.draw(seed));
      }
  for (const unsigned seed : {4u, 5u}) {
    LabelledScene all(all_labellings(seed, static_cast<int>(seed) - 4, 4));
    expect_same(all.draw(seed));
    LabelledScene smooth(smooth_labels({61, 50, 47}, seed));
    expect_same(smooth.draw(seed));
    LabelledScene nested(nested_labels(140, 0.3, seed));
    expect_same(nested.draw(seed));
  }
}

/// Written by a program that was made from docs/exa.md alone.
TEST(ExaLabels, AreTheBytesOfThePage) {
  Labels volume(Dims{14, 11, 9});
  LabelledScene::each(volume.dims, [&](auto x, auto y, auto z) {
    const bool clay = (x - 7) * (x - 7) + (y - 5) * (y - 5) + (z - 4) * (z - 4) < 40;
    volume.at(x, y, z) = !clay ? 0 : 2 * x + y + 3 * z >= 32 ? 2 : 1;
  });
  const LabelledScene scene(volume);
  SilentProgress progress;
  const auto chunks = encode_label_plane(scene.samples->signs, *scene.envelope, progress).value();
  ASSERT_EQ(chunks.size(), 1u);
  std::string hex;
  for (const char byte : chunks[0]) hex += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  EXPECT_EQ(hex, "f1414c54cc8b45fd1a7fd192ee1e8444a1c7290de43383c402");
}

TEST(ExaLabels, OfOneClayTakeNothingOrNextToNothing) {
  for (const std::uint8_t label : {std::uint8_t{1}, std::uint8_t{2}}) {
    Labels volume(Dims{200, 100, 90});
    std::fill(volume.voxels.begin(), volume.voxels.end(), label);
    LabelledScene scene(volume);
    const CodedLabels coded = expect_same(scene);
    EXPECT_LE(coded.plane, label == 1 ? 0u : 16u);
    EXPECT_EQ(coded.offsets, 0u);
  }
}

TEST(ExaLabels, OfAPlainContactTakeAFractionOfABitForEachEdge) {
  constexpr std::int64_t kSide = 160;
  LabelledScene scene(nested_labels(kSide, 0.0, 1));
  const glm::dvec3 middle = glm::dvec3(0.5 * (kSide - 1)) + glm::dvec3(0.0, 0.05 * kSide, 0.0);
  for (std::size_t i = 0; i < scene.contact.size(); ++i) {  // where the sphere crosses the edge
    const GridEdge& e = scene.edges->all()[i];
    glm::dvec3 from(e.x, e.y, e.z), to = from;
    to[e.axis] += 1.0;
    const double a = glm::length(from - middle), b = glm::length(to - middle);
    scene.contact[i] = static_cast<std::uint16_t>(std::clamp(16.0 * (0.28 * kSide - a) / (b - a), 0.0, 15.0));
  }
  const CodedLabels coded = expect_same(scene);
  const double edges = static_cast<double>(scene.contact.size());
  ASSERT_GT(edges, 5000.0);
  EXPECT_LT(8.0 * static_cast<double>(coded.plane) / edges, 0.5);
  EXPECT_LT(8.0 * static_cast<double>(coded.offsets) / edges, 2.0) << "a sphere's";
}

/// Rows of the chords of cells of three labels, as docs/exa.md has them.
std::vector<int> chord_numbers() {
  const LabelledCellTable& table = LabelledCellTable::instance();
  const auto image_of = [](std::span<const LabelledChord> chords, const LabelledSymmetry& g) {
    std::vector<LabelledChord> image(chords.begin(), chords.end());
    for (LabelledChord& chord : image) {
      for (std::uint8_t& e : chord.edges)
        if (e != LabelledChord::kNone) e = g.cell.edge[e];
      std::sort(chord.edges.begin(), chord.edges.end());
    }
    std::sort(image.begin(), image.end());
    return image;
  };
  std::vector<int> numbers;
  std::vector<bool> done(LabelledCellTable::kConfigs);
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    const CornerLabels labels = LabelledCellTable::labels_of(table.labelling_of(id));
    const auto chords = table.chords(id);
    const bool three =
        std::ranges::count(labels, 0) != 0 && std::ranges::count(labels, 1) != 0 && std::ranges::count(labels, 2) != 0;
    if (!three || chords.empty() || done[static_cast<std::size_t>(id)]) continue;
    for (int group = 0; group < 3; ++group) {
      std::vector<int> images;
      bool carried = true;
      for (const LabelledSymmetry& g : labelled_symmetries()) {
        if (group == 1 && !g.cell.axes_fixed) continue;
        if (group == 2 && g.cell.corner != std::array<std::uint8_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}) continue;
        images.push_back(transform_config(table, id, g));
        carried = carried && std::ranges::equal(table.chords(images.back()), image_of(chords, g));
      }
      if (!carried) continue;
      for (const int image : images) done[static_cast<std::size_t>(image)] = true;
      numbers.insert(numbers.end(), {table.labelling_of(id), static_cast<int>(table.resolution(id)), group,
                                     static_cast<int>(chords.size())});
      for (const LabelledChord& chord : chords) numbers.insert(numbers.end(), chord.edges.begin(), chord.edges.end());
      break;
    }
    EXPECT_TRUE(done[static_cast<std::size_t>(id)]) << id;
  }
  return numbers;
}

TEST(ExaLabels, CellsHaveTheChordsOfTheConstants) {
  std::ifstream file(std::string(DUBSAR_GOLDEN) + "/../../docs/exa_constants.txt");
  std::vector<int> found;
  std::size_t announced = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("label chords ")) announced = std::stoul(line.substr(13));
    std::istringstream words(announced == 0 || line.starts_with("label") ? "" : line);
    for (int number = 0; words >> number;) found.push_back(number);
  }
  const std::vector<int> wanted = chord_numbers();
  EXPECT_EQ(found.size(), announced);
  EXPECT_TRUE(found == wanted) << fmt::format("label chords {}\n{}", wanted.size(), fmt::join(wanted, " "));
}

TEST(ExaLabels, DamagedBytesNeverCrash) {
  LabelledScene scene(nested_labels(40, 0.4, 3));
  scene.draw(3);
  SilentProgress progress;
  const BitVolume& signs = scene.samples->signs;
  const auto plane = encode_label_plane(signs, *scene.envelope, progress).value();
  const auto offsets = encode_contact_offsets(known_of(scene), scene.contact, progress).value();
  std::mt19937 random(7);
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<std::string> broken = round % 2 == 0 ? plane : offsets;
    std::string& chunk = broken[0];
    const auto at = random() % chunk.size();
    switch (random() % 4) {
      case 0:
        chunk.resize(at);
        break;
      case 1:
        chunk[at] ^= static_cast<char>(1u << random() % 8);
        break;
      case 2:
        chunk.insert(at, 5, static_cast<char>(random()));
        break;
      default:
        for (char& c : chunk) c = static_cast<char>(random());
    }
    if (round % 2 == 0) {
      const auto read = decode_label_plane(views_of(broken), signs, 20000, progress);
      refused += !read;
      if (!read) {
        EXPECT_NE(read.error().message.find("more than 20000 labels"), std::string::npos);
      }
    } else if (const auto read = decode_contact_offsets(views_of(broken), known_of(scene), progress); !read) {
      EXPECT_NE(read.error().message.find("model that is not known"), std::string::npos);
    }
  }
  EXPECT_FALSE(decode_label_plane({}, signs, 1000, progress));
  EXPECT_FALSE(decode_contact_offsets({}, known_of(scene), progress));
  EXPECT_FALSE(decode_label_plane(views_of(plane), signs, 10, progress)) << "more than may be";
}

}  // namespace
}  // namespace dubsar
