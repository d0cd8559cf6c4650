#pragma once
// Measures and notes for other programs: JSON, and notes as W3C Web Annotations.

#include <string>

#include "app/document/document.h"
#include "core/base/result.h"

namespace dubsar::app {

/// {"format": "dubsar measures", "source": ..., "measures": [{"kind", "name", "points_mm", figures with their units}]}.
/// Only figures that a kind has are named.
std::string format_measures(const Document& document);

/// {"format": "dubsar notes", ...}: label, text, place, normal, the line it runs along, and the camera.
std::string format_notes(const Document& document);

/// An AnnotationCollection of the Web Annotation Data Model (W3C, 2017) with one page; places are PointSelectors with
/// x, y and z in mm of the scan, lines WktSelectors, as drafts for 3D of the IIIF have them. Ids tell tablets apart;
/// languages, creator, rights and days are those of the record and the notes.
std::string format_annotations(const Document& document);

/// Writes `text`, one of those above, a film or a document, where nothing is yet, or a file of the same format that
/// this program wrote. kUsage for a path that ends in something else than .json or .jsonld, or where something else is;
/// the errors of KeptFile.
Result<void> write_marks(const std::string& path, std::string_view text);

}  // namespace dubsar::app
