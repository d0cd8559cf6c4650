#include "core/contact/cut/band_bricks.h"

#include <algorithm>
#include <bit>
#include <glm/common.hpp>

#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr std::int64_t kBricksGrain = 1 << 10;
/// Of the pieces of the patches, steps: flow runs across the band, and most of it stays over one piece. With pieces
/// twice as wide threads wait for each other: a quarter more by the clock on two cores.
constexpr float kPieceSide = 32.0f;

std::vector<glm::ivec3> places_of(const auto& found) {
  std::vector<glm::ivec3> places(found.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = found[i].place;
  return places;
}

BandBricks::Nodes nodes_at(const ContactBand& band, const glm::ivec3& place) {
  constexpr auto kEdge = static_cast<std::size_t>(BrickMap<std::uint32_t>::kEdge), kHalf = kEdge / 2;
  BandBricks::Nodes nodes;
  const std::uint32_t* const brick = band.node_at.brick(place.x >> 1, place.y >> 1, place.z >> 1);
  if (brick == nullptr) {
    nodes.fill(ContactBand::kNone);
    return nodes;
  }
  const auto from = [&](int axis) { return kHalf * static_cast<std::size_t>(place[axis] & 1); };
  for (std::size_t z = 0; z < kHalf; ++z)
    for (std::size_t y = 0; y < kHalf; ++y)
      std::copy_n(brick + ((from(2) + z) * kEdge + from(1) + y) * kEdge + from(0), kHalf,
                  nodes.begin() + static_cast<std::ptrdiff_t>((z * kHalf + y) * kHalf));
  return nodes;
}

/// bits(brick): the word of its points that are asked for. 0 for brick 0.
template <class Bits>
BrickBits bits_of_all(std::uint32_t count, const Bits& bits) {
  BrickBits all(count, 0);
  parallel_for(static_cast<std::int64_t>(count) - 1, kBricksGrain, [&](std::int64_t i) {
    const auto b = static_cast<std::uint32_t>(i + 1);
    all[b] = bits(b);
  });
  return all;
}

}  // namespace

/// Over which piece a brick lies: that of its first node.
std::vector<BandBricks::Found> BandBricks::find(const ContactBand& band) {
  const Dims d = band.node_at.dims(), bricks = band.node_at.bricks();
  const auto along = [](std::int64_t n) { return static_cast<std::uint32_t>(static_cast<float>(n) / kPieceSide) + 1; };
  const glm::uvec3 pieces(along(d.x), along(d.y), along(d.z));
  const auto piece_of = [&](std::uint32_t n) {
    const glm::vec3 at = glm::max(band.samples[band.nodes[n].sample].position, glm::vec3(0.0f));
    const glm::uvec3 cube = glm::min(glm::uvec3(at / kPieceSide), pieces - 1u);
    return (cube.z * pieces.y + cube.y) * pieces.x + cube.x;
  };
  std::vector<Found> found = parallel_gather<Found>(
      bricks.count(), 1 << 12, [&](std::int64_t begin, std::int64_t end, std::vector<Found>& some) {
        for (std::int64_t i = begin; i < end; ++i) {
          const std::int64_t x = i % bricks.x, y = i / bricks.x % bricks.y, z = i / bricks.x / bricks.y;
          if (!band.node_at.has_brick(x, y, z)) continue;
          for (int k = 0; k < 8; ++k) {
            const glm::ivec3 place = 2 * glm::ivec3(x, y, z) + glm::ivec3(k & 1, k >> 1 & 1, k >> 2);
            const Nodes nodes = nodes_at(band, place);
            const auto first =
                std::find_if(nodes.begin(), nodes.end(), [](std::uint32_t n) { return n != ContactBand::kNone; });
            if (first != nodes.end()) some.push_back({place, piece_of(*first)});
          }
        }
      });
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.piece < b.piece; });
  return found;
}

BandBricks::BandBricks(const ContactBand& band) : BandBricks(band, find(band)) {}

