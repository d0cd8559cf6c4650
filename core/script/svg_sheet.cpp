#include <fmt/format.h>

#include "core/base/files/sealed_text.h"
#include "core/base/text/markup_text.h"
#include "core/script/copy_sheet.h"

namespace dubsar {
namespace {

std::string svg_path(const CopyPath& path, const std::string& indent) {
  std::string d;
  for (std::size_t k = 0; k < path.points.size(); ++k)
    d += fmt::format("{}{:.3f} {:.3f}", k == 0 ? "M" : " L", path.points[k].x, path.points[k].y);
  if (path.closed) d += " Z";
  const std::string stroke =
      path.stroke_mm > 0.0
          ? fmt::format(R"( stroke="#000" stroke-width="{:.3f}" stroke-linecap="round" stroke-linejoin="round")",
                        path.stroke_mm)
          : std::string(R"( stroke="none")");
  return fmt::format("{}<path class=\"{}\" d=\"{}\" fill=\"{}\"{}/>\n", indent, markup_text(path.name), d,
                     path.filled ? "#000" : "none", stroke);
}

std::string svg_label(const CopyText& text, const std::string& indent) {
  const char* const anchor = text.anchor == CopyText::Anchor::kStart    ? "start"
                             : text.anchor == CopyText::Anchor::kMiddle ? "middle"
                                                                        : "end";
  return fmt::format(
      "{}<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.2f}\" font-family=\"Gentium Plus, Linux Libertine, serif\" "
      "text-anchor=\"{}\" fill=\"#000\">{}</text>\n",
      indent, text.at.x, text.at.y, text.size_mm, anchor, markup_text(text.text));
}

}  // namespace

std::string svg_of(const CopySheet& sheet) {
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
      "version=\"1.1\" width=\"{0:.3f}mm\" height=\"{1:.3f}mm\" viewBox=\"0 0 {0:.3f} {1:.3f}\">\n"
      "<!-- made by dubsar; one unit is one mm; {4} -->\n<title>{2}</title>\n<desc>{3}</desc>\n",
      sheet.width_mm, sheet.height_mm, markup_text(sheet.title), markup_text(sheet.description), kUnsealed);
  for (const CopyLayer& layer : sheet.layers) {
    out += fmt::format("<g id=\"{}\" class=\"layer {}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\">\n",
                       markup_text(layer.id), markup_text(layer.classes), markup_text(layer.label));
    for (const CopyPath& path : layer.paths) out += svg_path(path, " ");
    for (const CopyGroup& group : layer.groups) {
      out += fmt::format(" <g id=\"{}\" class=\"{}\"", markup_text(group.id), markup_text(group.classes));
      for (const auto& [name, value] : group.data) out += fmt::format(" data-{}=\"{}\"", name, markup_text(value));
      out += ">\n";
      for (const CopyPath& path : group.paths) out += svg_path(path, "  ");
      out += " </g>\n";
    }
    for (const CopyText& text : layer.texts) out += svg_label(text, " ");
    out += "</g>\n";
  }
  return sealed_text(out + "</svg>\n");
}

}  // namespace dubsar
