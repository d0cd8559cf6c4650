#include "core/relief/smoothing/face_neighbours.h"

#include <algorithm>
#include <numeric>

#include "core/base/system/parallel.h"
#include "core/relief/smoothing/id_merge.h"

namespace dubsar {
namespace {

/// The neighbours of one face after another, without allocation in the steady state.
class Gatherer {
 public:
  explicit Gatherer(const QuadMesh& mesh) : mesh_(mesh) {}

  /// Appends the entries of `face`, rising by face id, to `out`; returns how many.
  std::uint32_t append(std::uint32_t face, std::vector<std::uint32_t>& out) {
    const std::size_t before = out.size();
    if (!mesh_.has_doubled(face) && append_few(face, out)) return static_cast<std::uint32_t>(out.size() - before);
    found_.clear();
    const auto visit = [&](std::uint32_t vertex) {
      for (const std::uint32_t other : mesh_.quads_of(vertex))
        if (other != face) found_.push_back(other);
    };
    const Polygon polygon = mesh_.polygon(face);
    for (int i = 0; i < polygon.size; ++i) visit(polygon.vertex[static_cast<std::size_t>(i)]);
    std::sort(found_.begin(), found_.end());
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
  /// The usual case: at most kMergedIds quads around the four vertices.
  bool append_few(std::uint32_t face, std::vector<std::uint32_t>& out) {
    std::array<std::uint32_t, kMergedIds + 1> ids;
    std::size_t count = 0;
    for (const std::uint32_t vertex : mesh_.quads[face])
      for (const std::uint32_t other : mesh_.quads_of(vertex)) {
        ids[count] = other;
        count += other != face ? 1 : 0;
        if (count > kMergedIds) return false;
      }
    std::fill(ids.begin() + static_cast<std::ptrdiff_t>(count), ids.end(), ~std::uint32_t{0});
    const std::size_t before = out.size();
    out.resize(before + kMergedIds);
    out.resize(before + merge_ids(ids.data(), count, out.data() + before));
    return true;
  }

  const QuadMesh& mesh_;
  std::vector<std::uint32_t> found_;
};

/// Places by falling degree, equal ones in order.
template <std::size_t kCount>
void rank_by_degree(const std::array<std::uint32_t, kCount>& degree, int count,
                    std::array<std::uint16_t, kCount>& rank) {
  const auto end = degree.begin() + count;
  const std::uint32_t most = count == 0 ? 0 : *std::max_element(degree.begin(), end);
  constexpr std::uint32_t kCounted = 256;
  if (most >= kCounted) {
    std::iota(rank.begin(), rank.end(), std::uint16_t{0});
    std::stable_sort(rank.begin(), rank.begin() + count, [&](auto a, auto b) { return degree[a] > degree[b]; });
    return;
  }
  std::array<std::uint16_t, kCounted + 1> place{};  // of those of degree most - i
  for (auto d = degree.begin(); d != end; ++d) ++place[most - *d + 1];
  for (std::size_t i = 1; i <= most; ++i) place[i] = static_cast<std::uint16_t>(place[i] + place[i - 1]);
  for (int i = 0; i < count; ++i)
    rank[place[most - degree[static_cast<std::size_t>(i)]]++] = static_cast<std::uint16_t>(i);
}

void fill_chunk(Gatherer& gatherer, std::uint32_t first_face, int faces, std::vector<std::uint32_t>& lists,
                FaceNeighbours::Chunk& chunk) {
  constexpr int kLanes = FaceNeighbours::kLanes;
  std::array<std::uint32_t, FaceNeighbours::kChunkFaces> start{}, degree{};
  lists.clear();
  for (int i = 0; i < faces; ++i) {
    start[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(lists.size());
    degree[static_cast<std::size_t>(i)] = gatherer.append(first_face + static_cast<std::uint32_t>(i), lists);
  }
  std::array<std::uint16_t, FaceNeighbours::kChunkFaces> rank{};
  rank_by_degree(degree, faces, rank);

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
