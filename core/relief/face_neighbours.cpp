#include "core/relief/face_neighbours.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"

namespace dubsar {
namespace {

/// The neighbours of one face after another, without allocation in the steady state.
class Gatherer {
 public:
  explicit Gatherer(const QuadMesh& mesh) : mesh_(mesh) {}

  /// Appends the entries of `face`, rising by face id, to `out`; returns how many.
  std::uint32_t append(std::uint32_t face, std::vector<std::uint32_t>& out) {
    found_.clear();
    const auto visit = [&](std::uint32_t vertex) {
      for (const std::uint32_t other : mesh_.quads_of(vertex))
        if (other != face) found_.push_back(other);
    };
    if (!mesh_.has_doubled(face)) {
      for (const std::uint32_t v : mesh_.quads[face]) visit(v);
    } else {
      const Polygon polygon = mesh_.polygon(face);
      for (int i = 0; i < polygon.size; ++i) visit(polygon.vertex[static_cast<std::size_t>(i)]);
    }
    std::sort(found_.begin(), found_.end());
    const std::size_t before = out.size();
    for (std::size_t i = 0; i < found_.size();) {
      std::size_t j = i + 1;
      while (j < found_.size() && found_[j] == found_[i]) ++j;
      const auto weight = static_cast<std::uint32_t>(std::min<std::size_t>(j - i, 3));
      out.push_back(found_[i] | weight << FaceNeighbours::kIndexBits);
      i = j;
    }
    return static_cast<std::uint32_t>(out.size() - before);
  }

 private:
  const QuadMesh& mesh_;
  std::vector<std::uint32_t> found_;
};

void fill_chunk(Gatherer& gatherer, std::uint32_t first_face, int faces, std::vector<std::uint32_t>& lists,
                FaceNeighbours::Chunk& chunk) {
  constexpr int kLanes = FaceNeighbours::kLanes;
  std::array<std::uint32_t, FaceNeighbours::kChunkFaces> start{}, degree{};
  lists.clear();
  for (int i = 0; i < faces; ++i) {
    start[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(lists.size());
    degree[static_cast<std::size_t>(i)] = gatherer.append(first_face + static_cast<std::uint32_t>(i), lists);
  }
  std::array<std::uint16_t, FaceNeighbours::kChunkFaces> rank;
  std::iota(rank.begin(), rank.end(), std::uint16_t{0});
  std::stable_sort(rank.begin(), rank.begin() + faces, [&](auto a, auto b) { return degree[a] > degree[b]; });

  chunk.faces = faces;
  for (int slice = 0; slice < FaceNeighbours::kSlices; ++slice) {
    const auto s = static_cast<std::size_t>(slice);
    const int widest = slice * kLanes;
    chunk.first_row[s + 1] =
        chunk.first_row[s] + (widest < faces ? degree[rank[static_cast<std::size_t>(widest)]] : 0u);
  }
  chunk.entries.resize(std::size_t{chunk.first_row.back()} * kLanes);
  for (std::size_t i = 0; i < chunk.order.size(); ++i) {
    const bool used = static_cast<int>(i) < faces;
    chunk.order[i] = first_face + (used ? rank[i] : 0u);
    const std::size_t slice = i / kLanes, lane = i % kLanes;
    const std::uint32_t rows = chunk.first_row[slice + 1] - chunk.first_row[slice];
    std::uint32_t* column = chunk.entries.data() + std::size_t{chunk.first_row[slice]} * kLanes + lane;
    for (std::uint32_t j = 0; j < rows; ++j)
      column[std::size_t{j} * kLanes] = used && j < degree[rank[i]] ? lists[start[rank[i]] + j] : chunk.order[i];
  }
}

}  // namespace

Result<FaceNeighbours> FaceNeighbours::build(const QuadMesh& mesh, Progress& progress) {
  const std::int64_t faces = mesh.quad_count();
  if (faces > static_cast<std::int64_t>(kIndexMask))
    return fail(ErrorKind::kTryAgain, "smooth: {} x-quads, at most {} are supported: process a cropped volume", faces,
                kIndexMask);
  FaceNeighbours result;
  result.faces_ = faces;
  result.chunks_.resize(static_cast<std::size_t>((faces + kChunkFaces - 1) / kChunkFaces));
  parallel_chunks(static_cast<std::int64_t>(result.chunks_.size()), 16, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    Gatherer gatherer(mesh);
    std::vector<std::uint32_t> lists;
    for (std::int64_t c = begin; c < end; ++c)
      fill_chunk(gatherer, static_cast<std::uint32_t>(c * kChunkFaces),
                 static_cast<int>(std::min<std::int64_t>(kChunkFaces, faces - c * kChunkFaces)), lists,
                 result.chunks_[static_cast<std::size_t>(c)]);
  });
  if (progress.cancelled()) return cancelled_error();
  return result;
}

}  // namespace dubsar
