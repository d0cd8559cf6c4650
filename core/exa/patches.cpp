#include "core/exa/patches.h"

#include <cmath>

#include "core/base/budget.h"
#include "core/base/bytes.h"

namespace dubsar {

std::string encode_patches(const std::vector<FillPatch>& patches) {
  std::string bytes;
  append_little(bytes, static_cast<std::uint32_t>(patches.size()));
  for (const FillPatch& patch : patches) {
    append_little(bytes, patch.partition);
    append_little(bytes, patch.reverse_partition);
    append_little(bytes, std::uint16_t{0});
    append_little(bytes, static_cast<std::uint32_t>(patch.extra_positions.size()));
    append_little(bytes, static_cast<std::uint32_t>(patch.triangles.size()));
    for (const glm::vec3& p : patch.extra_positions)
      for (int axis = 0; axis < 3; ++axis) append_little(bytes, p[axis]);
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t) append_little(bytes, v);
  }
  return bytes;
}

Result<std::vector<FillPatch>> decode_patches(std::string_view bytes, std::int64_t vertex_count) {
  ByteReader reader(bytes);
  const auto count = reader.little<std::uint32_t>();
  DUBSAR_TRY(check_count("exa: fill patches", count, 12, reader.left()));
  std::vector<FillPatch> patches(count);
  for (FillPatch& patch : patches) {
    patch.partition = reader.little<std::uint8_t>();
    patch.reverse_partition = reader.little<std::uint8_t>();
    const auto zero = reader.little<std::uint16_t>();
    const auto extra = reader.little<std::uint32_t>(), triangles = reader.little<std::uint32_t>();
    if (zero != 0) return fail(ErrorKind::kBadData, "exa: a fill patch has unknown flags {}", zero);
    DUBSAR_TRY(check_count("exa: fill patch", std::uint64_t{extra} + triangles, 12, reader.left()));
    patch.extra_positions.resize(extra);
    for (glm::vec3& p : patch.extra_positions)
      for (int axis = 0; axis < 3; ++axis) p[axis] = reader.little<float>();
    patch.triangles.resize(triangles);
    for (Triangle& t : patch.triangles)
      for (std::uint32_t& v : t) v = reader.little<std::uint32_t>();
  }
  if (!reader.ok() || reader.left() > 0)
    return fail(ErrorKind::kBadData, "exa: the fill patches are not as long as they say");
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
