#pragma once
// The document that a session begins with, and how what it says becomes looks of the mesh.

#include "app/viewer/view_options.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// That of the options; without parts of its own it gets those of the mesh, by their names; upright where the options
/// say so.
Document first_document(const ViewOptions& options, const TriMesh& mesh);

/// The turn from the scan to the unturned view of it.
glm::dmat3 first_turn(const Box& model, const ViewDirection& direction);

/// What the stage shows for this view of the document: style, parts, and how far the envelope is lifted. `model` is the
/// box of the mesh in mm.
Shown shown_of(const Document& document, const ViewState& view, const StageOptions& stage, const Box& model);

}  // namespace dubsar::app
