#include "core/contact/pockets.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "core/base/system/parallel_gather.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr float kVoteRim = 3.0f;     ///< steps from a patch within which the labels of faces are only a vote
constexpr float kRimVote = 0.4f;     ///< for the label that a face has
constexpr float kFacingVote = 0.6f;  ///< for the side that it looks like, times the cosine

/// Area vector towards the air.
glm::vec3 area_vector(const QuadMesh& mesh, std::uint32_t quad) {
  const auto& v = mesh.quads[quad];
  return 0.5f * glm::cross(mesh.positions[v[2]] - mesh.positions[v[0]], mesh.positions[v[3]] - mesh.positions[v[1]]);
}

/// What is neither tablet nor envelope: cavities in the clay and crumbs of it.
bool is_rest(const SurfaceModel& model, std::uint32_t quad) {
  return model.partitions[model.quad_partition[quad]].kind == PartitionKind::kPores;
}

struct RestPiece {
  std::vector<std::uint32_t> quads;
  double volume = 0.0;  ///< below 0: of air
};
struct RestPieces {
  std::unordered_map<std::uint32_t, std::uint32_t> piece_of;  ///< by quad
  std::vector<RestPiece> all;
};

/// The closed pieces that have faces in the band.
RestPieces rest_pieces(const SurfaceModel& model, const FaceGraph& graph, const std::vector<BandFace>& faces) {
  RestPieces pieces;
  for (const BandFace& face : faces) {
    if (!is_rest(model, face.quad) || pieces.piece_of.count(face.quad) != 0) continue;
    const auto piece = static_cast<std::uint32_t>(pieces.all.size());
    std::vector<std::uint32_t> queue{face.quad};
    pieces.piece_of.emplace(face.quad, piece);
    double volume = 0.0;
    const glm::vec3 origin = graph.centre[face.quad];
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t f = queue[i];
      volume += static_cast<double>(glm::dot(graph.centre[f] - origin, graph.normal[f]) * graph.area[f]) / 3.0;
      for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
        const std::uint32_t g = graph.neighbour[s];
        if (g != FaceGraph::kNone && pieces.piece_of.emplace(g, piece).second) queue.push_back(g);
      }
    }
    pieces.all.push_back({std::move(queue), volume});
  }
  return pieces;
}

/// Where the clay around a piece lies.
struct Extent {
  float nearest = INFINITY, lowest = INFINITY, highest = -INFINITY;
  void add(const ContactBand::Node& node) {
    nearest = std::min(nearest, node.distance);
    lowest = std::min(lowest, node.height);
    highest = std::max(highest, node.height);
  }
  // Clay is half a step from the air on average.
  float away() const { return nearest + 0.5f; }
  float across() const { return highest - lowest - 1.0f; }
};

}  // namespace

std::vector<BandFace> faces_of_band(const SurfaceModel& model, const EdgeIndex& index, const ContactBand& band) {
  const BitVolume& signs = model.samples.signs;
  return parallel_gather<BandFace>(
      static_cast<std::int64_t>(band.nodes.size()), 1 << 14,
      [&](std::int64_t begin, std::int64_t end, std::vector<BandFace>& faces) {
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n)
          for (int axis = 0; axis < 3; ++axis)
            for (const int sense : {-1, 1}) {
              const glm::ivec3 p = band.point(n), q = p + sense * unit_step(axis), start = sense < 0 ? q : p;
              if (!signs.get(q.x, q.y, q.z)) faces.push_back({index.quad_of(axis, start.x, start.y, start.z), n});
            }
      });
}

std::vector<ClayCavity> cavities_off_contact(const SurfaceModel& model, const FaceGraph& graph, const ContactBand& band,
                                             const std::vector<BandFace>& faces) {
  const RestPieces pieces = rest_pieces(model, graph, faces);
  std::vector<Extent> extents(pieces.all.size());
  std::vector<ClayCavity> around(pieces.all.size());
  for (const BandFace& face : faces) {
    const auto piece = pieces.piece_of.find(face.quad);
    if (piece == pieces.piece_of.end()) continue;
    extents[piece->second].add(band.nodes[face.node]);
    around[piece->second].push_back(face.node);
  }
  std::vector<ClayCavity> off;
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (pieces.all[i].volume >= 0.0 || extents[i].away() <= extents[i].across()) continue;
    std::sort(around[i].begin(), around[i].end());
    around[i].erase(std::unique(around[i].begin(), around[i].end()), around[i].end());
    off.push_back(std::move(around[i]));
  }
  return off;
}

