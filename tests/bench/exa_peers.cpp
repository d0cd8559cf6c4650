#include "tests/bench/exa_peers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#ifdef DUBSAR_HAVE_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#endif
#ifdef DUBSAR_HAVE_MESHOPT
#include <meshoptimizer.h>
#include <zstd.h>
#endif

namespace dubsar {
namespace {

double timed(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Bits of a grid over the largest side of the mesh whose cells have at most 2 max_error between opposite corners.
[[maybe_unused]] int grid_bits(const TriMesh& mesh, double max_error, glm::vec3& low, double& side) {
  low = mesh.positions[0];
  glm::vec3 high = low;
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  side = static_cast<double>(std::max({high.x - low.x, high.y - low.y, high.z - low.z}));
  int bits = 1;
  while (side / (std::exp2(bits) - 1.0) * std::sqrt(3.0) / 2.0 > max_error) ++bits;
  return bits;
}

#ifdef DUBSAR_HAVE_DRACO
PeerResult draco_result(const TriMesh& mesh, double max_error, int level) {
  glm::vec3 low;
  double side = 0.0;
  const int bits = grid_bits(mesh, max_error, low, side);
  draco::Mesh input;
  input.SetNumFaces(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    draco::Mesh::Face face;
    for (std::size_t c = 0; c < 3; ++c) face[c] = draco::PointIndex(mesh.triangles[t][c]);
    input.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(t)), face);
  }
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  input.set_num_points(count);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = input.AddAttribute(attribute, true, count);
  for (std::uint32_t v = 0; v < count; ++v)
    input.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), &mesh.positions[v].x);
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  encoder.SetSpeedOptions(10 - level, 10 - level);
  draco::EncoderBuffer buffer;
  PeerResult result;
  result.name = fmt::format("Draco -qp {} -cl {}", bits, level);
  bool good = true;
  result.encode_s = timed([&] { good = encoder.EncodeMeshToBuffer(input, &buffer).ok(); });
  result.decode_s = timed([&] {
    draco::DecoderBuffer bytes;
    bytes.Init(buffer.data(), buffer.size());
    draco::Decoder decoder;
    good = good && decoder.DecodeMeshFromBuffer(&bytes).ok();
  });
  result.bytes = good ? buffer.size() : 0;
  result.max_error_vox = side / (std::exp2(bits) - 1.0) * std::sqrt(3.0) / 2.0;
  return result;
}
#endif

#ifdef DUBSAR_HAVE_MESHOPT
PeerResult meshopt_result(const TriMesh& mesh, double max_error) {
  glm::vec3 low;
  double side = 0.0;
  const int bits = grid_bits(mesh, max_error, low, side);
  const double step = side / (std::exp2(bits) - 1.0);
  std::vector<std::uint32_t> indices;
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  const std::size_t count = mesh.positions.size();
  PeerResult result;
  result.name = fmt::format("meshoptimizer {} bits + zstd 19", bits);
  std::string packed;
  std::vector<unsigned char> index_bytes, vertex_bytes;
  std::vector<std::array<std::uint16_t, 4>> vertices(count);
  result.encode_s = timed([&] {
    std::vector<std::uint32_t> ordered(indices.size()), remap(count);
    meshopt_optimizeVertexCacheStrip(ordered.data(), indices.data(), indices.size(), count);
    meshopt_optimizeVertexFetchRemap(remap.data(), ordered.data(), ordered.size(), count);
    meshopt_remapIndexBuffer(indices.data(), ordered.data(), ordered.size(), remap.data());
    for (std::size_t v = 0; v < count; ++v)
      for (int a = 0; a < 3; ++a)
        vertices[remap[v]][static_cast<std::size_t>(a)] =
            static_cast<std::uint16_t>(std::lround(static_cast<double>(mesh.positions[v][a] - low[a]) / step));
    index_bytes.resize(meshopt_encodeIndexBufferBound(indices.size(), count));
    index_bytes.resize(
        meshopt_encodeIndexBuffer(index_bytes.data(), index_bytes.size(), indices.data(), indices.size()));
    vertex_bytes.resize(meshopt_encodeVertexBufferBound(count, 8));
    vertex_bytes.resize(
        meshopt_encodeVertexBuffer(vertex_bytes.data(), vertex_bytes.size(), vertices.data(), count, 8));
    std::string all(index_bytes.begin(), index_bytes.end());
    all.append(vertex_bytes.begin(), vertex_bytes.end());
    packed.resize(ZSTD_compressBound(all.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), all.data(), all.size(), 19));
  });
  result.decode_s = timed([&] {
    std::string all(index_bytes.size() + vertex_bytes.size(), '\0');
    ZSTD_decompress(all.data(), all.size(), packed.data(), packed.size());
    const auto* bytes = reinterpret_cast<const unsigned char*>(all.data());
    meshopt_decodeIndexBuffer(indices.data(), indices.size(), 4, bytes, index_bytes.size());
    meshopt_decodeVertexBuffer(vertices.data(), count, 8, bytes + index_bytes.size(), vertex_bytes.size());
  });
  result.bytes = packed.size();
  result.max_error_vox = step * std::sqrt(3.0) / 2.0;
  return result;
}
#endif
}  // namespace

std::vector<PeerResult> peer_results([[maybe_unused]] const TriMesh& mesh, [[maybe_unused]] double max_error_vox) {
  std::vector<PeerResult> results;
#ifdef DUBSAR_HAVE_DRACO
  for (const int level : {10, 7}) results.push_back(draco_result(mesh, max_error_vox, level));
#endif
#ifdef DUBSAR_HAVE_MESHOPT
  results.push_back(meshopt_result(mesh, max_error_vox));
#endif
  return results;
}

}  // namespace dubsar
