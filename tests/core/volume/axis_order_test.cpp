// The order of the axes: a volume is never shown as its mirror image, however it is stored.

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/volume/formats/import.h"
#include "tests/core/volume/gzip.h"
#include "tests/core/volume/hdf5_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;
using testing_tools::Hdf5Fixture;
using testing_tools::Packing;
using testing_tools::Shape;

constexpr std::array<std::int64_t, 3> kSize{7, 5, 9};  // along x, y, z of the object

// No two voxels are alike: every turn and every mirror image of the object is another array.
float object(std::int64_t x, std::int64_t y, std::int64_t z) { return static_cast<float>(x + 10 * y + 100 * z); }

std::vector<AxisOrder> all_orders() {
  std::vector<AxisOrder> all;
  std::array<int, 3> p{0, 1, 2};
  do {
    for (unsigned flips = 0; flips < 8; ++flips) {
      AxisOrder order;
      order.stored = p;
      for (std::size_t axis = 0; axis < 3; ++axis) order.backwards[axis] = (flips >> axis & 1U) != 0;
      all.push_back(order);
    }
  } while (std::next_permutation(p.begin(), p.end()));
  return all;
}

// The object as stored in that order, slowest first, one index at a time.
struct Stored {
  Shape shape;
  std::vector<double> values;
};
Stored store(const AxisOrder& order) {
  Stored out;
  std::array<std::size_t, 3> axis_at{};  // the object's axis at each stored place, fastest first
  for (std::size_t axis = 0; axis < 3; ++axis) axis_at[static_cast<std::size_t>(order.stored[axis])] = axis;
  for (std::size_t at = 3; at-- > 0;) out.shape.push_back(static_cast<std::uint64_t>(kSize[axis_at[at]]));
  std::array<std::int64_t, 3> at{};
  const auto index = [&](std::size_t axis) {
    const std::int64_t i = at[static_cast<std::size_t>(order.stored[axis])];
    return order.backwards[axis] ? kSize[axis] - 1 - i : i;
  };
  for (at[2] = 0; at[2] < kSize[axis_at[2]]; ++at[2])
    for (at[1] = 0; at[1] < kSize[axis_at[1]]; ++at[1])
      for (at[0] = 0; at[0] < kSize[axis_at[0]]; ++at[0]) out.values.push_back(object(index(0), index(1), index(2)));
  return out;
}

std::string bytes_of_floats(const std::vector<double>& values) {
  const std::vector<float> floats(values.begin(), values.end());
  return {reinterpret_cast<const char*>(floats.data()), floats.size() * sizeof(float)};
}

class AxisOrders : public testing_tools::TempFolder {
 protected:
  static Result<std::unique_ptr<ImportedVolume>> open(const std::filesystem::path& path) {
    ImportOptions options;
    options.path = path;
    return open_volume(options);
  }

  // The object itself, whatever the file looks like; read in slabs of several heights.
  static void expect_object(const Result<std::unique_ptr<ImportedVolume>>& volume, const std::string& what) {
    ASSERT_TRUE(volume) << what << ": " << volume.error().message;
    ASSERT_EQ((*volume)->dims(), (Dims{kSize[0], kSize[1], kSize[2]})) << what;
    for (const std::int64_t slab : {9, 1, 4}) {
      for (std::int64_t z = 0; z < kSize[2]; z += slab) {
        const std::int64_t end = std::min(kSize[2], z + slab);
        std::vector<float> out(static_cast<std::size_t>((end - z) * kSize[0] * kSize[1]));
        const auto read = (*volume)->read(z, end, out);
        ASSERT_TRUE(read) << what << ": " << read.error().message;
        for (std::int64_t i = 0; i < static_cast<std::int64_t>(out.size()); ++i)
          ASSERT_EQ(out[static_cast<std::size_t>(i)],
                    object(i % kSize[0], i / kSize[0] % kSize[1], z + i / kSize[0] / kSize[1]))
              << what << " voxel " << i << " of slab " << z;
      }
    }
  }
  static std::string warnings(const ImportedVolume& volume) {
    return fmt::format("{}", fmt::join(volume.info().warnings, "; "));
  }
};

// The six orders as one would write them, and whether the array as it lies is a mirror image: a permutation of zyx by
// an odd number of exchanges.
const std::vector<std::pair<std::string, bool>> kOrders{{"zyx", false}, {"yxz", false}, {"xzy", false},
                                                        {"xyz", true},  {"yzx", true},  {"zxy", true}};

