#include <fmt/format.h>

#include <algorithm>

#include "core/base/files/sealed_text.h"
#include "core/script/copy_sheet.h"

namespace dubsar {
namespace {

/// Names of layers have letters, digits, - and _ only in R12.
std::string dxf_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

std::string dxf_path(const CopyPath& path, const std::string& layer, double height) {
  std::string out = fmt::format("0\nPOLYLINE\n8\n{}\n66\n1\n70\n{}\n", layer, path.closed ? 1 : 0);
  for (const glm::dvec2& p : path.points)
    out += fmt::format("0\nVERTEX\n8\n{}\n10\n{:.4f}\n20\n{:.4f}\n30\n0.0\n", layer, p.x, height - p.y);
  return out + fmt::format("0\nSEQEND\n8\n{}\n", layer);
}

}  // namespace

std::string dxf_of(const CopySheet& sheet) {
  std::string out = fmt::format(
      "999\nmade by dubsar, unit mm, "
      "{}\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n4\n9\n$EXTMIN\n10\n"
      "0.0\n20\n0.0\n9\n$EXTMAX\n10\n{:.4f}\n20\n{:.4f}\n0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n{}"
      "\n",
      kUnsealed, sheet.width_mm, sheet.height_mm, sheet.layers.size());
  for (const CopyLayer& layer : sheet.layers)
    out += fmt::format("0\nLAYER\n2\n{}\n70\n0\n62\n7\n6\nCONTINUOUS\n", dxf_name(layer.id));
  out += "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  for (const CopyLayer& layer : sheet.layers) {
    const std::string name = dxf_name(layer.id);
    for (const CopyPath& path : layer.paths) out += dxf_path(path, name, sheet.height_mm);
    for (const CopyGroup& group : layer.groups)
      for (const CopyPath& path : group.paths) out += dxf_path(path, name, sheet.height_mm);
    for (const CopyText& t : layer.texts) {
      std::string text = t.text;
      std::replace_if(
          text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
      out += fmt::format("0\nTEXT\n8\n{}\n10\n{:.4f}\n20\n{:.4f}\n30\n0.0\n40\n{:.3f}\n1\n{}\n", name, t.at.x,
                         sheet.height_mm - t.at.y, t.size_mm, text);
    }
  }
  return sealed_text(out + "0\nENDSEC\n0\nEOF\n");
}

}  // namespace dubsar
