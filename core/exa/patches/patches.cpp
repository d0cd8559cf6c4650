#include "core/exa/patches/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "core/exa/coding/symbol_coder.h"

namespace dubsar {
namespace {
constexpr std::uint64_t kMostItemsPerByte = 8;  ///< rims, triangles and vertices of a byte

/// A number of 32 bits, 7 to a byte, lowest first, the top bit of a byte says that more follow.
class Number {
 public:
  std::uint32_t read(BitSource& from) {
    std::uint32_t result = 0;
    for (std::size_t byte = 0; byte < 5; ++byte) {
      const std::uint32_t coded = bytes_[byte].code(from, 0);
      result |= (coded & 127) << (7 * byte);
      if (coded < 128) break;
    }
    return result;
  }
  std::int32_t read_signed(BitSource& from) {
    const std::uint32_t coded = read(from);
    return static_cast<std::int32_t>(coded >> 1) ^ -static_cast<std::int32_t>(coded & 1);
  }

 private:
  std::array<BitTree<8>, 5> bytes_;
};

/// Vertex ids: one of the last 32 different ones, the next vertex of the patch that was not named yet, or any.
class Ids {
 public:
  explicit Ids(std::uint32_t first_extra) : next_extra_(first_extra) {}
  std::uint32_t read(BitSource& from) {
    const std::uint32_t kind = kind_.code(from, 0);
    std::uint32_t id = next_extra_;
    if (kind == 0)
      id = recent_[place_.code(from, 0)];
    else if (kind != 1)
      id = last_ = last_ + static_cast<std::uint32_t>(any_.read_signed(from));
    if (id == next_extra_) ++next_extra_;
    const auto at = std::find(recent_.begin(), recent_.end(), id);
    std::rotate(recent_.begin(), at == recent_.end() ? at - 1 : at, at == recent_.end() ? at : at + 1);
    recent_[0] = id;
    return id;
  }

 private:
  std::array<std::uint32_t, 32> recent_ = [] {
    std::array<std::uint32_t, 32> none{};
    none.fill(0xFFFFFFFFu);
    return none;
  }();
  std::uint32_t next_extra_, last_ = 0;
  BitTree<2> kind_;
  BitTree<5> place_;
  Number any_;
};

float at_steps(std::int64_t k) { return static_cast<float>(static_cast<double>(k) * kPatchStep); }
using Steps = std::array<std::int64_t, 3>;

/// Sixteenths of kPatchStep.
Steps fine_steps_of(const glm::vec3& p) {
  Steps k;
  for (int a = 0; a < 3; ++a) k[static_cast<std::size_t>(a)] = std::llround(static_cast<double>(p[a]) * 1024.0);
  return k;
}

/// The triangles of the walk with the ids of the model.
std::vector<Triangle> named_triangles(std::span<const std::uint32_t> rim, std::span<const Triangle> walked,
                                      std::uint32_t vertex_count) {
  const auto count = static_cast<std::uint32_t>(rim.size());
  std::vector<Triangle> triangles(walked.begin(), walked.end());
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) v = v < count ? rim[v] : v - count + vertex_count;
  return triangles;
}

/// Where a rim can go on from vertex `from`: along the x-quads of the partition that end there.
std::vector<std::uint32_t> rim_candidates(const PatchSurroundings& around, PartitionId partition, std::uint32_t from) {
  std::vector<std::uint32_t> before, behind;
  for (const std::uint32_t q : around.mesh.quads_of(from)) {
    if ((around.quad_partition.empty() ? PartitionId{0} : around.quad_partition[q]) != partition) continue;
    const Polygon polygon = around.mesh.polygon(q);
    int at = 0;
    while (polygon.vertex[static_cast<std::size_t>(at)] != from) ++at;
    before.push_back(polygon.vertex[static_cast<std::size_t>((at + polygon.size - 1) % polygon.size)]);
    behind.push_back(polygon.vertex[static_cast<std::size_t>((at + 1) % polygon.size)]);
  }
  std::erase_if(before, [&](std::uint32_t w) { return std::find(behind.begin(), behind.end(), w) != behind.end(); });
  return before;
}

/// Reads the patches of a model. `most` bounds all counts.
class PatchReader {
 public:
  PatchReader(RangeDecoder& in, const PatchSurroundings& around, std::uint64_t most)
      : in_{in}, around_(around), vertex_count_(static_cast<std::uint32_t>(around.mesh.vertex_count())), most_(most) {}

