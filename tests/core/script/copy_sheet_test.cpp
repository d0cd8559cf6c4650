// What a drawing's files say: sizes in mm, one group a wedge, one page.

#include "core/script/copy_sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files/sealed_text.h"

namespace dubsar {
namespace {

CopySheet ten_mm() {
  CopySheet sheet;
  sheet.width_mm = 59.1;
  sheet.height_mm = 40.0;
  sheet.title = "AO 8295 <obverse> & more";
  CopyLayer layer{"obverse-vertical", "obverse vertical", "obverse vertical", {}, {}, {}};
  CopyGroup wedge{"w1", "wedge vertical machine", {{"line", "obverse 3"}, {"depth", ".82"}}, {}};
  wedge.paths.push_back({"head", {{10.0, 12.0}, {20.0, 12.0}}, false, false, 0.13});
  layer.groups.push_back(wedge);
  layer.texts.push_back({{1.0, 2.0}, "1 (a)", 2.2, CopyText::Anchor::kEnd});
  sheet.layers.push_back(layer);
  return sheet;
}

double number_at(const std::string& text, const std::string& pattern, std::size_t group = 1) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern))) << pattern;
  return match.size() > group ? std::strtod(match[static_cast<int>(group)].str().c_str(), nullptr) : NAN;
}

TEST(CopySheet, SvgIsAtTrueScale) {
  const std::string svg = svg_of(ten_mm());
  EXPECT_NEAR(number_at(svg, R"re( width="([0-9.]+)mm")re"), 59.1, 1e-3);
  EXPECT_NEAR(number_at(svg, R"re(viewBox="0 0 ([0-9.]+) ([0-9.]+)")re"), 59.1, 1e-3);
  const std::string path = R"re(class="head" d="M([0-9.]+) ([0-9.]+) L([0-9.]+) ([0-9.]+)")re";
  EXPECT_NEAR(number_at(svg, path, 3) - number_at(svg, path, 1), 10.0, 0.02);
  EXPECT_NE(svg.find(R"(<g id="w1" class="wedge vertical machine" data-line="obverse 3" data-depth=".82">)"),
            std::string::npos);
  EXPECT_NE(svg.find("AO 8295 &lt;obverse&gt; &amp; more"), std::string::npos);
  EXPECT_NE(svg.find(R"(inkscape:groupmode="layer" inkscape:label="obverse vertical")"), std::string::npos);
}

TEST(CopySheet, AChangedDrawingIsToldFromOurs) {
  for (const auto& write : {svg_of, pdf_of, dxf_of}) {
    std::string text = write(ten_mm());
    EXPECT_TRUE(is_sealed_text(text));
    const std::size_t number = text.rfind("10.0") != std::string::npos ? text.rfind("10.0") : text.size() / 2;
    text[number] = text[number] == '1' ? '3' : '1';  // a corner moved
    EXPECT_FALSE(is_sealed_text(text));
  }
}

TEST(CopySheet, PdfIsOnePageAtTrueScale) {
  const std::string pdf = pdf_of(ten_mm());
  EXPECT_NEAR(number_at(pdf, R"(MediaBox \[0 0 ([0-9.]+) ([0-9.]+)\])"), 59.1 * 72.0 / 25.4, 1e-3);
  const std::string line = R"(([0-9.]+) ([0-9.]+) m ([0-9.]+) ([0-9.]+) l S)";
  EXPECT_NEAR((number_at(pdf, line, 3) - number_at(pdf, line, 1)) * 25.4 / 72.0, 10.0, 0.02);
  EXPECT_NEAR(number_at(pdf, line, 2) * 25.4 / 72.0, 40.0 - 12.0, 0.02);
  // The table of objects leads to each of them, and to itself.
  const auto table = static_cast<std::size_t>(number_at(pdf, R"(startxref\n([0-9]+))"));
  ASSERT_EQ(pdf.substr(table, 4), "xref");
  std::size_t row = pdf.find("0000000000 65535 f \n", table) + 20;
  for (int object = 1; object <= 7; ++object, row += 20) {
    const auto at = static_cast<std::size_t>(std::strtoull(pdf.substr(row, 10).c_str(), nullptr, 10));
    EXPECT_EQ(pdf.substr(at, 7), std::to_string(object) + " 0 obj");
  }
}

TEST(CopySheet, DxfHasLayersAndLines) {
  const std::string dxf = dxf_of(ten_mm());
  EXPECT_NE(dxf.find("0\nLAYER\n2\nOBVERSE-VERTICAL\n"), std::string::npos);
  EXPECT_NE(dxf.find("0\nVERTEX\n8\nOBVERSE-VERTICAL\n10\n10.0000\n20\n28.0000\n"), std::string::npos);
  EXPECT_TRUE(dxf.ends_with("0\nEOF\n"));
}

// DXF is pairs of lines: a code, a value (Autodesk, DXF Reference, R12). Read back as such, not by the text around it.
TEST(CopySheet, DxfReadBackIsAtTrueScale) {
  std::istringstream lines(dxf_of(ten_mm()));
  std::vector<std::pair<double, double>> corners;
  std::string code, value, entity;
  while (std::getline(lines, code) && std::getline(lines, value)) {
    const int number = std::atoi(code.c_str());
    if (number == 0) {
      entity = value;
      if (entity == "VERTEX") corners.emplace_back(NAN, NAN);
    }
    if (entity == "VERTEX" && number == 10) corners.back().first = std::strtod(value.c_str(), nullptr);
    if (entity == "VERTEX" && number == 20) corners.back().second = std::strtod(value.c_str(), nullptr);
  }
  EXPECT_EQ(entity, "EOF");
  ASSERT_EQ(corners.size(), 2u);
  EXPECT_NEAR(std::hypot(corners[1].first - corners[0].first, corners[1].second - corners[0].second), 10.0, 0.02);
}

}  // namespace
}  // namespace dubsar
