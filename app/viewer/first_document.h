#pragma once
// The document that a session begins with.

#include "app/stage/shown_document.h"
#include "app/viewer/view_options.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// That of the options with the parts of the mesh, which are as it says of parts with their names; upright where the
/// options say so, with what is not sure of it.
struct FirstDocument {
  Document document;
  std::string doubt;
};
FirstDocument first_document(const ViewOptions& options, const TriMesh& mesh);

/// What is said over a surface that was opened: what is there again, else how it is turned where its way up is not
/// sure, else how one begins.
std::string first_words(const SessionWork& work, bool worn);

/// Of all vertices that triangles use and whose places are numbers, mm of the scan; min > max where there are none.
Box surface_box(const TriMesh& mesh);

}  // namespace dubsar::app
