#include "core/exa/patches/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "core/exa/coding/symbol_coder.h"

namespace dubsar {
namespace {
constexpr std::uint64_t kMostItemsPerByte =
    8;  ///< rims, triangles and vertices of a byte; an encoder adds zeros where they are fewer

/// A number of 32 bits, 7 to a byte, lowest first, the top bit of a byte says that more follow.
class Number {
 public:
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    std::uint32_t result = 0;
    for (std::size_t byte = 0; byte < 5; ++byte) {
      const std::uint32_t part = value >> (7 * byte), more = part > 127 ? 128 : 0;
      const std::uint32_t coded = bytes_[byte].code(coder, (part & 127) | more);
      result |= (coded & 127) << (7 * byte);
      if (coded < 128) break;
    }
    return result;
  }
  template <class Coder>
  std::int32_t code_signed(Coder& coder, std::int32_t value) {
    const std::uint32_t coded =
        code(coder, (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31));
    return static_cast<std::int32_t>(coded >> 1) ^ -static_cast<std::int32_t>(coded & 1);
  }

 private:
  std::array<BitTree<8>, 5> bytes_;
};

/// Vertex ids: one of the last 32 different ones, the next vertex of the patch that was not named yet, or any.
class IdCode {
 public:
  explicit IdCode(std::uint32_t first_extra) : next_extra_(first_extra) {}
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t id) {
    const auto place = static_cast<std::uint32_t>(std::find(recent_.begin(), recent_.end(), id) - recent_.begin());
    const std::uint32_t kind = kind_.code(coder, place < recent_.size() ? 0u : id == next_extra_ ? 1u : 2u);
    if (kind == 0) {
      id = recent_[place_.code(coder, place)];
    } else if (kind == 1) {
      id = next_extra_;
    } else {
      id = last_ + static_cast<std::uint32_t>(any_.code_signed(coder, static_cast<std::int32_t>(id - last_)));
      last_ = id;
    }
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

std::int64_t steps_of(float v) { return std::llround(static_cast<double>(v) / kPatchStep); }
float at_steps(std::int64_t k) { return static_cast<float>(static_cast<double>(k) * kPatchStep); }
using Steps = std::array<std::int64_t, 3>;

/// Sixteenths of kPatchStep.
Steps fine_steps_of(const glm::vec3& p) {
  Steps k;
  for (int a = 0; a < 3; ++a) k[static_cast<std::size_t>(a)] = std::llround(static_cast<double>(p[a]) * 1024.0);
  return k;
}

bool is_settled(const FillPatch& patch) {
  return std::all_of(patch.extra_positions.begin(), patch.extra_positions.end(), [](const glm::vec3& p) {
    for (int a = 0; a < 3; ++a)
      if (!(std::abs(p[a]) < 100000.0f) ||
          std::bit_cast<std::uint32_t>(at_steps(steps_of(p[a]))) != std::bit_cast<std::uint32_t>(p[a]))
        return false;
    return true;
  });
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

/// Reads or writes the patches of a model; encoder and decoder are one walk. `most` bounds all counts.
template <class Coder>
class PatchCode {
 public:
  PatchCode(Coder& coder, const PatchSurroundings& around, std::uint64_t most)
      : coder_(coder),
        around_(around),
        vertex_count_(static_cast<std::uint32_t>(around.mesh.vertex_count())),
        most_(most) {}

  /// False: counts that the bytes cannot hold, or no patches.
  bool code(std::vector<FillPatch>& patches) {
    const std::uint32_t count = counts_.code(coder_, static_cast<std::uint32_t>(patches.size()));
    if (count > most_ / kMostItemsPerByte) return false;
    patches.resize(count);
    for (FillPatch& patch : patches) {
      patch.partition = label(patch.partition);
      patch.reverse_partition = label(patch.reverse_partition);
      std::optional<DiskPatch> disk;
      if (Coder::kWrites) disk = compact_disk(patch);
      const std::uint32_t rims = counts_.code(coder_, disk ? static_cast<std::uint32_t>(disk->rims.size()) : 0u);
      if (rims == 0 ? !code_loose(patch) : !code_disk(patch, rims, disk ? *disk : DiskPatch())) return false;
    }
    return true;
  }

 private:
  /// A number that is no byte is nobody's, and refused by check_patches().
  PartitionId label(PartitionId own) {
    constexpr std::uint32_t kByte = 255, kNobodys = 254;
    const std::uint32_t number = counts_.code(coder_, own);
    return static_cast<PartitionId>(number > kByte ? kNobodys : number);
  }

  bool spend(std::uint64_t items) {
    most_ -= std::min(most_, items);
    return most_ > 0;
  }

  /// Nothing when code_disk() would not give back the same patch.
  std::optional<DiskPatch> compact_disk(const FillPatch& patch) const {
    if (!is_settled(patch)) return std::nullopt;
    std::optional<DiskPatch> disk = disk_of(patch, vertex_count_);
    if (!disk || named_triangles(disk->rim, disk->triangles, vertex_count_) != patch.triangles) return std::nullopt;
    const std::vector<Steps> residuals = residuals_of(patch, *disk, expected_of(*disk, patch.extra_positions.size()));
    for (const Steps& r : residuals)
      for (const std::int64_t v : r)
        if (v < -kLargest || v > kLargest) return std::nullopt;
    return disk;
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
  static std::vector<Steps> residuals_of(const FillPatch& patch, const DiskPatch& disk,
                                         const std::vector<Steps>& expected) {
    const DiskNeighbours neighbours(static_cast<std::uint32_t>(disk.rim.size()), expected.size(), disk.triangles);
    std::vector<Steps> apart(expected.size()), residuals(expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Steps near = mean_apart(neighbours.of(i), disk.rim.size(), i, apart);
      for (std::size_t a = 0; a < 3; ++a) {
        apart[i][a] = steps_of(patch.extra_positions[i][static_cast<int>(a)]) - expected[i][a];
        residuals[i][a] = apart[i][a] - near[a];
      }
    }
    return residuals;
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

  bool code_rims(PartitionId partition, std::uint32_t rims, DiskPatch& disk) {
    if (!spend(rims)) return false;
    disk.rims.resize(rims);
    for (std::uint32_t& count : disk.rims) {
      std::vector<std::uint32_t> rim;
      if (Coder::kWrites) rim.assign(disk.rim.begin(), disk.rim.begin() + count);
      count = counts_.code(coder_, count);
      if (!spend(count)) return false;
      rim.resize(count);
      if (!code_rim(partition, rim)) return false;
      disk.rim.insert(disk.rim.end(), rim.begin(), rim.end());
      if (Coder::kWrites) disk.rim.erase(disk.rim.begin(), disk.rim.begin() + count);  // comes round
    }
    return true;
  }
  bool code_rim(PartitionId partition, std::vector<std::uint32_t>& rim) {
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const std::uint32_t before = i == 0 ? first_ : rim[i - 1];
      std::vector<std::uint32_t> next;
      if (i > 0) next = rim_candidates(around_, partition, before);
      const auto place = static_cast<std::uint32_t>(std::find(next.begin(), next.end(), rim[i]) - next.begin());
      const std::uint32_t kind =
          i == 0 ? 3u : way_.code(coder_, place < next.size() ? std::min<std::uint32_t>(place, 3) : 3);
      if (kind < 3) {
        if (kind >= next.size()) return false;
        rim[i] = next[kind];
      } else {
        rim[i] =
            before + static_cast<std::uint32_t>(ids_.code_signed(coder_, static_cast<std::int32_t>(rim[i] - before)));
      }
      if (rim[i] >= vertex_count_) return false;
      if (i == 0) first_ = rim[0];
    }
    return true;
  }

  bool code_disk(FillPatch& patch, std::uint32_t rims, DiskPatch disk) {
    if (!code_rims(patch.partition, rims, disk)) return false;
    std::size_t done = 0;
    std::uint32_t last = 0;
    const auto choose = [&](const DiskEdge& edge) -> std::optional<DiskChoice> {
      if (!spend(1)) return std::nullopt;
      const DiskNode& here = edge.border[edge.node];
      const std::size_t context = (std::size_t{last} * 8 + edge.triangles_at[here.vertex]) * 8 +
                                  edge.triangles_at[edge.border[here.next].vertex];
      DiskChoice choice = Coder::kWrites ? disk.choices[done] : DiskChoice();
      last = steps_[context].code(coder_, static_cast<std::uint32_t>(choice.step));
      choice.step = static_cast<DiskStep>(last);
      if (choice.step == DiskStep::kOther) choice.distance = distances_.code_signed(coder_, choice.distance);
      if (choice.step == DiskStep::kOther && choice.distance == 0) choice.node = nodes_.code(coder_, choice.node);
      ++done;
      return choice;
    };
    std::vector<Triangle> walked;
    if (!walk_disk(disk.rims, std::max<std::uint64_t>(most_, 1), choose, walked)) return false;
    disk.triangles = std::move(walked);
    std::size_t vertices = 0;
    for (const Triangle& t : disk.triangles)
      for (const std::uint32_t v : t)
        vertices = std::max(vertices, v < disk.rim.size() ? std::size_t{0} : v - disk.rim.size() + 1);
    const std::vector<Steps> expected = expected_of(disk, vertices);
    std::vector<Steps> residuals;
    if (Coder::kWrites) residuals = residuals_of(patch, disk, expected);
    const DiskNeighbours neighbours(static_cast<std::uint32_t>(disk.rim.size()), vertices, disk.triangles);
    std::vector<Steps> apart(vertices);
    patch.extra_positions.resize(vertices);
    NearCoder<Coder> near(coder_);
    for (std::size_t i = 0; i < vertices; ++i) {
      apart[i] = mean_apart(neighbours.of(i), disk.rim.size(), i, apart);
      for (std::size_t a = 0; a < 3; ++a) {
        apart[i][a] += residuals_[a].code(near.coder, Coder::kWrites ? static_cast<std::int32_t>(residuals[i][a]) : 0);
        patch.extra_positions[i][static_cast<int>(a)] = at_steps(expected[i][a] + apart[i][a]);
      }
    }
    patch.triangles = named_triangles(disk.rim, disk.triangles, vertex_count_);
    return true;
  }

  bool code_loose(FillPatch& patch) {
    const std::uint32_t extra = counts_.code(coder_, static_cast<std::uint32_t>(patch.extra_positions.size()));
    const std::uint32_t triangles = counts_.code(coder_, static_cast<std::uint32_t>(patch.triangles.size()));
    if (!spend(std::uint64_t{extra} + triangles)) return false;
    patch.extra_positions.resize(extra);
    patch.triangles.resize(triangles);
    for (glm::vec3& p : patch.extra_positions)
      for (int a = 0; a < 3; ++a) p[a] = std::bit_cast<float>(floats_.code(coder_, std::bit_cast<std::uint32_t>(p[a])));
    IdCode ids(vertex_count_);
    for (Triangle& t : patch.triangles)
      for (std::uint32_t& id : t) id = ids.code(coder_, id);
    return true;
  }

  static constexpr std::int64_t kLargest = (1 << 15) - 1;  ///< of a SignedNumber
  Coder& coder_;
  const PatchSurroundings& around_;
  std::uint32_t vertex_count_, first_ = 0;
  std::uint64_t most_;
  Number counts_, ids_, distances_, nodes_, floats_;
  BitTree<2> way_;
  std::array<BitTree<2>, 256> steps_;  ///< by the step before and the triangles at both ends
  std::array<SignedNumber, 3> residuals_;
};

std::uint64_t items_of(const std::vector<FillPatch>& patches) {
  std::uint64_t items = 4 * patches.size();
  for (const FillPatch& patch : patches) items += patch.extra_positions.size() + 2 * patch.triangles.size();
  return items;
}
}  // namespace

void settle_patches(std::vector<FillPatch>& patches, std::int64_t vertex_count) {
  for (FillPatch& patch : patches) {
    for (glm::vec3& p : patch.extra_positions)
      for (int a = 0; a < 3; ++a)
        if (std::abs(p[a]) < 100000.0f) p[a] = at_steps(steps_of(p[a]));
    const auto disk = disk_of(patch, static_cast<std::uint32_t>(vertex_count));
    if (!disk) continue;
    std::vector<glm::vec3> extra;
    for (const std::uint32_t v : disk->order) extra.push_back(patch.extra_positions[v]);
    patch.extra_positions = std::move(extra);
    if (!patch.evidence.empty()) {
      std::vector<std::uint8_t> evidence;
      for (const std::uint32_t v : disk->order) evidence.push_back(patch.evidence[v]);
      patch.evidence = std::move(evidence);
    }
    patch.triangles = named_triangles(disk->rim, disk->triangles, static_cast<std::uint32_t>(vertex_count));
  }
}

std::vector<std::string> encode_patches(const std::vector<FillPatch>& patches, const PatchSurroundings& around) {
  std::vector<FillPatch> copy = patches;
  RangeEncoder out;
  BitSink sink{out};
  PatchCode(sink, around, ~std::uint64_t{0}).code(copy);
  std::string bytes = out.take();
  bytes.resize(std::max<std::size_t>(bytes.size(), items_of(patches) / kMostItemsPerByte), '\0');
  return {std::move(bytes)};
}

Result<std::vector<FillPatch>> decode_patches(std::span<const std::string_view> chunks,
                                              const PatchSurroundings& around) {
  if (chunks.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} chunks of fill patches found, 1 expected", chunks.size());
  RangeDecoder in(chunks[0]);
  BitSource source{in};
  std::vector<FillPatch> patches;
  if (!PatchCode(source, around, kMostItemsPerByte * (chunks[0].size() + 8)).code(patches))
    return fail(ErrorKind::kBadData, "exa: the fill patches are more than {} bytes can hold, or have no border",
                chunks[0].size());
  DUBSAR_TRY(check_patches(patches, around.mesh.vertex_count()));
  return patches;
}

Result<void> check_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count) {
  for (const FillPatch& patch : patches) {
    if (patch.partition > PartitionTable::kHighest ||
        (patch.reverse_partition > PartitionTable::kHighest && patch.reverse_partition != PartitionTable::kNone))
      return fail(ErrorKind::kBadData, "exa: a fill patch names partition {} and {}, expected 0..{}", patch.partition,
                  patch.reverse_partition, PartitionTable::kHighest);
    if (!patch.evidence.empty() && patch.evidence.size() != patch.extra_positions.size())
      return fail(ErrorKind::kBadData, "exa: a fill patch has {} vertices but evidence for {}",
                  patch.extra_positions.size(), patch.evidence.size());
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

}  // namespace dubsar