BandBricks::BandBricks(const ContactBand& band, const std::vector<Found>& found)
    : band_(band), lattice_(band.node_at.dims(), places_of(found)), starts_{1} {
  for (std::uint32_t b = 2; b < lattice_.count(); ++b)
    if (found[b - 1].piece != found[b - 2].piece) starts_.push_back(b);
  starts_.push_back(lattice_.count());
  in_band_ = bits_of_all(lattice_.count(), [&](std::uint32_t b) {
    std::uint64_t word = 0, bit = 1;
    for (const std::uint32_t n : nodes(b)) {
      if (n != ContactBand::kNone) word |= bit;
      bit <<= 1;
    }
    return word;
  });
}

BandBricks::Nodes BandBricks::nodes(std::uint32_t brick) const noexcept {
  return nodes_at(band_, lattice_.place(brick));
}

std::vector<std::uint32_t> BandBricks::nodes_of(const BrickBits& bits) const {
  std::vector<std::uint32_t> all = parallel_gather<std::uint32_t>(
      static_cast<std::int64_t>(bits.size()), kBricksGrain,
      [&](std::int64_t begin, std::int64_t end, std::vector<std::uint32_t>& some) {
        for (auto b = static_cast<std::uint32_t>(begin); b < static_cast<std::uint64_t>(end); ++b) {
          if (bits[b] == 0) continue;
          const Nodes of_brick = nodes(b);
          for (std::uint64_t left = bits[b]; left != 0; left &= left - 1)
            some.push_back(of_brick[static_cast<std::size_t>(std::countr_zero(left))]);
        }
      });
  std::sort(all.begin(), all.end());
  return all;
}

BrickBits BandBricks::tablet(const std::vector<ClaySide>& side) const {
  return bits_of_all(lattice_.count(), [&](std::uint32_t b) {
    const Nodes of_brick = nodes(b);
    std::uint64_t word = 0;
    for (std::uint64_t left = in_band_[b]; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      if (side[of_brick[k]] == ClaySide::kTablet) word |= left & -left;
    }
    return word;
  });
}

BrickBits BandBricks::reached(const BrickBits& within, const BrickBits& seeds) const {
  BrickBits reached(within.size(), 0);
  std::vector<std::uint8_t> waits(within.size(), 0);
  std::vector<std::uint32_t> queue;
  const auto add = [&](std::uint32_t b, std::uint64_t points) {
    if ((points & within[b] & ~reached[b]) == 0) return;
    reached[b] |= points & within[b];
    if (waits[b] == 0) queue.push_back(b);
    waits[b] = 1;
  };
  for (std::uint32_t b = 1; b < within.size(); ++b) {
    add(b, seeds[b]);
    for (; !queue.empty();) {
      const std::uint32_t next = queue.back();
      queue.pop_back();
      waits[next] = 0;
      std::uint64_t points = reached[next], before = 0;
      while (points != before) {
        before = points;
        points |= LatticeBricks::bits_around(points) & within[next];
      }
      reached[next] = points;
      for (std::uint32_t way = 0; way < LatticeBricks::kWays; ++way)
        add(lattice_.brick_beside(next, way), LatticeBricks::bits_across(points, way));
    }
  }
  return reached;
}

BrickBits BandBricks::pinched(const BrickBits& tablet) const {
  return bits_of_all(lattice_.count(), [&](std::uint32_t b) {
    const auto beside = [&](const BrickBits& bits, std::uint32_t axis) {
      return lattice_.bits_beside(bits, b, 2 * axis);
    };
    std::uint64_t pinches = 0;
    for (std::uint32_t u = 0; u < 3; ++u) {
      const std::uint32_t v = (u + 1) % 3;
      const std::uint64_t right = beside(tablet, u), up = beside(tablet, v);
      const std::uint64_t may =
          in_band_[b] & beside(in_band_, u) & beside(in_band_, v) & (tablet[b] ^ right) & (tablet[b] ^ up);
      if (may != 0)
        pinches |= may & lattice_.bits_beside(in_band_, b, 2 * u, 2 * v) &
                   ~(tablet[b] ^ lattice_.bits_beside(tablet, b, 2 * u, 2 * v));
    }
    return pinches;
  });
}

}  // namespace dubsar
