#include "display/sinks/catalog/sink_spec.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

TEST(SinkSpecText, SaysWhatItSays) {
  const auto spec = parse_sink_spec("lenticular:looking-glass-go,calibration=/media/a:b/visual.json,nearest,x=");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->name, "lenticular");
  const std::vector<SinkOption> expected{
      {"looking-glass-go"}, {"calibration", "/media/a:b/visual.json"}, {"nearest"}, {"x", ""}};
  EXPECT_EQ(spec->options, expected);
  EXPECT_EQ(parse_sink_spec("mono"), (SinkSpec{"mono"}));
  EXPECT_EQ(parse_sink_spec("image:path=a=b.png")->options[0].value, "a=b.png");
}

TEST(SinkSpecText, ValuesInQuotationMarksHoldAnything) {
  const auto spec = parse_sink_spec(R"(image:path="/tmp/a, \"b\" c:\\d\e.png","a word, too",last)");
  ASSERT_TRUE(spec) << spec.error().message;
  const std::vector<SinkOption> expected{{"path", R"(/tmp/a, "b" c:\d\e.png)"}, {"a word, too"}, {"last"}};
  EXPECT_EQ(spec->options, expected);
}

TEST(SinkSpecText, WhatCannotBeReadIsAUsageErrorThatQuotesIt) {
  for (const char* bad : {"", ":", ":half", "mono:", "mono:,", "mono:a,", "mono:a,,b", "mono:=1", "mono:\"a",
                          "mono:x=\"a", "mono:x=\"a\"b", "mono:\"a\"b", "mono:\"\"=1"}) {
    const auto spec = parse_sink_spec(bad);
    ASSERT_FALSE(spec) << bad;
    EXPECT_EQ(spec.error().kind, ErrorKind::kUsage) << bad;
    EXPECT_NE(spec.error().message.find("expected"), std::string::npos) << spec.error().message;
  }
}

TEST(SinkSpecText, WhateverIsPrintedIsReadAsEqualAndPrintedAsTheSame) {
  std::mt19937 random(std::random_device{}());
  const std::string_view letters = "ab,:=\"\\ /%.\n-";
  const auto text = [&](std::size_t least) {
    std::string out;
    for (std::size_t n = least + random() % 6; n > 0; --n) out += letters[random() % letters.size()];
    return out;
  };
  for (int i = 0; i < 20000; ++i) {
    SinkSpec spec{"sink"};
    for (std::size_t n = random() % 4; n > 0; --n) {
      SinkOption& option = spec.options.emplace_back();
      option.key = text(1);
      if (random() % 2 == 0) option.value = text(0);
    }
    const auto read = parse_sink_spec(spec.text());
    ASSERT_TRUE(read) << spec.text() << ": " << read.error().message;
    ASSERT_EQ(*read, spec) << spec.text();
    ASSERT_EQ(read->text(), spec.text());
  }
  for (int i = 0; i < 20000; ++i)  // and what people type, where it can be read at all
    if (const auto read = parse_sink_spec("sink:" + text(1))) {
      ASSERT_EQ(parse_sink_spec(read->text()), *read) << read->text();
    }
}

}  // namespace
}  // namespace dubsar
