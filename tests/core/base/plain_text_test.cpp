#include "core/base/text/plain_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/system/log.h"
#include "core/base/text/json_text.h"

namespace dubsar {
namespace {

TEST(PlainText, WhatIsHarmlessStaysAsItIs) {
  for (const char* text : {"", "/entry/data/data", "C:\\scans\\a b.h5", "Täfelchen 𒁾 №7", "100 %"})
    EXPECT_EQ(plain_text(text), text);
}

TEST(PlainText, WhatSteersATerminalIsWrittenOut) {
  EXPECT_EQ(plain_text("a\x1b[31mred"), "a\\x1b[31mred");
  EXPECT_EQ(plain_text("two\r\nlines\t\x07"), "two\\x0d\\x0alines\\x09\\x07");
  EXPECT_EQ(plain_text("two\nlines\r", true), "two\nlines\\x0d");
  EXPECT_EQ(plain_text("\xc2\x9b"
                       "31m"),
            "\\x9b31m")
      << "a control sequence in one character";
  EXPECT_EQ(plain_text("exa.\xe2\x80\xaeh5"), "exa.\\u202eh5") << "turns the writing direction";
  EXPECT_EQ(plain_text(std::string_view("nul\0x", 5)), "nul\\x00x");
}

TEST(PlainText, BytesThatAreNoUtf8AreWrittenOut) {
  EXPECT_EQ(plain_text("M\xfcnchen"), "M\\xfcnchen");
  EXPECT_EQ(plain_text("\xc0\xaf"), "\\xc0\\xaf") << "an overlong slash";
  EXPECT_EQ(plain_text("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half a surrogate pair";
  EXPECT_EQ(plain_text("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
  EXPECT_EQ(plain_text("cut \xe2\x82"), "cut \\xe2\\x82");
}

TEST(PlainText, EveryByteStringBecomesTextThatIsPlainAlready) {
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b) {
      const std::string bytes{'x', static_cast<char>(a), static_cast<char>(b)};
      const std::string plain = plain_text(bytes);
      ASSERT_EQ(plain_text(plain), plain) << a << " " << b;
      ASSERT_EQ(plain.find('\x1b'), std::string::npos);
    }
}

TEST(PlainText, LogMessagesArePlain) {
  std::string seen;
  set_log_handler([&](LogLevel, std::string_view message) { seen = message; });
  log_warning("dataset \"{}\"", "/a\x1b]0;owned\x07");
  set_log_handler(nullptr);
  EXPECT_EQ(seen, "dataset \"/a\\x1b]0;owned\\x07\"");
}

TEST(JsonText, InvalidBytesAreReplacedAndValidOnesKept) {
  const nlohmann::json json{{"path", "M\xfcnchen/Täfelchen"}};
  EXPECT_EQ(nlohmann::json::parse(dump_json(json))["path"], "M\xef\xbf\xbdnchen/Täfelchen");
  EXPECT_EQ(nlohmann::json::parse(dump_json_lines(json))["path"], "M\xef\xbf\xbdnchen/Täfelchen");
}

}  // namespace
}  // namespace dubsar
