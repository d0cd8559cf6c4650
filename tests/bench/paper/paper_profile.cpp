#include "tests/bench/paper/paper_profile.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"
#include "core/exa/values/same_bits.h"
#include "core/exa/values/vertex_order.h"
#include "core/extract/extract.h"
#include "core/relief/curvature/shape_class.h"
#include "tests/bench/paper/bit_string.h"
#include "tests/bench/paper/paper_words.h"

namespace dubsar {
namespace {
constexpr double kMostPaperSteps = 1 << 20;
constexpr std::uint8_t kHasShapes = 1, kHasLight = 2, kHasPartitions = 4;

glm::vec3 placed(const glm::vec3& base, const std::array<std::int32_t, 3>& k) {
  return glm::vec3(glm::dvec3(base) + kPaperStep * glm::dvec3(k[0], k[1], k[2]));
}
std::optional<std::array<std::int32_t, 3>> steps_to(const glm::vec3& base, const glm::vec3& wanted) {
  std::array<std::int32_t, 3> k{};
  for (int a = 0; a < 3; ++a) {
    const double steps = (double{wanted[a]} - double{base[a]}) / kPaperStep;
    if (!(std::abs(steps) <= kMostPaperSteps)) return std::nullopt;
    k[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::lround(steps));
  }
  return k;
}

using Octahedral = std::array<std::int32_t, 2>;
Octahedral octahedral_of(const glm::vec3& normal) {
  const glm::dvec3 n(normal);
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0.0)) return {0, 0};
  double x = n.x / sum, y = n.y / sum;
  if (n.z < 0.0) {
    const double fx = (1.0 - std::abs(y)) * (x < 0.0 ? -1.0 : 1.0), fy = (1.0 - std::abs(x)) * (y < 0.0 ? -1.0 : 1.0);
    x = fx, y = fy;
  }
  return {static_cast<std::int32_t>(std::lround(x * kPaperNormalSteps)),
          static_cast<std::int32_t>(std::lround(y * kPaperNormalSteps))};
}
glm::vec3 normal_at(const Octahedral& o) {
  double x = double(o[0]) / kPaperNormalSteps, y = double(o[1]) / kPaperNormalSteps;
  const double z = 1.0 - std::abs(x) - std::abs(y);
  if (z < 0.0) {
    const double fx = (1.0 - std::abs(y)) * (x < 0.0 ? -1.0 : 1.0), fy = (1.0 - std::abs(x)) * (y < 0.0 ? -1.0 : 1.0);
    x = fx + 0.0, y = fy + 0.0;  // no -0: each normal has one form
  }
  const double length = std::sqrt(x * x + y * y + z * z);
  return glm::vec3(static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length));
}

/// `columns` numbers an item, each as its difference to the one of the item before in the chunk.
class Differences {
 public:
  explicit Differences(std::size_t columns) : before_(columns, 0) {}
  void add(std::size_t column, std::int32_t value) {
    numbers_.push_back(folded(value - before_[column]));
    before_[column] = value;
  }
  std::span<const std::uint32_t> numbers() const { return numbers_; }

 private:
  std::vector<std::int32_t> before_;
  std::vector<std::uint32_t> numbers_;
};

/// For every chunk of `columns` numbers an item: item(i, values).
template <std::size_t Columns, class Item>
Result<void> for_each_item(std::span<const std::string_view> chunks, std::size_t items, PaperWord word,
                           std::string_view what, Progress& progress, const Item& item) {
  if (static_cast<std::int64_t>(chunks.size()) != item_chunks(static_cast<std::int64_t>(items)))
    return fail(ErrorKind::kBadData, "exa: {} chunks of {} found, {} expected", chunks.size(), what,
                item_chunks(static_cast<std::int64_t>(items)));
  std::atomic<bool> broken{false};
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    const std::size_t first = static_cast<std::size_t>(c * kItemsPerChunk),
                      end = std::min(first + static_cast<std::size_t>(kItemsPerChunk), items);
    const auto numbers = unpack_words(chunks[static_cast<std::size_t>(c)], Columns * (end - first), word, what);
    if (!numbers) {
      broken = true;
      return;
    }
    std::array<std::uint32_t, Columns> sum{};
    std::array<std::int32_t, Columns> values{};
    for (std::size_t i = first; i < end; ++i) {
      for (std::size_t k = 0; k < Columns; ++k) {
        sum[k] += static_cast<std::uint32_t>(unfolded((*numbers)[(i - first) * Columns + k]));
        values[k] = static_cast<std::int32_t>(sum[k]);
      }
      item(i, values);
    }
  });
  if (progress.cancelled()) return cancelled_error();
  if (broken) return fail(ErrorKind::kBadData, "exa: a chunk of {} has another length than its numbers", what);
  return {};
}
}  // namespace

