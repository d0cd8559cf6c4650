#include "app/publish/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dubsar::app {
namespace {
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Base64, IsThatOfTheStandardsExamples) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\xfe\xfd\0", 4)), "//79AA==");
}

ReportContent content() {
  ReportContent content;
  content.title = "AO 8295 <script>alert(1)</script>";
  content.made_by = "dubsar";
  content.rights = "\"A & B\"";
  PartFacts tablet;
  tablet.name = "tablet";
  tablet.size = {52.2, 54.3, 13.9};
  tablet.area = 1000.0;
  tablet.inferred_area = 117.0;
  content.facts.parts = {tablet};
  content.pictures = {{"obverse", "jpeg"}};
  content.glb = "glTF";
  content.provenance = R"({"input":{"path":"</pre><b>scan.h5"}})";
  return content;
}

TEST(ReportPage, NeedsNothingButItself) {
  const std::string page = report_page(content());
  for (const char* reference : {"http:", "https:", "src=\"/", "href=", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/jpeg;base64,anBlZw==\""));
  EXPECT_THAT(page, HasSubstr("id=\"surface\">Z2xURg==</script>"));
}

TEST(ReportPage, TextsOfFilesAndPeopleAreTextAndNothingElse) {
  const std::string page = report_page(content());
  EXPECT_THAT(page, HasSubstr("AO 8295 &lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("&quot;A &amp; B&quot;"));
  EXPECT_THAT(page, Not(HasSubstr("<b>scan.h5")));
  ReportContent broken = content();
  broken.provenance = "{not json <i>";
  EXPECT_THAT(report_page(broken), HasSubstr("{not json &lt;i&gt;"));
}

TEST(ReportPage, CarriesTheRecordLinesNotesAndMeasuresThatWereKept) {
  ReportContent kept = content();
  EXPECT_THAT(report_page(kept), Not(HasSubstr("<h2>Text</h2>")));
  kept.work.record = {{"museum number", "AO 8295", ""}};
  kept.work.lines = {{"o. 1", "a-na <b>", "to"}};
  kept.work.notes = {{"r. 2", "a crack", ""}};
  kept.work.pins = {{"o. 1", "</script><b>", {1, 2, 3}, {0, 0, 1}, true}};
  kept.work.measures = {{"head", "0.412 mm deep", "tablet"}};
  const std::string page = report_page(kept);
  EXPECT_THAT(page, HasSubstr("<tr><td>museum number</td><td>AO 8295</td>"));
  EXPECT_THAT(page, HasSubstr("<tr><td>o. 1</td><td>a-na &lt;b&gt;</td><td class=\"dim\">to</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<td>r. 2</td><td>a crack</td>"));
  EXPECT_THAT(page, HasSubstr(R"("text":"\u003c/script>\u003cb>")")) << "it does not end the element";
  EXPECT_THAT(page, HasSubstr("<td>head</td><td>0.412 mm deep</td>"));
}

TEST(ReportPage, SaysSizesAndWhatIsNotInTheScan) {
  const std::string page = report_page(content());
  EXPECT_THAT(page, HasSubstr("52.2 × 54.3 × 13.9"));
  EXPECT_THAT(page, HasSubstr("88.3 % of the surface is measured, 11.7 % is not in the scan"));
}

TEST(ReportPage, FiguresAreWrittenAsPeopleWriteThem) {
  ReportContent some = content();
  PartFacts pores;
  pores.name = "pores and crumbs";
  pores.kind = PartitionKind::kPores;
  pores.size = {55.8, 58.0, 18.9};
  pores.area = 221.0;
  pores.volume = -18.0;
  some.facts.parts.push_back(pores);
  some.provenance = R"({"input":{"file_dims":[512,272,472],"voxel_size_mm":[0.13956617647058822,0.14,0.2]},)"
                    R"("estimates":{"snr_db":25.3471}})";
  const std::string page = report_page(some);
  EXPECT_THAT(page, HasSubstr("<td>512 × 272 × 472</td>"));
  EXPECT_THAT(page, HasSubstr("<td>0.139566 × 0.14 × 0.2</td>"));
  EXPECT_THAT(page, HasSubstr("<td>pores and crumbs</td><td></td><td>221</td><td></td>"));
  EXPECT_THAT(page, Not(HasSubstr("<td>-18</td>"))) << "nothing is less than empty";
  EXPECT_THAT(page, HasSubstr("<td>signal to noise, dB</td>"));
}

}  // namespace
}  // namespace dubsar::app
