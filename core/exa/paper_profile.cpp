#include "core/exa/paper_profile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/budget.h"

namespace dubsar {
namespace {
/// Points 0..cells along each axis; those beyond the volume are outside.
class Lattice {
 public:
  explicit Lattice(const std::array<std::int64_t, 3>& cells)
      : cells_(cells), signs_(Dims{cells[0] + 1, cells[1] + 1, cells[2] + 1}) {}
  const std::array<std::int64_t, 3>& cells() const { return cells_; }
  bool get(std::int64_t x, std::int64_t y, std::int64_t z) const { return signs_.get(x, y, z); }
  void set(std::int64_t x, std::int64_t y, std::int64_t z, bool sign) { signs_.set(x, y, z, sign); }
  /// Signs of the corners of a cell, x first.
  unsigned corners(std::int64_t x, std::int64_t y, std::int64_t z) const {
    unsigned found = 0;
    for (unsigned c = 0; c < 8; ++c) found |= (get(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)) ? 1u : 0u) << c;
    return found;
  }

 private:
  std::array<std::int64_t, 3> cells_;
  BitVolume signs_;
};

/// Every second point.
Lattice coarser(const Lattice& fine) {
  Lattice coarse({fine.cells()[0] / 2, fine.cells()[1] / 2, fine.cells()[2] / 2});
  for (std::int64_t z = 0; z <= coarse.cells()[2]; ++z)
    for (std::int64_t y = 0; y <= coarse.cells()[1]; ++y)
      for (std::int64_t x = 0; x <= coarse.cells()[0]; ++x) coarse.set(x, y, z, fine.get(2 * x, 2 * y, 2 * z));
  return coarse;
}

template <class Visit>
void for_each_cell(const Lattice& lattice, const Visit& visit) {
  for (std::int64_t z = 0; z < lattice.cells()[2]; ++z)
    for (std::int64_t y = 0; y < lattice.cells()[1]; ++y)
      for (std::int64_t x = 0; x < lattice.cells()[0]; ++x) visit(x, y, z);
}

/// Octets of a cell by how often they follow its corners, on spheres of radius 6 to 60.
class RankTable {
 public:
  static const RankTable& instance() {
    static const RankTable table;
    return table;
  }
  unsigned rank(unsigned corners, unsigned octet) const { return rank_[corners][octet]; }
  unsigned octet(unsigned corners, unsigned rank) const { return octet_[corners][rank]; }

 private:
  RankTable() {
    std::vector<std::array<std::uint32_t, 256>> seen(256);
    for (auto& row : seen) row.fill(0);
    for (std::int64_t radius = 6; radius <= 60; radius += 3) {
      Lattice sphere({128, 128, 128});
      for_each_cell(sphere, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        const std::int64_t dx = 2 * x - 127, dy = 2 * y - 127, dz = 2 * z - 127;
        sphere.set(x, y, z, dx * dx + dy * dy + dz * dz < 4 * radius * radius);
      });
      const Lattice coarse = coarser(sphere);
      for_each_cell(coarse, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        const unsigned corners = coarse.corners(x, y, z);
        if (corners != 0 && corners != 255) ++seen[corners][sphere.corners(2 * x, 2 * y, 2 * z)];
      });
    }
    for (unsigned corners = 0; corners < 256; ++corners) {
      std::array<std::uint8_t, 256>& order = octet_[corners];
      std::iota(order.begin(), order.end(), std::uint8_t{0});
      // Never seen: those that differ least from the corners first.
      std::stable_sort(order.begin(), order.end(), [&](std::uint8_t a, std::uint8_t b) {
        return seen[corners][a] != seen[corners][b] ? seen[corners][a] > seen[corners][b]
                                                    : std::popcount(a ^ corners) < std::popcount(b ^ corners);
      });
      for (unsigned r = 0; r < 256; ++r) rank_[corners][order[r]] = static_cast<std::uint8_t>(r);
    }
  }
  std::array<std::array<std::uint8_t, 256>, 256> rank_{}, octet_{};
};

/// Ranks in 2 bits, or 3 and 4 bits more, or 15 and 8 bits more; other numbers in groups of 7 bits.
class BitWriter {
 public:
  void bits(std::uint64_t value, int count) {
    for (int b = 0; b < count; ++b, ++size_) {
      if (size_ % 8 == 0) bytes_.push_back('\0');
      bytes_.back() = static_cast<char>(bytes_.back() | static_cast<char>((value >> b & 1) << size_ % 8));
    }
  }
  void rank(unsigned rank) {
    bits(std::min(rank, 3u), 2);
    if (rank >= 3) bits(std::min(rank - 3, 15u), 4);
    if (rank >= 18) bits(rank - 18, 8);
  }
  void number(std::uint64_t n) {
    for (; n >= 128; n >>= 7) bits((n & 127) | 128, 8);
    bits(n, 8);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t size_ = 0;
};
class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t bits(int count) {
    std::uint64_t value = 0;
    for (int b = 0; b < count; ++b, ++at_)
      if (at_ / 8 < bytes_.size())
        value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_ / 8]) >> at_ % 8 & 1u} << b;
    return value;
  }
  unsigned rank() {
    auto rank = static_cast<unsigned>(bits(2));
    if (rank == 3) rank += static_cast<unsigned>(bits(4));
    if (rank == 18) rank += static_cast<unsigned>(bits(8));
    return std::min(rank, 255u);
  }
  std::uint64_t number() {
    std::uint64_t n = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const std::uint64_t byte = bits(8);
      n |= (byte & 127) << shift;
      if (byte < 128) break;
    }
    return n;
  }
  bool past_end() const { return at_ > 8 * bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Levels until one cell is left along the shortest axis; cells of the finest lattice.
std::array<std::int64_t, 3> padded(const Dims& dims, int& levels) {
  const std::int64_t longest = std::max({dims.x, dims.y, dims.z});
  levels = std::min(6, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(longest))));
  const std::int64_t step = std::int64_t{1} << levels;
  const auto up = [&](std::int64_t n) { return (n + step - 1) / step * step; };
  return {up(dims.x), up(dims.y), up(dims.z)};
}
}  // namespace

