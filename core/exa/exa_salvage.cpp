#include "core/exa/exa_salvage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/exa/exa_blocks.h"
#include "core/exa/exa_decode.h"
#include "core/exa/signs/sign_bricks.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

/// Blocks that cannot be understood without another one.
constexpr std::array<std::array<const char*, 2>, 12> kHangOn{{{"PART", "QPAR"},  // who is what, and where
                                                              {"QPAR", "PART"},
                                                              {"QPAR", "FILL"},
                                                              {"PART", "FILL"},
                                                              {"FILL", "FEVI"},
                                                              {"NORM", "CURV"},
                                                              {"PATT", "PQEX"},
                                                              {"PART", "LABL"},
                                                              {"LABL", "LOFS"},
                                                              {"LOFS", "LABL"},
                                                              {"LABL", "LEVI"},
                                                              {"LABL", "ESCP"}}};

bool by_bricks(const std::string& type) {
  return type == "SIG0" || type == "SIG1" || type == "SIG2" || type == "OFFS" || type == "FACE";
}

/// Of the blocks that a reader must know: what of the surface is left without them follows from the others.
bool can_be_left_out(const std::string& type) {
  return type == "ESCP" || type == "POSN" || type == "LABL" || type == "LOFS" || type == "LEVI";
}

void add_lost(std::vector<std::uint8_t>& lost, const std::vector<std::uint8_t>& more) {
  if (lost.empty()) lost.resize(more.size());
  for (std::size_t i = 0; i < std::min(lost.size(), more.size()); ++i) lost[i] |= more[i];
}

std::string brick_text(const Dims& dims, std::size_t index, const char* what) {
  const Brick brick = brick_at(dims, static_cast<std::int64_t>(index));
  return fmt::format("{} of brick {}, points {}:{}, {}:{}, {}:{}", what, index, brick.low[0],
                     std::min(dims.x, brick.low[0] + brick.cells[0] + 1), brick.low[1],
                     std::min(dims.y, brick.low[1] + brick.cells[1] + 1), brick.low[2],
                     std::min(dims.z, brick.low[2] + brick.cells[2] + 1));
}

/// Vertices in lost bricks are nobody's measurement.
void mark_inferred(const ExaDamage& damage, SurfaceModel& model) {
  std::vector<std::uint8_t>& evidence = model.attributes.evidence;
  evidence.resize(model.mesh.positions.size(), static_cast<std::uint8_t>(Evidence::kMeasured));
  const Dims grid = brick_grid(model.samples.dims);
  for (std::size_t v = 0; v < evidence.size(); ++v) {
    std::array<std::int64_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = std::max<std::int64_t>(0, static_cast<std::int64_t>(model.mesh.positions[v][static_cast<int>(a)])) /
              kBrickCells;
    const auto brick = static_cast<std::size_t>(
        (std::min(at[2], grid.z - 1) * grid.y + std::min(at[1], grid.y - 1)) * grid.x + std::min(at[0], grid.x - 1));
    if (!damage.offsets.empty() && damage.offsets[brick] != 0)
      evidence[v] = static_cast<std::uint8_t>(Evidence::kInferred);
  }
}

/// What is wrong with the blocks of a file.
struct FoundDamage {
  std::set<std::string> dropped;  ///< blocks that are not needed
  ExaDamage bricks;
  std::vector<std::string> lost;
  bool needed = false;  ///< of what cannot be left out something is
};

Result<FoundDamage> find_damage(const ExaReader& reader, const ExaHeader& header) {
  FoundDamage found;
  const auto bricks = static_cast<std::size_t>(brick_grid(header.dims).count());
  for (const ExaRow& row : reader.table().rows) {
    const Result<std::vector<std::uint8_t>> chunks = reader.damaged_chunks(row);
    if (!chunks && chunks.error().kind != ErrorKind::kBadData) return tl::unexpected<Error>(chunks.error());
    if (chunks && std::count(chunks->begin(), chunks->end(), 1) == 0) continue;
    const std::string name = exa_block_name(row.type);
    if (!by_bricks(row.type)) {
      found.needed |= (row.flags & kExaRequired) != 0 && !can_be_left_out(row.type);
      found.dropped.insert(row.type);
      found.lost.push_back(fmt::format("block \"{}\"", name));
      continue;
    }
    const std::vector<std::uint8_t> all = chunks ? *chunks : std::vector<std::uint8_t>(bricks, 1);
    found.needed |= !chunks && row.type != "OFFS";  // without the index nobody knows where chunks begin
    add_lost(row.type == "OFFS"   ? found.bricks.offsets
             : row.type == "FACE" ? found.bricks.faces
                                  : found.bricks.signs,
             all);
    for (std::size_t i = 0; i < std::min(all.size(), bricks); ++i)
      if (all[i] != 0) found.lost.push_back(brick_text(header.dims, i, name.c_str()));
  }
  if (reader.has("LABL") && !(found.bricks.signs.empty() && found.bricks.faces.empty()) &&
      found.dropped.insert("LABL").second)
    found.lost.push_back("block \"labels\", which belongs to other signs");
  for (bool more = true; more;) {
    more = false;
    for (const auto& [lost, hangs] : kHangOn)
      if (found.dropped.contains(lost) && reader.has(hangs) && found.dropped.insert(hangs).second) {
        found.lost.push_back(fmt::format("block \"{}\", which cannot be understood without \"{}\"",
                                         exa_block_name(hangs), exa_block_name(lost)));
        more = true;
      }
  }
  return found;
}

}  // namespace

Result<SalvagedExa> decode_salvaged(const ExaReader& reader, Progress& progress) {
  DUBSAR_ASSIGN(const ExaHeader header, reader.header());
  DUBSAR_ASSIGN(FoundDamage found, find_damage(reader, header));
  if (found.needed) return fail(ErrorKind::kBadData, "exa: nothing can be saved without {}", found.lost.front());
  const bool places = std::any_of(found.dropped.begin(), found.dropped.end(), can_be_left_out);
  ExaDamage& bricks = found.bricks;
  const bool damaged = places || !bricks.signs.empty() || !bricks.offsets.empty() || !bricks.faces.empty();
  if (!bricks.signs.empty()) {
    const std::vector<std::uint8_t> before = bricks.signs;
    bricks.signs = lost_with(header.dims, std::move(bricks.signs), reader.table().has(ExaFeature::kLateBricks));
    for (std::size_t i = 0; i < before.size(); ++i)
      if (bricks.signs[i] != before[i])
        found.lost.push_back(brick_text(header.dims, i, "signs, coded by those beside it,"));
    add_lost(bricks.offsets, bricks.signs);
    add_lost(bricks.faces, bricks.signs);
  }
  SalvagedExa salvaged;
  DUBSAR_ASSIGN(salvaged.model,
                decode_model(reader.without(found.dropped), {}, progress, damaged ? &found.bricks : nullptr));
  SurfaceModel& model = salvaged.model;
  if (model.mesh.vertex_count() != header.vertices || model.mesh.quad_count() != header.quads)
    found.lost.push_back("places, light, evidence, partitions and patches, which are stored in the order of vertices");
  if (!bricks.offsets.empty()) mark_inferred(bricks, model);
  salvaged.lost = std::move(found.lost);
  return salvaged;
}

}  // namespace dubsar