  /// False: counts that the bytes cannot hold, or no patches.
  bool read(std::vector<FillPatch>& patches) {
    const std::uint32_t count = counts_.read(in_);
    if (count > most_ / kMostItemsPerByte) return false;
    patches.resize(count);
    for (FillPatch& patch : patches) {
      patch.partition = label();
      patch.reverse_partition = label();
      const std::uint32_t rims = counts_.read(in_);
      if (rims == 0 ? !read_loose(patch) : !read_disk(patch, rims)) return false;
    }
    return true;
  }

 private:
  /// A number that is no byte is nobody's, and refused by check_patches().
  PartitionId label() {
    constexpr std::uint32_t kByte = 255, kNobodys = 254;
    const std::uint32_t number = counts_.read(in_);
    return static_cast<PartitionId>(number > kByte ? kNobodys : number);
  }

  bool spend(std::uint64_t items) {
    most_ -= std::min(most_, items);
    return most_ > 0;
  }

  std::vector<Steps> expected_of(const DiskPatch& disk, std::size_t vertices) const {
    std::vector<Steps> rim;
    for (const std::uint32_t v : disk.rim) rim.push_back(fine_steps_of(around_.mesh.positions[v]));
    const bool one = disk.rims.size() == 1 && !rim.empty();
    std::vector<Steps> expected =
        one ? relaxed_disk(rim, disk.triangles, vertices) : spread_disk(rim, disk.triangles, vertices);
    for (Steps& p : expected)
      for (std::int64_t& v : p) v = divided(v + 8, 16);
    return expected;
  }
  /// How far the known neighbours lie from where they were expected; those of the rim lie there.
  static Steps mean_apart(std::span<const std::uint32_t> around, std::size_t rim, std::size_t own,
                          const std::vector<Steps>& apart) {
    Steps mean{0, 0, 0};
    std::int64_t known = 0;
    for (const std::uint32_t w : around) {
      if (w >= rim + own) continue;
      ++known;
      if (w < rim) continue;
      for (std::size_t a = 0; a < 3; ++a) mean[a] += apart[w - rim][a];
    }
    if (known == 0 && own > 0) return apart[own - 1];  // the first of a closed piece
    if (known > 0)
      for (std::int64_t& v : mean) v = divided(2 * v + known, 2 * known);
    return mean;
  }

