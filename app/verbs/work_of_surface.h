#pragma once
// What people kept of a surface, for verbs that write of it: the record of the tablet, lines, notes, measures.

#include <string>
#include <vector>

#include "app/document/document.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// What is known of the file that a surface was read from. Errors of file_checksum().
Result<SourceFile> source_of(const std::string& file, const TriMesh& mesh);

/// The work that sessions left of a surface; without any the document of a surface that nobody worked on. Errors of
/// source_of().
Result<Document> kept_work(const std::string& file, const TriMesh& mesh);

/// Its lines as a reader finds them on a sheet: "obverse", then "1  a-na ...".
std::vector<std::string> text_rows(const Document& document);

}  // namespace dubsar::app