std::vector<SurfaceHint> hints_of_faces(const SurfaceModel& model, const ContactBand& band,
                                        const std::vector<BandFace>& faces,
                                        const std::vector<ClayCavity>& off_contact) {
  std::vector<bool> silent(band.nodes.size(), false);
  for (const ClayCavity& cavity : off_contact)
    for (const std::uint32_t n : cavity) silent[n] = true;
  std::vector<SurfaceHint> hints;
  for (const BandFace& face : faces) {
    const PartitionKind kind = model.partitions[model.quad_partition[face.quad]].kind;
    const bool rest = kind == PartitionKind::kPores;
    if (rest && silent[face.node]) continue;
    const bool tablet = kind == PartitionKind::kTablet;
    const bool envelope = kind == PartitionKind::kEnvelopeInside || kind == PartitionKind::kEnvelopeOutside;
    if (!rest && !tablet && !envelope) continue;
    const ClaySide own = tablet ? ClaySide::kTablet : ClaySide::kEnvelope;
    if (!rest && band.nodes[face.node].distance > kVoteRim) {
      hints.push_back({face.node, own, kCertain});
      continue;
    }
    if (!rest) hints.push_back({face.node, own, kRimVote});
    const glm::vec3 n = area_vector(model.mesh, face.quad);
    const float length = glm::length(n);
    if (!(length > 0.0f)) continue;
    const float facing = glm::dot(n, band.normal(face.node)) / length;
    hints.push_back(
        {face.node, facing > 0.0f ? ClaySide::kTablet : ClaySide::kEnvelope, kFacingVote * std::abs(facing)});
  }
  return hints;
}

std::int64_t relabel_faces(SurfaceModel& model, const FaceGraph& graph, const std::vector<BandFace>& faces,
                           const std::vector<ClaySide>& side) {
  const PartitionId tablet = model.partitions.find(PartitionKind::kTablet)->id,
                    inside = model.partitions.find(PartitionKind::kEnvelopeInside)->id;
  const RestPieces pieces = rest_pieces(model, graph, faces);
  std::vector<std::array<std::int64_t, 2>> votes(pieces.all.size(), {0, 0});
  for (const BandFace& face : faces)
    if (const auto piece = pieces.piece_of.find(face.quad); piece != pieces.piece_of.end())
      ++votes[piece->second][static_cast<std::size_t>(side[face.node])];
  const auto joins = [&](std::uint32_t piece) {
    return pieces.all[piece].volume < 0.0 && votes[piece][0] > 0 && votes[piece][1] > 0;
  };
  std::vector<std::vector<std::uint32_t>> queue(pieces.all.size());
  std::int64_t pockets = 0;
  model.attributes.evidence.resize(model.mesh.positions.size(), evidence_byte(Evidence::kMeasured));
  for (std::uint32_t piece = 0; piece < pieces.all.size(); ++piece) {
    if (!joins(piece)) continue;
    ++pockets;
    for (const std::uint32_t q : pieces.all[piece].quads) {
      const Polygon polygon = model.mesh.polygon(q);
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i)
        model.attributes.evidence[polygon.vertex[i]] = evidence_byte(Evidence::kPocket);
    }
  }
  for (const BandFace& face : faces) {
    PartitionId& label = model.quad_partition[face.quad];
    const PartitionKind kind = model.partitions[label].kind;
    const auto piece = pieces.piece_of.find(face.quad);
    const bool pocket = piece != pieces.piece_of.end();
    if (pocket ? !joins(piece->second)
               : kind != PartitionKind::kTablet && kind != PartitionKind::kEnvelopeInside &&
                     kind != PartitionKind::kEnvelopeOutside)
      continue;
    if (side[face.node] == ClaySide::kTablet)
      label = tablet;
    else if (kind != PartitionKind::kEnvelopeInside && kind != PartitionKind::kEnvelopeOutside)
      label = inside;
    if (pocket) queue[piece->second].push_back(face.quad);
  }
  // Faces of a pocket beyond the band follow their neighbours.
  for (std::vector<std::uint32_t>& front : queue)
    for (std::size_t i = 0; i < front.size(); ++i)
      for (std::uint32_t s = graph.first_side[front[i]]; s < graph.first_side[front[i] + 1]; ++s) {
        const std::uint32_t g = graph.neighbour[s];
        if (g == FaceGraph::kNone || !is_rest(model, g)) continue;
        model.quad_partition[g] = model.quad_partition[front[i]];
        front.push_back(g);
      }
  return pockets;
}

}  // namespace dubsar