  bool read_rims(PartitionId partition, std::uint32_t rims, DiskPatch& disk) {
    if (!spend(rims)) return false;
    disk.rims.resize(rims);
    for (std::uint32_t& count : disk.rims) {
      count = counts_.read(in_);
      if (!spend(count) || !read_rim(partition, count, disk.rim)) return false;
    }
    return true;
  }
  bool read_rim(PartitionId partition, std::uint32_t count, std::vector<std::uint32_t>& rim) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t before = i == 0 ? first_ : rim.back(), kind = i == 0 ? 3u : way_.code(in_, 0);
      std::uint32_t vertex = 0;
      if (kind < 3) {
        const std::vector<std::uint32_t> next = rim_candidates(around_, partition, before);
        if (kind >= next.size()) return false;
        vertex = next[kind];
      } else {
        vertex = before + static_cast<std::uint32_t>(ids_.read_signed(in_));
      }
      if (vertex >= vertex_count_) return false;
      if (i == 0) first_ = vertex;
      rim.push_back(vertex);
    }
    return true;
  }

  bool read_disk(FillPatch& patch, std::uint32_t rims) {
    DiskPatch disk;
    if (!read_rims(patch.partition, rims, disk)) return false;
    std::uint32_t last = 0;
    const auto choose = [&](const DiskEdge& edge) -> std::optional<DiskChoice> {
      if (!spend(1)) return std::nullopt;
      const DiskNode& here = edge.border[edge.node];
      const std::size_t context = (std::size_t{last} * 8 + edge.triangles_at[here.vertex]) * 8 +
                                  edge.triangles_at[edge.border[here.next].vertex];
      last = steps_[context].code(in_, 0);
      DiskChoice choice{static_cast<DiskStep>(last)};
      if (choice.step == DiskStep::kOther) choice.distance = distances_.read_signed(in_);
      if (choice.step == DiskStep::kOther && choice.distance == 0) choice.node = nodes_.read(in_);
      return choice;
    };
    if (!walk_disk(disk.rims, std::max<std::uint64_t>(most_, 1), choose, disk.triangles)) return false;
    std::size_t vertices = 0;
    for (const Triangle& t : disk.triangles)
      for (const std::uint32_t v : t)
        vertices = std::max(vertices, v < disk.rim.size() ? std::size_t{0} : v - disk.rim.size() + 1);
    const std::vector<Steps> expected = expected_of(disk, vertices);
    const DiskNeighbours neighbours(static_cast<std::uint32_t>(disk.rim.size()), vertices, disk.triangles);
    std::vector<Steps> apart(vertices);
    patch.extra_positions.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      apart[i] = mean_apart(neighbours.of(i), disk.rim.size(), i, apart);
      for (std::size_t a = 0; a < 3; ++a) {
        apart[i][a] += residuals_[a].code(in_, 0);
        patch.extra_positions[i][static_cast<int>(a)] = at_steps(expected[i][a] + apart[i][a]);
      }
    }
    patch.triangles = named_triangles(disk.rim, disk.triangles, vertex_count_);
    return true;
  }

  bool read_loose(FillPatch& patch) {
    const std::uint32_t extra = counts_.read(in_), triangles = counts_.read(in_);
    if (!spend(std::uint64_t{extra} + triangles)) return false;
    patch.extra_positions.resize(extra);
    patch.triangles.resize(triangles);
    for (glm::vec3& p : patch.extra_positions)
      for (int a = 0; a < 3; ++a) p[a] = std::bit_cast<float>(floats_.read(in_));
    Ids ids(vertex_count_);
    for (Triangle& t : patch.triangles)
      for (std::uint32_t& id : t) id = ids.read(in_);
    return true;
  }

  BitSource in_;
  const PatchSurroundings& around_;
  std::uint32_t vertex_count_, first_ = 0;
  std::uint64_t most_;
  Number counts_, ids_, distances_, nodes_, floats_;
  BitTree<2> way_;
  std::array<BitTree<2>, 256> steps_;  ///< by the step before and the triangles at both ends
  std::array<SignedNumber, 3> residuals_;
};

Result<void> check_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count) {
  for (const FillPatch& patch : patches) {
    if (patch.partition > PartitionTable::kHighest ||
        (patch.reverse_partition > PartitionTable::kHighest && patch.reverse_partition != PartitionTable::kNone))
      return fail(ErrorKind::kBadData, "exa: a fill patch names partition {} and {}, expected 0..{}", patch.partition,
                  patch.reverse_partition, PartitionTable::kHighest);
    for (const glm::vec3& p : patch.extra_positions)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return fail(ErrorKind::kBadData, "exa: a vertex of a fill patch is not finite");
    const std::int64_t end = vertex_count + static_cast<std::int64_t>(patch.extra_positions.size());
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t)
        if (std::int64_t{v} >= end)
          return fail(ErrorKind::kBadData, "exa: a fill patch names vertex {}, but there are {}", v, end);
  }
  return {};
}

}  // namespace

Result<std::vector<FillPatch>> decode_patches(std::span<const std::string_view> chunks,
                                              const PatchSurroundings& around) {
  if (chunks.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} chunks of fill patches found, 1 expected", chunks.size());
  RangeDecoder in(chunks[0]);
  std::vector<FillPatch> patches;
  if (!PatchReader(in, around, kMostItemsPerByte * (chunks[0].size() + 8)).read(patches))
    return fail(ErrorKind::kBadData, "exa: the fill patches are more than {} bytes can hold, or have no border",
                chunks[0].size());
  DUBSAR_TRY(check_patches(patches, around.mesh.vertex_count()));
  return patches;
}

Result<void> decode_patch_evidence(std::span<const std::string_view> chunks, std::vector<FillPatch>& patches) {
  if (chunks.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} chunks of the patches' evidence found, 1 expected", chunks.size());
  RangeDecoder in(chunks[0]);
  BitSource source{in};
  AdaptiveBit present;
  std::array<BitTree<2>, 16> models;  // by the two vertices before
  for (FillPatch& patch : patches) {
    patch.evidence.resize(source.bit(present, false) ? patch.extra_positions.size() : 0);
    std::size_t before = 0;
    for (std::uint8_t& evidence : patch.evidence) {
      evidence = static_cast<std::uint8_t>(models[before].code(source, 0));
      before = (before << 2 | evidence) & 15;
    }
  }
  return {};
}

}  // namespace dubsar
