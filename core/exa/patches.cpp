#include "core/exa/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/exa/symbol_coder.h"

namespace dubsar {
namespace {
constexpr std::uint64_t kMostPerByte = 2048;  ///< triangles or vertices of a byte: a flat grid needs .01 bit each

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

bool is_settled(const FillPatch& patch) {
  return std::all_of(patch.extra_positions.begin(), patch.extra_positions.end(), [](const glm::vec3& p) {
    for (int a = 0; a < 3; ++a)
      if (!(std::abs(p[a]) < 100000.0f) ||
          std::bit_cast<std::uint32_t>(at_steps(steps_of(p[a]))) != std::bit_cast<std::uint32_t>(p[a]))
        return false;
    return true;
  });
}

/// Encoder and decoder are one walk. False: counts that the bytes cannot hold.
template <class Coder>
bool code_patches(Coder& coder, std::vector<FillPatch>& patches, std::uint32_t vertex_count, std::uint64_t most) {
  Number counts, coordinates[3], raw;
  const std::uint32_t count = counts.code(coder, static_cast<std::uint32_t>(patches.size()));
  if (count > most) return false;
  patches.resize(count);
  std::uint64_t all = 0;
  for (FillPatch& patch : patches) {
    patch.partition = static_cast<std::uint8_t>(counts.code(coder, patch.partition));
    patch.reverse_partition = static_cast<std::uint8_t>(counts.code(coder, patch.reverse_partition));
    const std::uint32_t extra = counts.code(coder, static_cast<std::uint32_t>(patch.extra_positions.size()));
    const std::uint32_t triangles = counts.code(coder, static_cast<std::uint32_t>(patch.triangles.size()));
    all += std::uint64_t{extra} + triangles;
    if (all > most) return false;
    const bool settled = counts.code(coder, is_settled(patch) ? 1u : 0u) != 0;
    patch.extra_positions.resize(extra);
    patch.triangles.resize(triangles);
    std::int32_t before[3] = {0, 0, 0};
    for (glm::vec3& p : patch.extra_positions)
      for (int a = 0; a < 3; ++a) {
        if (!settled) {
          p[a] = std::bit_cast<float>(raw.code(coder, std::bit_cast<std::uint32_t>(p[a])));
          continue;
        }
        const auto k = static_cast<std::int32_t>(std::isfinite(p[a]) ? steps_of(p[a]) : 0);
        before[a] =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(before[a]) +
                                      static_cast<std::uint32_t>(coordinates[a].code_signed(coder, k - before[a])));
        p[a] = at_steps(before[a]);
      }
    IdCode ids(vertex_count);
    for (Triangle& t : patch.triangles)
      for (std::uint32_t& id : t) id = ids.code(coder, id);
  }
  return true;
}
}  // namespace

void settle_patches(std::vector<FillPatch>& patches) {
  for (FillPatch& patch : patches)
    for (glm::vec3& p : patch.extra_positions)
      for (int a = 0; a < 3; ++a)
        if (std::abs(p[a]) < 100000.0f) p[a] = at_steps(steps_of(p[a]));
}

std::vector<std::string> encode_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count) {
  std::vector<FillPatch> copy = patches;
  RangeEncoder out;
  BitSink sink{out};
  code_patches(sink, copy, static_cast<std::uint32_t>(vertex_count), ~std::uint64_t{0});
  return {out.take()};
}

Result<std::vector<FillPatch>> decode_patches(std::span<const std::string_view> chunks, std::int64_t vertex_count) {
  if (chunks.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} chunks of fill patches found, 1 expected", chunks.size());
  RangeDecoder in(chunks[0]);
  BitSource source{in};
  std::vector<FillPatch> patches;
  if (!code_patches(source, patches, static_cast<std::uint32_t>(vertex_count), kMostPerByte * (chunks[0].size() + 8)))
    return fail(ErrorKind::kBadData, "exa: more fill patches are announced than {} bytes can hold", chunks[0].size());
  DUBSAR_TRY(check_patches(patches, vertex_count));
  return patches;
}

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

}  // namespace dubsar
