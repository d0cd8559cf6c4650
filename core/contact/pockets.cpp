#include "core/contact/pockets.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "core/base/system/parallel_gather.h"
#include "core/mesh/evidence.h"
#include "core/parts/face_graph.h"

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

RestPieces rest_pieces(const SurfaceModel& model, const std::vector<BandFace>& faces) {
  RestPieces pieces;
  for (const BandFace& face : faces) {
    if (!is_rest(model, face.quad) || pieces.face_of.count(face.quad) != 0) continue;
    const auto number = static_cast<std::uint32_t>(pieces.all.size());
    RestPiece piece;
    const auto add = [&](std::uint32_t quad) {
      const auto place = static_cast<std::uint32_t>(piece.quads.size());
      if (pieces.face_of.emplace(quad, RestPieces::Face{number, place}).second) piece.quads.push_back(quad);
    };
    add(face.quad);
    const glm::vec3 origin = face_node(model.mesh, face.quad).centre;
    for (std::size_t i = 0; i < piece.quads.size(); ++i) {
      const FaceNode node = face_node(model.mesh, piece.quads[i]);
      piece.volume += static_cast<double>(glm::dot(node.centre - origin, node.normal) * node.area) / 3.0;
      for (const std::uint32_t beside : std::span(node.neighbour).first(static_cast<std::size_t>(node.sides))) {
        if (beside == FaceGraph::kNone) continue;
        piece.beside.push_back(beside);
        add(beside);
      }
      piece.first_side.push_back(static_cast<std::uint32_t>(piece.beside.size()));
    }
    pieces.all.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<ClayCavity> cavities_off_contact(const RestPieces& pieces, const ContactBand& band,
                                             const std::vector<BandFace>& faces, const std::vector<float>& strength) {
  std::vector<Extent> extents(pieces.all.size());
  std::vector<ClayCavity> around(pieces.all.size());
  for (const BandFace& face : faces) {
    const auto rest = pieces.face_of.find(face.quad);
    if (rest == pieces.face_of.end()) continue;
    extents[rest->second.piece].add(band.nodes[face.node]);
    around[rest->second.piece].push_back(face.node);
  }
  std::vector<ClayCavity> off;
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (pieces.all[i].volume >= 0.0 || extents[i].away() <= extents[i].across()) continue;
    std::sort(around[i].begin(), around[i].end());
    around[i].erase(std::unique(around[i].begin(), around[i].end()), around[i].end());
    if (!lies_in_film(band, strength, around[i])) off.push_back(std::move(around[i]));
  }
  return off;
}

std::vector<SurfaceHint> hints_of_faces(const SurfaceModel& model, const ContactBand& band,
                                        const std::vector<BandFace>& faces,
                                        const std::vector<ClayCavity>& off_contact) {
  std::vector<bool> silent(band.nodes.size(), false);
  for (const ClayCavity& cavity : off_contact)
    for (const std::uint32_t n : cavity) silent[n] = true;
  const auto add_hints = [&](const BandFace& face, std::vector<SurfaceHint>& hints) {
    const PartitionKind kind = model.partitions[model.quad_partition[face.quad]].kind;
    const bool rest = kind == PartitionKind::kPores;
    if (rest && silent[face.node]) return;
    const bool tablet = kind == PartitionKind::kTablet;
    const bool envelope = kind == PartitionKind::kEnvelopeInside || kind == PartitionKind::kEnvelopeOutside;
    if (!rest && !tablet && !envelope) return;
    const ClaySide own = tablet ? ClaySide::kTablet : ClaySide::kEnvelope;
    if (!rest && band.nodes[face.node].distance > kVoteRim) {
      hints.push_back({face.node, own, kCertain});
      return;
    }
    if (!rest) hints.push_back({face.node, own, kRimVote});
    const glm::vec3 n = area_vector(model.mesh, face.quad);
    const float length = glm::length(n);
    if (!(length > 0.0f)) return;
    const float facing = glm::dot(n, band.normal(face.node)) / length;
    hints.push_back(
        {face.node, facing > 0.0f ? ClaySide::kTablet : ClaySide::kEnvelope, kFacingVote * std::abs(facing)});
  };
  return parallel_gather<SurfaceHint>(static_cast<std::int64_t>(faces.size()), 1 << 14,
                                      [&](std::int64_t begin, std::int64_t end, std::vector<SurfaceHint>& hints) {
                                        for (std::int64_t i = begin; i < end; ++i)
                                          add_hints(faces[static_cast<std::size_t>(i)], hints);
                                      });
}

std::int64_t relabel_faces(SurfaceModel& model, const RestPieces& pieces, const std::vector<BandFace>& faces,
                           const std::vector<ClaySide>& side) {
  const PartitionId tablet = model.partitions.find(PartitionKind::kTablet)->id,
                    inside = model.partitions.find(PartitionKind::kEnvelopeInside)->id;
  std::vector<std::array<std::int64_t, 2>> votes(pieces.all.size(), {0, 0});
  for (const BandFace& face : faces)
    if (const auto rest = pieces.face_of.find(face.quad); rest != pieces.face_of.end())
      ++votes[rest->second.piece][static_cast<std::size_t>(side[face.node])];
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
    const auto rest = pieces.face_of.find(face.quad);
    const bool pocket = rest != pieces.face_of.end();
    if (pocket ? !joins(rest->second.piece)
               : kind != PartitionKind::kTablet && kind != PartitionKind::kEnvelopeInside &&
                     kind != PartitionKind::kEnvelopeOutside)
      continue;
    if (side[face.node] == ClaySide::kTablet)
      label = tablet;
    else if (kind != PartitionKind::kEnvelopeInside && kind != PartitionKind::kEnvelopeOutside)
      label = inside;
    if (pocket) queue[rest->second.piece].push_back(face.quad);
  }
  // Faces of a pocket beyond the band follow their neighbours.
  for (std::vector<std::uint32_t>& front : queue)
    for (std::size_t i = 0; i < front.size(); ++i) {
      const auto [number, place] = pieces.face_of.at(front[i]);
      const RestPiece& piece = pieces.all[number];
      for (std::uint32_t s = piece.first_side[place]; s < piece.first_side[place + 1]; ++s) {
        const std::uint32_t g = piece.beside[s];
        if (!is_rest(model, g)) continue;
        model.quad_partition[g] = model.quad_partition[front[i]];
        front.push_back(g);
      }
    }
  return pockets;
}

}  // namespace dubsar
