#pragma once
// The document that a session begins with, and how what it says becomes looks of the mesh.

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
std::string first_words(const SessionWork& work);

/// Of all vertices that triangles use and whose places are numbers, mm of the scan; min > max where there are none.
Box surface_box(const TriMesh& mesh);

/// The turn from the scan to the unturned view of it.
glm::dmat3 first_turn(const Box& model, const ViewDirection& direction);

/// The parts of the document as they are looked at and where they stand: as far apart as it says, each half of the way,
/// pores with the body that they lie in. `model` is the box of the mesh in mm.
PartLooks laid_out(const Document& document, PartLooks looks, const Box& model);

/// What the stage shows for this view of the document: style, parts, and how far the envelope is lifted. `model` is the
/// box of the mesh in mm.
Shown shown_of(const Document& document, const ViewState& view, const StageOptions& stage, const Box& model);

}  // namespace dubsar::app