TEST_F(AxisOrders, LettersAreUnderstoodAndPrintedTheSame) {
  for (const AxisOrder& order : all_orders()) {
    const auto parsed = parse_axis_order(order.letters());
    ASSERT_TRUE(parsed) << order.letters();
    EXPECT_EQ(*parsed, order) << order.letters();
  }
  for (const auto& [letters, mirrored] : kOrders) EXPECT_EQ(parse_axis_order(letters)->mirrored_as_stored(), mirrored);
  for (const char* text : {"XYZ", "x,y,z", "x:y:z", "['x', 'y', 'z']", "(x, y, z)", "x y z"})
    EXPECT_EQ(parse_axis_order(text)->letters(), "xyz") << text;
  for (const char* text : {"", "xy", "xyy", "abc", "xyzt", "C", "x--yz", "xyz-"}) {
    const auto parsed = parse_axis_order(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().kind, ErrorKind::kUsage);
  }
}

TEST_F(AxisOrders, EveryOrderOfARawFileShowsTheSameObject) {
  for (const AxisOrder& order : all_orders()) {
    const Stored stored = store(order);
    write_bytes(in("a.raw"), bytes_of_floats(stored.values));
    ImportOptions options;
    options.path = in("a.raw");
    options.raw = RawSpec{{static_cast<std::int64_t>(stored.shape[2]), static_cast<std::int64_t>(stored.shape[1]),
                           static_cast<std::int64_t>(stored.shape[0])},
                          ScalarType::kF32,
                          ByteOrder::kLittle,
                          0};
    options.axis_order = order;
    expect_object(open_volume(options), order.letters());
  }
}

TEST_F(AxisOrders, Hdf5LabelsInEveryOrderAndPlace) {
  const auto labels_of = [](const std::string& letters, const char* form) {
    std::vector<std::string> labels;
    for (const char letter : letters) labels.push_back(fmt::format(fmt::runtime(form), letter));
    return labels;
  };
  using Say = std::function<void(Hdf5Fixture&, const std::string&)>;
  const std::vector<std::pair<std::string, Say>> ways{
      {"axis_order", [](auto& file, auto& letters) { file.attribute("/entry/v", "axis_order", letters); }},
      {"above", [](auto& file, auto& letters) { file.attribute("/", "axis_order", letters); }},
      {"labels",
       [&](auto& file, auto& letters) { file.attribute("/entry/v", "DIMENSION_LABELS", labels_of(letters, "{}")); }},
      {"words",
       [&](auto& file, auto& letters) {
         file.attribute("/entry/v", "DIMENSION_LABELS", labels_of(letters, "sample_{} (mm)"));
       }},
      {"axes", [&](auto& file, auto& letters) { file.attribute("/entry", "axes", labels_of(letters, "{}")); }},
      {"exchange",
       [](auto& file, auto& letters) {
         file.attribute("/entry/v", "axes", fmt::format("{}:{}:{}", letters[0], letters[1], letters[2]));
       }},
      {"axistags",
       [](auto& file, auto& letters) {
         file.attribute("/entry/v", "axistags",
                        fmt::format(R"({{"axes":[{{"key":"{}"}},{{"key":"{}"}},{{"key":"{}"}}]}})", letters[0],
                                    letters[1], letters[2]));
       }},
      {"openPMD",
       [&](auto& file, auto& letters) {
         file.attribute("/entry/v", "axisLabels", labels_of({letters.rbegin(), letters.rend()}, "{}"));
         file.attribute("/entry/v", "dataOrder", std::string("F"));
       }},
      {"n5",
       [&](auto& file, auto& letters) {
         file.attribute("/", "n5", std::string("2.5.1"));
         file.attribute("/entry/v", "axes", labels_of({letters.rbegin(), letters.rend()}, "{}"));
       }},
  };
  for (const auto& [letters, mirrored] : kOrders) {
    const Stored stored = store(*parse_axis_order(letters));
    for (const auto& [way, say] : ways)
      for (const bool chunked : {false, true}) {
        {
          Hdf5Fixture file(in("a.h5"));
          file.array("/entry/v", ScalarType::kF32, ByteOrder::kLittle, stored.shape, stored.values,
                     chunked ? Packing{.chunk = {4, 3, 2}, .deflate = 3} : Packing{});
          say(file, letters);
        }
        const auto volume = open(in("a.h5"));
        expect_object(volume, fmt::format("{} by {}{}", letters, way, chunked ? ", chunked" : ""));
        EXPECT_EQ((*volume)->info().axes.letters(), letters) << way;
        EXPECT_EQ((*volume)->info().axes.mirrored_as_stored(), mirrored) << way;
        EXPECT_TRUE((*volume)->info().axes.known()) << way;
        EXPECT_EQ(warnings(**volume), "voxel size unknown: 1 voxel is taken as 1 mm; give the voxel size") << way;
      }
  }
}