Result<SettleStats> settle_for_paper(SurfaceModel& model, const SettleOptions& options, Progress& progress) {
  SettleStats stats;
  DUBSAR_ASSIGN(const QuadMesh base, build_quad_mesh(model.samples, progress));
  if (base.positions.size() != model.mesh.positions.size() || base.quads != model.mesh.quads)
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the samples give ({} vertices)",
                model.mesh.positions.size(), base.positions.size());
  VertexAttributes& a = model.attributes;
  std::vector<double> errors;
  errors.reserve(base.positions.size());
  for (std::size_t v = 0; v < base.positions.size(); ++v) {
    const glm::vec3 wanted = model.mesh.positions[v];
    if (const auto k = steps_to(base.positions[v], wanted)) model.mesh.positions[v] = placed(base.positions[v], *k);
    errors.push_back(glm::length(glm::dvec3(model.mesh.positions[v]) - glm::dvec3(wanted)));
    stats.mean_error_vox += errors.back();
  }
  if (!errors.empty()) {
    stats.mean_error_vox /= static_cast<double>(errors.size());
    std::sort(errors.begin(), errors.end());
    stats.p95_error_vox = errors[errors.size() * 95 / 100];
    stats.max_error_vox = errors.back();
  }
  if (options.exact_normals || a.normals.empty()) return stats;
  double angles = 0.0;
  for (glm::vec3& n : a.normals) {
    const glm::vec3 moved = normal_at(octahedral_of(n));
    angles += std::acos(std::clamp<double>(glm::dot(glm::dvec3(moved), glm::dvec3(n)), -1.0, 1.0));
    n = moved;
  }
  stats.normal_error_deg = angles / std::max(1.0, static_cast<double>(a.normals.size())) * 57.29577951308232;
  if (a.k_min.empty()) return stats;
  DUBSAR_ASSIGN(Curvatures k, principal_curvatures(model.mesh, a.normals, options.curvature, progress));
  a.k_min = std::move(k.k_min);
  a.k_max = std::move(k.k_max);
  if (a.shape.empty()) return stats;
  const std::vector<std::uint8_t> shapes = shape_classes(a.k_min, a.k_max);
  std::int64_t changed = 0;
  for (std::size_t v = 0; v < shapes.size(); ++v) changed += shapes[v] != a.shape[v];
  stats.shape_changed_fraction = static_cast<double>(changed) / std::max(1.0, static_cast<double>(shapes.size()));
  a.shape = shapes;
  return stats;
}

std::optional<std::vector<std::string>> encode_paper_positions(std::span<const glm::vec3> base,
                                                               std::span<const glm::vec3> moved, Progress& progress) {
  std::atomic<bool> possible{true};
  auto chunks =
      encode_item_chunks(static_cast<std::int64_t>(base.size()), progress, [&](std::uint32_t first, std::uint32_t end) {
        Differences numbers(3);
        for (std::uint32_t v = first; v < end; ++v) {
          const auto k = steps_to(base[v], moved[v]);
          if (!k || !same_bits(placed(base[v], *k), moved[v])) {
            possible = false;
            return std::string();
          }
          for (std::size_t c = 0; c < 3; ++c) numbers.add(c, (*k)[c]);
        }
        return pack_words(numbers.numbers(), PaperWord::k64);
      });
  if (!possible) return std::nullopt;
  return chunks;
}

Result<void> decode_paper_positions(std::span<const std::string_view> chunks, std::vector<glm::vec3>& positions,
                                    Progress& progress) {
  return for_each_item<3>(
      chunks, positions.size(), PaperWord::k64, "places", progress,
      [&](std::size_t v, const std::array<std::int32_t, 3>& k) { positions[v] = placed(positions[v], k); });
}

std::optional<std::vector<std::string>> encode_paper_normals(std::span<const glm::vec3> normals, Progress& progress) {
  std::atomic<bool> possible{true};
  auto chunks = encode_item_chunks(static_cast<std::int64_t>(normals.size()), progress,
                                   [&](std::uint32_t first, std::uint32_t end) {
                                     Differences numbers(2);
                                     for (std::uint32_t v = first; v < end; ++v) {
                                       const Octahedral o = octahedral_of(normals[v]);
                                       if (!same_bits(normal_at(o), normals[v])) {
                                         possible = false;
                                         return std::string();
                                       }
                                       for (std::size_t c = 0; c < 2; ++c) numbers.add(c, o[c]);
                                     }
                                     return pack_words(numbers.numbers(), PaperWord::k128);
                                   });
  if (!possible) return std::nullopt;
  return chunks;
}

Result<std::vector<glm::vec3>> decode_paper_normals(std::span<const std::string_view> chunks, std::size_t vertices,
                                                    Progress& progress) {
  std::vector<glm::vec3> normals(vertices);
  std::atomic<bool> outside{false};
  DUBSAR_TRY(
      for_each_item<2>(chunks, vertices, PaperWord::k128, "normals", progress, [&](std::size_t v, const Octahedral& o) {
        if (std::max(std::abs(std::int64_t{o[0]}), std::abs(std::int64_t{o[1]})) > kPaperNormalSteps)
          outside = true;
        else
          normals[v] = normal_at(o);
      }));
  if (outside)
    return fail(ErrorKind::kBadData, "exa: a normal lies outside of the octahedron of {} steps", kPaperNormalSteps);
  return normals;
}

