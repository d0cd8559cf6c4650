// The table of wedges: the columns that other programs read.

#include "core/script/wedge_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/files/sealed_text.h"
#include "core/script/arrange_text.h"

namespace dubsar {
namespace {

ScriptWedge one_wedge() {
  ScriptWedge w;
  w.head_mm = {1.5, -2.25, 3.0};
  w.depth_mm = 0.8;
  w.length_mm = 4.0;
  w.width_mm = 2.0;
  w.confidence = 0.9;
  w.kind = WedgeKind::kVertical;
  w.side = TextSide::kReverse;
  w.line = 3;
  w.order = 17;
  w.pressed_after = {{4, 0.1}, {16, 0.2}};
  return w;
}

TEST(WedgeTable, ARowHasAValueForEachColumn) {
  const std::vector<ScriptWedge> wedges{one_wedge()};
  const std::string csv = wedges_csv(wedges);
  const std::string head = csv.substr(0, csv.find('\n')), row = csv.substr(csv.find('\n') + 1);
  EXPECT_TRUE(head.starts_with(kWedgeColumns));
  EXPECT_TRUE(is_sealed_text(csv));
  EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(head.begin(), head.end(), ','));
  EXPECT_TRUE(row.starts_with("17,reverse,1,3,17,vertical,1.5000,-2.2500,3.0000,"));
  EXPECT_TRUE(row.ends_with(",0.800,4.0000,2.0000,0.0,4;16,0.900,measured,machine,\n") ||
              row.ends_with(",0.8000,4.0000,2.0000,0.0,4;16,0.900,measured,machine,\n"));
}

TEST(WedgeTable, JsonSaysTheSame) {
  WedgesFound found;
  found.wedges = {one_wedge()};
  const auto json = nlohmann::json::parse(wedges_json(found, "dubsar 1"));
  EXPECT_TRUE(is_sealed_text(wedges_json(found, "dubsar 1")));
  EXPECT_EQ(json["made_by"], "dubsar 1");
  EXPECT_EQ(json["wedges"][0]["kind"], "vertical");
  EXPECT_EQ(json["wedges"][0]["head"][1], -2.25);
  EXPECT_EQ(json["wedges"][0]["pressed_after"], nlohmann::json::array({4, 16}));
}

TEST(WedgeTable, KindsFollowTheAngleToTheLine) {
  const auto kind = [](double degrees, double length) {
    return wedge_kind(degrees * 3.14159265358979 / 180.0, length);
  };
  EXPECT_EQ(kind(5, 3), WedgeKind::kHorizontal);
  EXPECT_EQ(kind(-85, 3), WedgeKind::kVertical);
  EXPECT_EQ(kind(-45, 2), WedgeKind::kObliqueDown);
  EXPECT_EQ(kind(45, 2), WedgeKind::kObliqueUp);
  EXPECT_EQ(kind(180, 1), WedgeKind::kWinkelhaken);
  EXPECT_EQ(kind(120, 3), WedgeKind::kOdd);
}

}  // namespace
}  // namespace dubsar