TEST_F(AxisOrders, AxesOfLengthOneHaveLabelsToo) {
  const Stored stored = store(*parse_axis_order("xyz"));
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", {1, stored.shape[0], stored.shape[1], stored.shape[2], 1}, stored.values);
    file.attribute("/v", "axis_order", std::string("txyzc"));
  }
  expect_object(open(in("a.h5")), "txyzc");
}

TEST_F(AxisOrders, WhatCannotBeUsedIsSaid) {
  const auto with = [&](const std::function<void(Hdf5Fixture&)>& say) {
    const Stored stored = store({});
    {
      Hdf5Fixture file(in("a.h5"));
      file.array("/v", stored.shape, stored.values);
      say(file);
    }
    auto volume = open(in("a.h5"));
    expect_object(volume, "usual order");
    return std::move(*volume);
  };
  const auto silent = with([](Hdf5Fixture&) {});
  EXPECT_FALSE(silent->info().axes.known());
  EXPECT_THAT(describe(silent->info().axes), HasSubstr("the file does not say"));
  const auto broken = with([](Hdf5Fixture& file) { file.attribute("/v", "axis_order", std::string("C")); });
  EXPECT_FALSE(broken->info().axes.known());
  EXPECT_THAT(warnings(*broken), HasSubstr("\"/v@axis_order\" says \"C\", expected x, y and z"));
  const auto empty = with([](Hdf5Fixture& file) {
    file.attribute("/v", "DIMENSION_LABELS", std::vector<std::string>{"", "", ""});
  });
  EXPECT_THAT(warnings(*empty), testing::Not(HasSubstr("DIMENSION_LABELS")));
  const auto torn = with([](Hdf5Fixture& file) {
    file.attribute("/v", "axis_order", std::string("zyx"));
    file.attribute("/v", "DIMENSION_LABELS", std::vector<std::string>{"x", "y", "z"});
  });
  EXPECT_THAT(warnings(*torn), HasSubstr("but \"/v@DIMENSION_LABELS\" says xyz: the first is taken"));
  const auto matlab = with([](Hdf5Fixture& file) { file.attribute("/v", "MATLAB_class", std::string("single")); });
  EXPECT_THAT(warnings(*matlab), HasSubstr("mirror image cannot be told"));
}

TEST_F(AxisOrders, TheUserHasTheLastWord) {
  const Stored stored = store(*parse_axis_order("xyz"));
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", stored.shape, stored.values);
    file.attribute("/v", "axis_order", std::string("zyx"));
  }
  ImportOptions options;
  options.path = in("a.h5");
  options.axis_order = *parse_axis_order("xyz");
  const auto volume = open_volume(options);
  expect_object(volume, "given by the user");
  EXPECT_EQ((*volume)->info().axes.provenance, "given by the user");
}

TEST_F(AxisOrders, SizesFollowTheirAxes) {
  const Stored stored = store(*parse_axis_order("xyz"));
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", stored.shape, stored.values);
    file.attribute("/v", "axis_order", std::string("xyz"));
    file.attribute("/v", "element_size_um", std::vector<double>{10, 20, 30});  // x, y, z as stored
  }
  EXPECT_EQ((*open(in("a.h5")))->info().voxel.mm, glm::dvec3(10 * 1e-3, 20 * 1e-3, 30 * 1e-3));
  ImportOptions options;
  options.path = in("a.h5");
  options.crop.emplace();
  options.crop->begin = {1, 0, 2};
  options.crop->end = {6, -1, 8};
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume);
  ASSERT_EQ((*volume)->dims(), (Dims{5, 5, 6}));
  std::vector<float> out(150);
  ASSERT_TRUE((*volume)->read(0, 6, out));
  EXPECT_EQ(out.front(), object(1, 0, 2));
  EXPECT_EQ(out.back(), object(5, 4, 7));
}

