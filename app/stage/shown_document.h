#pragma once
// How what a document says becomes looks of the mesh.

#include "app/document/document.h"
#include "app/stage/stage.h"

namespace dubsar::app {

/// The turn from the scan to the unturned view of it.
glm::dmat3 first_turn(const Box& model, const ViewDirection& direction);

/// The parts of the document as they are looked at and where they stand: as far apart as it says, each half of the way,
/// pores with the body that they lie in. `model` is the box of the mesh in mm.
PartLooks laid_out(const Document& document, PartLooks looks, const Box& model);

/// What the stage shows for this view of the document: style, parts, and how far the envelope is lifted. `model` is the
/// box of the mesh in mm.
Shown shown_of(const Document& document, const ViewState& view, const StageOptions& stage, const Box& model);

}  // namespace dubsar::app
