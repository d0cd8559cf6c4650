#include <fmt/format.h>

#include <vector>

#include "core/base/files/sealed_text.h"
#include "core/script/copy_sheet.h"

namespace dubsar {
namespace {

constexpr double kPointsPerMm = 72.0 / 25.4;

/// Letters that a standard font has; others as a question mark.
std::string pdf_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x80)
      out += c;
    else if ((static_cast<unsigned char>(c) & 0xc0) != 0x80)
      out += '?';
  }
  return out;
}

class PdfContent {
 public:
  explicit PdfContent(double height_mm) : height_(height_mm) {}
  void path(const CopyPath& p) {
    if (p.points.size() < 2) return;
    if (p.stroke_mm > 0.0) text_ += fmt::format("{:.3f} w ", p.stroke_mm * kPointsPerMm);
    for (std::size_t k = 0; k < p.points.size(); ++k)
      text_ += fmt::format("{:.3f} {:.3f} {} ", x(p.points[k]), y(p.points[k]), k == 0 ? "m" : "l");
    const bool stroked = p.stroke_mm > 0.0;
    text_ += p.filled ? (stroked ? "b\n" : "f\n") : p.closed ? "s\n" : "S\n";
  }
  void label(const CopyText& t) {
    const double size = t.size_mm * kPointsPerMm;
    // Half of the size is what a letter of Helvetica is wide in the mean.
    const double wide = 0.5 * size * static_cast<double>(t.text.size());
    const double shift = t.anchor == CopyText::Anchor::kStart ? 0.0 : t.anchor == CopyText::Anchor::kMiddle ? 0.5 : 1.0;
    text_ += fmt::format("BT /F1 {:.3f} Tf {:.3f} {:.3f} Td ({}) Tj ET\n", size, x(t.at) - shift * wide, y(t.at),
                         pdf_text(t.text));
  }
  void begin(std::size_t layer) { text_ += fmt::format("/OC /L{} BDC\n", layer); }
  void end() { text_ += "EMC\n"; }
  const std::string& text() const noexcept { return text_; }

 private:
  double x(const glm::dvec2& p) const { return p.x * kPointsPerMm; }
  double y(const glm::dvec2& p) const { return (height_ - p.y) * kPointsPerMm; }
  double height_;
  std::string text_ = "1 J 1 j 0 G 0 g\n";
};

}  // namespace

std::string pdf_of(const CopySheet& sheet) {
  PdfContent content(sheet.height_mm);
  for (std::size_t k = 0; k < sheet.layers.size(); ++k) {
    const CopyLayer& layer = sheet.layers[k];
    content.begin(k);
    for (const CopyPath& path : layer.paths) content.path(path);
    for (const CopyGroup& group : layer.groups)
      for (const CopyPath& path : group.paths) content.path(path);
    for (const CopyText& text : layer.texts) content.label(text);
    content.end();
  }
  // Objects: 1 catalog, 2 pages, 3 page, 4 content, 5 font, 6 information, then a group of optional content a layer.
  std::string groups, names;
  for (std::size_t k = 0; k < sheet.layers.size(); ++k) {
    groups += fmt::format("{} 0 R ", 7 + k);
    names += fmt::format("/L{} {} 0 R ", k, 7 + k);
  }
  std::vector<std::string> objects{
      fmt::format("<< /Type /Catalog /Pages 2 0 R /OCProperties << /OCGs [{0}] /D << /Order [{0}] >> >> >>", groups),
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      fmt::format(
          "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.3f} {:.3f}] /Contents 4 0 R /Resources << /Font << /F1 "
          "5 0 R >> /Properties << {} >> >> >>",
          sheet.width_mm * kPointsPerMm, sheet.height_mm * kPointsPerMm, names),
      fmt::format("<< /Length {} >>\nstream\n{}endstream", content.text().size(), content.text()),
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
      fmt::format("<< /Title ({}) /Creator (dubsar) /Producer (dubsar) >>", pdf_text(sheet.title))};
  for (const CopyLayer& layer : sheet.layers)
    objects.push_back(fmt::format("<< /Type /OCG /Name ({}) >>", pdf_text(layer.label)));
  std::string out = fmt::format("%PDF-1.5\n% made by dubsar, {}\n", kUnsealed);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    places.push_back(out.size());
    out += fmt::format("{} 0 obj\n{}\nendobj\n", k + 1, objects[k]);
  }
  const std::size_t table = out.size();
  out += fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
  for (const std::size_t place : places) out += fmt::format("{:010} 00000 n \n", place);
  out +=
      fmt::format("trailer\n<< /Size {} /Root 1 0 R /Info 6 0 R >>\nstartxref\n{}\n%%EOF\n", objects.size() + 1, table);
  return sealed_text(std::move(out));
}

}  // namespace dubsar
