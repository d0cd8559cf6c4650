// Files of this version are readable for ever, and docs/exa.md suffices to read them: each golden file gives the sums
// that stand beside it, here and in the reader that was written from that page alone.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/exa/chunks.h"
#include "core/exa/exa_file.h"
#include "core/extract/labelled/point_labels.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

const fs::path kGolden = DUBSAR_GOLDEN;

/// Lines "name.exa N vertices M x-quads positions 0123abcd ...", by file name.
std::map<std::string, std::string> expected_lines() {
  std::map<std::string, std::string> lines;
  std::ifstream file(kGolden / "exa_sums.txt");
  for (std::string line; std::getline(file, line);) lines[line.substr(0, line.find(' '))] = line;
  return lines;
}

template <class T>
void add_sum(std::string& line, const char* name, const std::vector<T>& items) {
  if (items.empty()) return;
  line += fmt::format(" {} {:08x}", name,
                      crc32_of({reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)}));
}

/// Of each point: 0 air, 1 tablet, 2 envelope.
std::vector<std::uint8_t> labels_of(const SurfaceModel& model) {
  const PointLabels labels(model.samples.signs, model.labelled->envelope);
  const Dims& d = model.samples.dims;
  std::vector<std::uint8_t> all;
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) all.push_back(static_cast<std::uint8_t>(labels.get(x, y, z)));
  return all;
}

TEST(ExaGolden, EveryFileGivesTheSumsThatStandBesideIt) {
  const auto expected = expected_lines();
  ASSERT_GE(expected.size(), 3u);
  SilentProgress progress;
  for (const auto& [name, line] : expected) {
    const auto info = read_exa_info(kGolden / name);
    const auto model = read_exa(kGolden / name, progress);
    ASSERT_TRUE(model) << name << ": " << model.error().message;
    std::string found =
        fmt::format("{} {} vertices {} x-quads", name, model->mesh.vertex_count(), model->mesh.quad_count());
    if (model->labelled) {  // the reader knows their planes; the mesh has the sums of the header
      add_sum(found, "labels", labels_of(*model));
      add_sum(found, "contact", model->labelled->contact);
      EXPECT_EQ(found, line);
      continue;
    }
    add_sum(found, "positions", model->mesh.positions);
    add_sum(found, "quads", model->mesh.quads);
    if (!info->header.shapes) add_sum(found, "shape", model->attributes.shape);
    add_sum(found, "ao", model->attributes.ao);
    add_sum(found, "quad_partition", model->quad_partition);
    if (info->header.normals == ExaNormals::kExact) add_sum(found, "normals", model->attributes.normals);
    if (info->header.normals == ExaNormals::kExact) {
      std::vector<float> pairs;
      for (std::size_t v = 0; v < model->attributes.k_min.size(); ++v) {
        pairs.push_back(model->attributes.k_min[v]);
        pairs.push_back(model->attributes.k_max[v]);
      }
      add_sum(found, "curvatures", pairs);
    }
    std::string patches, patch_evidence;
    for (const FillPatch& patch : model->patches) {
      patches += {static_cast<char>(patch.partition), static_cast<char>(patch.reverse_partition)};
      patches.append(reinterpret_cast<const char*>(patch.extra_positions.data()), patch.extra_positions.size() * 12);
      patches.append(reinterpret_cast<const char*>(patch.triangles.data()), patch.triangles.size() * 12);
      patch_evidence.append(patch.evidence.begin(), patch.evidence.end());
    }
    if (!patches.empty()) found += fmt::format(" patches {:08x}", crc32_of(patches));
    add_sum(found, "evidence", model->attributes.evidence);
    if (!patch_evidence.empty()) found += fmt::format(" patch_evidence {:08x}", crc32_of(patch_evidence));
    EXPECT_EQ(found, line);
  }
}

class ExaGoldenReader : public testing::TestWithParam<std::string> {};

/// What a Python script of the golden folder prints; nothing where there is no Python with numpy.
std::optional<std::string> printed_by(const std::string& script) {
  const auto runs = [](const char* python) {
    return std::system(fmt::format("{} -c 'import numpy' 2>/dev/null", python).c_str()) == 0;
  };
  const char* const python = runs("python3") ? "python3" : "/usr/bin/python3";
  if (!runs(python)) return std::nullopt;
  const std::string command = fmt::format("cd '{}' && {} {} 2>&1", kGolden.string(), python, script);
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string found;
  for (std::array<char, 512> text; std::fgets(text.data(), static_cast<int>(text.size()), pipe) != nullptr;)
    found += text.data();
  EXPECT_EQ(::pclose(pipe), 0) << command;
  return found;
}

TEST_P(ExaGoldenReader, WrittenFromTheSpecificationGivesTheSame) {
  const auto found = printed_by(fmt::format("exa_reader.py '{}'", GetParam()));
  if (!found) GTEST_SKIP() << "python3 with numpy is not installed (apt install python3-numpy)";
  EXPECT_EQ(*found, expected_lines()[GetParam()] + "\n");
}

TEST(ExaGolden, TheConstantsBesideThePageAreThoseOfTheProgramAndOfTheHashOnThePage) {
  const auto found = printed_by("exa_constants.py");
  if (!found) GTEST_SKIP() << "python3 with numpy is not installed (apt install python3-numpy)";
  EXPECT_EQ(*found, "good\n");
}

std::vector<std::string> golden_files() {
  std::vector<std::string> names;
  for (const auto& [name, line] : expected_lines()) names.push_back(name);
  return names;
}

// One test a file: together they take half a minute.
INSTANTIATE_TEST_SUITE_P(File, ExaGoldenReader, testing::ValuesIn(golden_files()),
                         [](const auto& file) { return file.param.substr(0, file.param.find('.')); });

}  // namespace
}  // namespace dubsar