std::vector<std::string> encode_paper_bits(std::span<const std::uint16_t> numbers, int bits, Progress& progress) {
  return encode_item_chunks(static_cast<std::int64_t>(numbers.size()), progress,
                            [&](std::uint32_t first, std::uint32_t end) {
                              BitWriter out;
                              for (std::uint32_t i = first; i < end; ++i) out.bits(numbers[i], bits);
                              return out.take();
                            });
}

Result<void> decode_paper_bits(std::span<const std::string_view> chunks, int bits, std::string_view what,
                               std::span<std::uint16_t> numbers) {
  if (static_cast<std::int64_t>(chunks.size()) != item_chunks(static_cast<std::int64_t>(numbers.size())))
    return fail(ErrorKind::kBadData, "exa: {} chunks of {} found, {} expected", chunks.size(), what,
                item_chunks(static_cast<std::int64_t>(numbers.size())));
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const std::span<std::uint16_t> own =
        numbers.subspan(c * kItemsPerChunk, std::min<std::size_t>(kItemsPerChunk, numbers.size() - c * kItemsPerChunk));
    if (chunks[c].size() != (own.size() * static_cast<std::size_t>(bits) + 7) / 8)
      return fail(ErrorKind::kBadData, "exa: {} bytes of {} {} found, {} expected", chunks[c].size(), own.size(), what,
                  (own.size() * static_cast<std::size_t>(bits) + 7) / 8);
    BitReader in(chunks[c]);
    for (std::uint16_t& n : own) n = static_cast<std::uint16_t>(in.bits(bits));
  }
  return {};
}

PaperWords encode_paper_words(const SurfaceModel& model, bool shapes, Progress& progress) {
  const VertexAttributes& a = model.attributes;
  shapes = shapes && !a.shape.empty();
  PaperWords code;
  const std::uint8_t has = static_cast<std::uint8_t>((shapes ? kHasShapes : 0) | (a.ao.empty() ? 0 : kHasLight) |
                                                     (model.quad_partition.empty() ? 0 : kHasPartitions));
  if (has == 0) return code;
  std::vector<std::uint16_t> words(model.mesh.positions.size(), 0);
  for (std::uint32_t v = 0; v < words.size(); ++v) {
    unsigned word = (shapes ? a.shape[v] : 0u) | (a.ao.empty() ? 0u : unsigned{a.ao[v]} << 7);
    const auto quads = model.mesh.quads_of(v);
    if (!model.quad_partition.empty() && !quads.empty()) word |= unsigned{model.quad_partition[quads[0]]} << 13;
    words[v] = static_cast<std::uint16_t>(word);
  }
  code.words = encode_paper_bits(words, 16, progress);
  code.words.insert(code.words.begin(), std::string(1, static_cast<char>(has)));
  if (model.quad_partition.empty()) return code;
  std::uint64_t count = 0, last = 0;
  BitWriter list, out;
  for (std::uint64_t q = 0; q < model.mesh.quads.size(); ++q) {
    if (words[model.mesh.quads[q][0]] >> 13 == model.quad_partition[q]) continue;
    list.number(q - last);
    list.number(model.quad_partition[q]);
    last = q;
    ++count;
  }
  out.number(count);
  code.exceptions = {out.take() + list.take()};
  return code;
}

Result<void> decode_paper_words(std::span<const std::string_view> words, std::span<const std::string_view> exceptions,
                                SurfaceModel& model) {
  if (words.empty() || words[0].size() != 1 || words[0][0] < 1 || words[0][0] > 7)
    return fail(ErrorKind::kBadData, "exa: the words of the vertices do not say what they hold");
  const auto has = static_cast<unsigned>(words[0][0]);
  std::vector<std::uint16_t> found(model.mesh.positions.size());
  DUBSAR_TRY(decode_paper_bits(words.subspan(1), 16, "words", found));
  VertexAttributes& a = model.attributes;
  if (has & kHasShapes) a.shape.reserve(found.size());
  if (has & kHasLight) a.ao.reserve(found.size());
  for (const std::uint16_t word : found) {
    if ((word & 127) > 126) return fail(ErrorKind::kBadData, "exa: shape class 127 found, expected at most 126");
    if (has & kHasShapes) a.shape.push_back(static_cast<std::uint8_t>(word & 127));
    if (has & kHasLight) a.ao.push_back(static_cast<std::uint8_t>(word >> 7 & 63));
  }
  if (!(has & kHasPartitions)) return {};
  model.quad_partition.reserve(model.mesh.quads.size());
  for (const auto& quad : model.mesh.quads)
    model.quad_partition.push_back(static_cast<std::uint8_t>(found[quad[0]] >> 13));
  if (exceptions.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} lists of x-quads found, 1 expected", exceptions.size());
  BitReader in(exceptions[0]);
  std::uint64_t at = 0;
  for (std::uint64_t left = in.number(); left > 0; --left) {
    at += in.number();
    const std::uint64_t partition = in.number();
    if (in.past_end() || at >= model.mesh.quads.size() || partition > PartitionTable::kHighest)
      return fail(ErrorKind::kBadData, "exa: the list of x-quads with another partition is damaged");
    model.quad_partition[at] = static_cast<std::uint8_t>(partition);
  }
  return {};
}

}  // namespace dubsar
