#pragma once
// A page about a surface that needs nothing but itself: figures, pictures, and the surface to turn in the browser.

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "app/publish/surface_facts.h"

namespace dubsar::app {

struct ReportPicture {
  std::string caption;
  std::string jpeg;  ///< bytes
};

/// What people kept of the surface, a row each.
struct ReportRow {
  std::string label, text, more;  ///< "o. 3", the line, its translation
};
/// A place that the page marks on the surface.
struct ReportPin {
  std::string label, text;
  glm::dvec3 at{0.0}, normal{0.0, 0.0, 1.0};  ///< as the GLB has places: mm in the tablet's own axes
  bool envelope = false;                      ///< goes with it when it is lifted
};
struct ReportWork {
  std::vector<ReportRow> record;  ///< "museum number", "AO 8295"
  std::vector<ReportRow> lines, notes, measures;
  std::vector<ReportPin> pins;  ///< of lines and notes
};

struct ReportContent {
  std::string title;                ///< "AO 8295"
  std::string made_by;              ///< program and version
  std::string institution, rights;  ///< empty: not said
  ReportWork work;
  SurfaceFacts facts;
  std::vector<ReportPicture> pictures;
  std::string glb;          ///< bytes of a GLB file, its data in the tablet's own axes
  bool simplified = false;  ///< it has fewer triangles than the surface
  std::string provenance;   ///< JSON text of the surface; may be empty
};

/// One HTML file in UTF-8, without a reference to any other file or address. Texts are escaped. Pure.
std::string report_page(const ReportContent& content);

/// RFC 4648 with padding.
std::string base64(const std::string& bytes);

}  // namespace dubsar::app