// All 48 ways to lay a volume along the axes of space, and of a left-handed one.
TEST_F(AxisOrders, NrrdDirectionsShowTheSameObject) {
  for (const char* space : {"right-anterior-superior", "left-anterior-superior"})
    for (const AxisOrder& order : all_orders())
      for (const bool packed : {false, true}) {
        const Stored stored = store(order);
        std::array<std::string, 3> directions;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<double, 3> along{};
          along[axis] = order.backwards[axis] ? -0.5 : 0.5;
          if (std::string(space).starts_with("left")) along[0] = -along[0];  // its x counts from right to left
          directions[static_cast<std::size_t>(order.stored[axis])] =
              fmt::format("({},{},{})", along[0], along[1], along[2]);
        }
        const std::string bytes = bytes_of_floats(stored.values);
        write_bytes(in("a.nrrd"), fmt::format("NRRD0005\ntype: float\ndimension: 3\nsizes: {} {} {}\nendian: little\n"
                                              "encoding: {}\nspace: {}\nspace directions: {}\n\n",
                                              stored.shape[2], stored.shape[1], stored.shape[0],
                                              packed ? "gzip" : "raw", space, fmt::join(directions, " ")) +
                                      (packed ? testing_tools::gzip(bytes) : bytes));
        const auto volume = open(in("a.nrrd"));
        expect_object(volume, fmt::format("{} {}", space, order.letters()));
        EXPECT_EQ((*volume)->info().axes.mirrored_as_stored(), order.mirrored_as_stored());
        EXPECT_EQ((*volume)->info().axes.letters(), order.letters());
      }
}

TEST_F(AxisOrders, ObliqueDirectionsKeepTheirHandedness) {
  std::mt19937 random(std::random_device{}());
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 2000; ++trial) {
    std::array<glm::dvec3, 3> d{};
    for (glm::dvec3& v : d) v = {normal(random), normal(random), normal(random)};
    const double volume = d[0].x * (d[1].y * d[2].z - d[1].z * d[2].y) - d[0].y * (d[1].x * d[2].z - d[1].z * d[2].x) +
                          d[0].z * (d[1].x * d[2].y - d[1].y * d[2].x);
    if (std::abs(volume) < 0.1) continue;
    const auto right = axis_order_of(d, false), left = axis_order_of(d, true);
    ASSERT_TRUE(right && left);
    EXPECT_EQ(right->mirrored_as_stored(), volume < 0.0);
    EXPECT_EQ(left->mirrored_as_stored(), volume > 0.0);
  }
  EXPECT_FALSE(axis_order_of({glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)}, false));
  EXPECT_FALSE(axis_order_of({glm::dvec3(1, 0, 0), glm::dvec3(0, NAN, 0), glm::dvec3(0, 0, 1)}, false));
}

TEST_F(AxisOrders, NrrdLabelsAndBrokenDirections) {
  const auto with = [&](const AxisOrder& order, const std::string& field) {
    const Stored stored = store(order);
    write_bytes(in("a.nrrd"), fmt::format("NRRD0005\ntype: float\ndimension: 3\nsizes: {} {} {}\nendian: little\n"
                                          "encoding: raw\n{}\n\n",
                                          stored.shape[2], stored.shape[1], stored.shape[0], field) +
                                  bytes_of_floats(stored.values));
    auto volume = open(in("a.nrrd"));
    expect_object(volume, field);
    return std::move(*volume);
  };
  EXPECT_TRUE(with(*parse_axis_order("xyz"), "labels: \"z\" \"y\" \"x\"")->info().axes.mirrored_as_stored());
  EXPECT_FALSE(with({}, "spacings: 1 1 1")->info().axes.known());
  const auto flat = with({}, "space: LPS\nspace directions: (1,0,0) (1,0,0) (0,0,1)");
  EXPECT_THAT(warnings(*flat), HasSubstr("not three independent vectors"));
}

TEST_F(AxisOrders, VtkDirectionIsHonoured) {
  for (const AxisOrder& order : all_orders()) {
    const Stored stored = store(order);
    std::vector<double> matrix(9, 0.0);  // rows of x, y, z; columns i, j, k
    for (std::size_t axis = 0; axis < 3; ++axis)
      matrix[3 * axis + static_cast<std::size_t>(order.stored[axis])] = order.backwards[axis] ? -1.0 : 1.0;
    {
      Hdf5Fixture file(in("a.vtkhdf"));
      file.array("/VTKHDF/PointData/v", stored.shape, stored.values);
      file.attribute("/VTKHDF", "Type", std::string("ImageData"));
      file.attribute("/VTKHDF", "Direction", matrix);
    }
    expect_object(open(in("a.vtkhdf")), order.letters());
  }
}

}  // namespace
}  // namespace dubsar
