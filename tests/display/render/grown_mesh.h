#pragma once
// A mesh whose levels of detail are all there.

#include <chrono>
#include <thread>
#include <utility>

#include "display/render/mesh/lod_mesh.h"

namespace dubsar::testing {

/// Waits for the thread that makes them.
inline LodMesh grown_mesh(PackedMesh mesh) {
  LodMesh lod = LodMesh::growing(std::move(mesh)).value();
  while (!lod.complete()) {
    static_cast<void>(lod.update().value());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return lod;
}

}  // namespace dubsar::testing