std::string encode_signs_as_paper(const BitVolume& signs) {
  const RankTable& table = RankTable::instance();
  int levels = 0;
  std::vector<Lattice> lattices{Lattice(padded(signs.dims(), levels))};
  for (std::int64_t z = 0; z < signs.dims().z; ++z)
    for (std::int64_t y = 0; y < signs.dims().y; ++y)
      for (std::int64_t x = 0; x < signs.dims().x; ++x) lattices[0].set(x, y, z, signs.get(x, y, z));
  for (int level = 0; level < levels; ++level) lattices.push_back(coarser(lattices.back()));
  BitWriter out;
  const Lattice& top = lattices.back();
  for_each_cell(top, [&](auto x, auto y, auto z) { out.bits(top.get(x, y, z) ? 1 : 0, 1); });
  for (int level = levels; level-- > 0;) {
    const Lattice &fine = lattices[static_cast<std::size_t>(level)],
                  &coarse = lattices[static_cast<std::size_t>(level) + 1];
    std::vector<std::uint64_t> hidden;
    std::uint64_t number = 0, last = 0;
    for_each_cell(coarse, [&](auto x, auto y, auto z) {
      const unsigned corners = coarse.corners(x, y, z);
      if (corners == 0 || corners == 255) {
        if (fine.corners(2 * x, 2 * y, 2 * z) != corners) {
          hidden.push_back(number - last);
          last = number;
        }
      }
      ++number;
    });
    out.number(hidden.size());
    for (const std::uint64_t gap : hidden) out.number(gap);
    number = last = 0;
    std::size_t next = 0;
    for_each_cell(coarse, [&](auto x, auto y, auto z) {
      const unsigned corners = coarse.corners(x, y, z), octet = fine.corners(2 * x, 2 * y, 2 * z);
      const bool listed = next < hidden.size() && number == last + hidden[next];
      if (listed) last = number, ++next;
      if (listed || (corners != 0 && corners != 255)) out.rank(table.rank(corners, octet));
      ++number;
    });
  }
  return out.take();
}

Result<BitVolume> decode_signs_as_paper(std::string_view bytes, const Dims& dims) {
  const RankTable& table = RankTable::instance();
  int levels = 0;
  std::array<std::int64_t, 3> cells = padded(dims, levels);
  DUBSAR_TRY(
      check_memory("exa signs", static_cast<std::uint64_t>((cells[0] + 64) * (cells[1] + 1) * (cells[2] + 1)) / 2));
  for (std::int64_t& c : cells) c >>= levels;
  BitReader in(bytes);
  Lattice coarse(cells);
  for_each_cell(coarse, [&](auto x, auto y, auto z) { coarse.set(x, y, z, in.bits(1) != 0); });
  for (int level = levels; level-- > 0;) {
    for (std::int64_t& c : cells) c *= 2;
    Lattice fine(cells);
    const std::uint64_t count = in.number();
    if (count > 8 * bytes.size())
      return fail(ErrorKind::kBadData, "exa: {} hidden cells in {} bytes", count, bytes.size());
    std::vector<std::uint64_t> hidden(count);
    for (std::uint64_t& gap : hidden) gap = in.number();
    std::uint64_t number = 0, last = 0;
    std::size_t next = 0;
    for_each_cell(coarse, [&](auto x, auto y, auto z) {
      const unsigned corners = coarse.corners(x, y, z);
      const bool listed = next < hidden.size() && number == last + hidden[next];
      if (listed) last = number, ++next;
      unsigned octet = corners;
      if (listed || (corners != 0 && corners != 255)) octet = table.octet(corners, in.rank());
      for (unsigned c = 0; c < 8; ++c)
        fine.set(2 * x + (c & 1), 2 * y + (c >> 1 & 1), 2 * z + (c >> 2), (octet >> c & 1) != 0);
      ++number;
    });
    coarse = std::move(fine);
  }
  if (in.past_end()) return fail(ErrorKind::kBadData, "exa: the code of the signs is cut off");
  BitVolume signs(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) signs.set(x, y, z, coarse.get(x, y, z));
  return signs;
}

}  // namespace dubsar
