#pragma once
// Other compressors on the mesh of an EXA file, where they are installed.

#include <string>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct PeerResult {
  std::string name;
  std::size_t bytes = 0;
  double encode_s = 0.0, decode_s = 0.0;
  double max_error_vox = 0.0;  ///< of a vertex
};

/// Draco and meshoptimizer with zstd: connectivity, and positions no further than `max_error_vox` from where they are.
/// Empty where neither is installed.
std::vector<PeerResult> peer_results(const TriMesh& mesh, double max_error_vox);

}  // namespace dubsar
