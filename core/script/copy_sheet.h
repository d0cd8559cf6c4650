#pragma once
// A sheet of drawn lines at true scale, for whatever writes it: SVG, PDF, DXF.

#include <glm/vec2.hpp>
#include <string>
#include <utility>
#include <vector>

namespace dubsar {

/// mm on the sheet, y downwards from its upper left corner.
struct CopyPath {
  std::string name;  ///< of its part: "head", "left", "right", "outline"
  std::vector<glm::dvec2> points;
  bool closed = false, filled = false;
  double stroke_mm = 0.15;  ///< 0: none
};

struct CopyText {
  glm::dvec2 at{0.0};  ///< of the base line
  std::string text;
  double size_mm = 2.5;
  enum class Anchor { kStart, kMiddle, kEnd } anchor = Anchor::kStart;
};

/// One thing that is moved, hidden or taken away as a whole: a wedge.
struct CopyGroup {
  std::string id, classes;  ///< id: unique on the sheet
  std::vector<std::pair<std::string, std::string>> data;
  std::vector<CopyPath> paths;
};

struct CopyLayer {
  std::string id, label, classes;
  std::vector<CopyGroup> groups;
  std::vector<CopyPath> paths;
  std::vector<CopyText> texts;
};

struct CopySheet {
  double width_mm = 0.0, height_mm = 0.0;
  std::string title, description;
  std::vector<CopyLayer> layers;
};

// All three are sealed (core/base/files/sealed_text.h), so that a corrected one is told from ours.

/// Layers as groups that Inkscape takes as layers; one user unit is one mm; presentation attributes, no styles.
std::string svg_of(const CopySheet& sheet);
/// One page, 1:1, vectors; Helvetica for texts. Layers are optional content.
std::string pdf_of(const CopySheet& sheet);
/// R12 in ASCII: POLYLINE, TEXT and a LAYER a layer; mm, y upwards.
std::string dxf_of(const CopySheet& sheet);

}  // namespace dubsar
