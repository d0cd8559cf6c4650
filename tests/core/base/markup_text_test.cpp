#include "core/base/text/markup_text.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

TEST(MarkupText, WhatMarkupIsMadeOfBecomesEntities) {
  EXPECT_EQ(markup_text("a < b & c > \"d\""), "a &lt; b &amp; c &gt; &quot;d&quot;");
}

TEST(MarkupText, LettersOfAllLanguagesStayAndControlCharactersGo) {
  EXPECT_EQ(markup_text("šūḫā\n\t₂\x1b[31m\x01"), "šūḫā\n\t₂[31m");
}

}  // namespace
}  // namespace dubsar
