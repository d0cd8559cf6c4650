#include "core/mesh/partition_table.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace dubsar {
namespace {

PartitionTable enclosed_tablet() {
  PartitionTable table;
  table.add(PartitionKind::kTablet);
  table.add(PartitionKind::kEnvelopeOutside, "envelope");
  table.add(PartitionKind::kEnvelopeInside, "envelope");
  table.add(PartitionKind::kFragment, {}, "fragment 1");
  return table;
}

TEST(PartitionTable, EveryKindHasANameThatLeadsBackToIt) {
  for (const PartitionKind kind : {PartitionKind::kObject, PartitionKind::kTablet, PartitionKind::kEnvelopeOutside,
                                   PartitionKind::kEnvelopeInside, PartitionKind::kPores})
    EXPECT_EQ(partition_kind_of(partition_kind_name(kind)), kind);
  EXPECT_EQ(partition_kind_of("fragment 12"), PartitionKind::kFragment);
  for (const char* name : {"fragment x", "fragment ", "lid", ""})
    EXPECT_EQ(partition_kind_of(name), PartitionKind::kOther) << name;
}

TEST(PartitionTable, PartitionsOfOneBodyAreFoundByIt) {
  const PartitionTable table = enclosed_tablet();
  EXPECT_EQ(table.body_of(0), 0);
  EXPECT_EQ(table.body_of(1), 1);
  EXPECT_EQ(table.body_of(2), 1) << "the two walls of an envelope are one body";
  EXPECT_EQ(table.body_of(3), 3);
  EXPECT_EQ(table.body_of(7), 7) << "an id without a row stands for itself";
  EXPECT_EQ(table.body_names(), (std::vector<std::string>{"tablet", "envelope", "fragment 1"}));
  EXPECT_EQ(table.listed(), "tablet (0), envelope outside (1), envelope inside (2), fragment 1 (3)");
  EXPECT_EQ(table.find(PartitionKind::kEnvelopeInside)->id, 2);
  EXPECT_EQ(table.find("tablet")->kind, PartitionKind::kTablet);
  EXPECT_EQ(table.find(PartitionKind::kPores), nullptr);
}

TEST(PartitionTable, ABodyWithoutANameIsOneOfItsOwn) {
  const PartitionTable table{{.id = 0, .name = "left"}, {.id = 1, .name = "right"}, {.id = 2, .name = "", .body = ""}};
  for (PartitionId id = 0; id < 3; ++id) EXPECT_EQ(table.body_of(id), id);
}

TEST(PartitionTable, RowsAreInRisingOrderAndEachIdIsThereOnce) {
  PartitionTable table;
  for (const PartitionId id : {PartitionId{5}, PartitionId{0}, PartitionId{7}})
    ASSERT_TRUE(table.insert({.id = id, .name = std::to_string(id)}));
  EXPECT_EQ(table[0].id, 0);
  EXPECT_EQ(table[2].id, 7);
  EXPECT_EQ(table.insert({.id = 5, .name = "again"}).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(table.insert({.id = 8, .name = "too high"}).error().kind, ErrorKind::kBadData);
  PartitionTable other{{.id = 5, .name = "theirs"}, {.id = 6, .name = "new"}};
  table.merge(other);
  EXPECT_EQ(table.size(), 4u);
  EXPECT_EQ(table.find(PartitionId{5})->name, "5");
  EXPECT_EQ(table.find(PartitionId{6})->name, "new");
}

TEST(PartitionTable, LabelsWithoutARowAndGapsInTheTableAreRefused) {
  const PartitionTable table = enclosed_tablet();
  const std::vector<PartitionId> good{0, 3, 2, 1}, bad{0, 4};
  EXPECT_TRUE(table.check_complete(good, "test", "a face"));
  EXPECT_EQ(table.check_complete(bad, "test", "a face").error().message,
            "test: a face has partition 4, expected less than 4");
  EXPECT_TRUE(PartitionTable().check_complete(std::vector<PartitionId>{0, 0}, "test", "a face"));
  EXPECT_FALSE(PartitionTable().check_complete(std::vector<PartitionId>{0, 1}, "test", "a face"));
  EXPECT_FALSE(PartitionTable({{.id = 1, .name = "b"}}).check_complete({}, "test", "a face"));
}

TEST(PartitionTable, JsonReadBackEqualsTheRowAndItsBytesAreFixed) {
  PartitionTable table = enclosed_tablet();
  table.measured(2, 12.5, -0.1, true);
  const std::string text = partition_json(table[2]).dump();
  EXPECT_EQ(
      text,
      R"({"id":2,"name":"envelope inside","part":"envelope","area_mm2":12.5,"volume_mm3":-0.1,"watertight":true})");
  const Partition read = parse_partition(nlohmann::json::parse(text)).value();
  EXPECT_EQ(partition_json(read).dump(), text);
  EXPECT_EQ(read.kind, PartitionKind::kEnvelopeInside);
  for (const char* broken :
       {"[]", "{}", R"({"id":0})", R"({"id":8,"name":""})", R"({"id":-1,"name":""})",
        R"({"id":18446744073709551615,"name":""})", R"({"id":"0","name":""})", R"({"id":0,"name":7})"})
    EXPECT_EQ(parse_partition(nlohmann::json::parse(broken)).error().kind, ErrorKind::kBadData) << broken;
}

}  // namespace
}  // namespace dubsar
