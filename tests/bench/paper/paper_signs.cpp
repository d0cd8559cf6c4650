#include "tests/bench/paper/paper_signs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>

#include "core/base/system/budget.h"
#include "core/exa/signs/bit_spread.h"
#include "tests/bench/paper/bit_string.h"

namespace dubsar {
namespace {
constexpr std::uint64_t kAll = ~std::uint64_t{0};

/// A lattice is the volume of the lowest corners of its cells; the points beyond them are outside.
BitVolume coarser(const BitVolume& fine) {
  const Dims& d = fine.dims();
  BitVolume coarse(Dims{(d.x + 1) / 2, (d.y + 1) / 2, (d.z + 1) / 2});
  for (std::int64_t z = 0; z < coarse.dims().z; ++z)
    for (std::int64_t y = 0; y < coarse.dims().y; ++y)
      for (std::int64_t w = 0; w < fine.words_per_row(); ++w)
        coarse.row(y, z)[w / 2] |= even_bits(fine.row(2 * y, 2 * z)[w]) << (w % 2 * 32);
  return coarse;
}

/// Signs of the corners of 64 cells of a row: word c for corner c, x first.
class CornerWords {
 public:
  CornerWords(const BitVolume& lattice, std::int64_t y, std::int64_t z, std::int64_t w) {
    const Dims& d = lattice.dims();
    for (std::size_t r = 0; r < 4; ++r) {
      const std::int64_t ry = y + static_cast<std::int64_t>(r % 2), rz = z + static_cast<std::int64_t>(r / 2);
      if (ry >= d.y || rz >= d.z) continue;
      const std::uint64_t* row = lattice.row(ry, rz);
      words_[2 * r] = row[w];
      words_[2 * r + 1] = row[w] >> 1 | (w + 1 < lattice.words_per_row() ? row[w + 1] << 63 : 0);
    }
    const std::int64_t cells = d.x - 64 * w;
    present_ = cells >= 64 ? kAll : (std::uint64_t{1} << cells) - 1;
  }
  /// Cells with corners of both signs.
  std::uint64_t mixed() const {
    std::uint64_t any = 0, all = kAll;
    for (const std::uint64_t word : words_) any |= word, all &= word;
    return any & ~all & present_;
  }
  std::uint64_t lowest() const { return words_[0] & present_; }
  std::uint64_t present() const { return present_; }
  std::uint64_t cells() const { return static_cast<std::uint64_t>(std::popcount(present_)); }
  unsigned of(int x) const {
    unsigned found = 0;
    for (unsigned c = 0; c < 8; ++c) found |= static_cast<unsigned>(words_[c] >> x & 1) << c;
    return found;
  }

 private:
  std::array<std::uint64_t, 8> words_{};
  std::uint64_t present_ = 0;
};

/// Two words of each of the four finer rows in 64 coarser cells of a row.
struct FineWords {
  std::array<std::array<std::uint64_t, 2>, 4> word{};
  static FineWords of(const BitVolume& fine, std::int64_t y, std::int64_t z, std::int64_t w) {
    FineWords f;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t half = 0; half < 2; ++half)
        if (const std::int64_t at = 2 * w + static_cast<std::int64_t>(half); at < fine.words_per_row())
          f.word[r][half] =
              fine.row(2 * y + static_cast<std::int64_t>(r % 2), 2 * z + static_cast<std::int64_t>(r / 2))[at];
    return f;
  }
  /// All eight points of a cell have the sign of its lowest corner.
  static FineWords doubled(std::uint64_t lowest) {
    FineWords f;
    const std::uint64_t low = spread_bits(lowest), high = spread_bits(lowest >> 32);
    f.word.fill({low | low << 1, high | high << 1});
    return f;
  }
  /// Cells in which a point differs.
  std::uint64_t apart(const FineWords& other) const {
    std::array<std::uint64_t, 2> any{};
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t half = 0; half < 2; ++half) any[half] |= word[r][half] ^ other.word[r][half];
    return even_bits(any[0] | any[0] >> 1) | even_bits(any[1] | any[1] >> 1) << 32;
  }
  unsigned octet(int x) const {
    unsigned found = 0;
    for (std::size_t r = 0; r < 4; ++r)
      found |= static_cast<unsigned>(word[r][static_cast<std::size_t>(x / 32)] >> (2 * (x % 32)) & 3) << (2 * r);
    return found;
  }
  void set(int x, unsigned octet) {
    for (std::size_t r = 0; r < 4; ++r) {
      std::uint64_t& w = word[r][static_cast<std::size_t>(x / 32)];
      w = (w & ~(std::uint64_t{3} << (2 * (x % 32)))) | std::uint64_t{octet >> (2 * r) & 3} << (2 * (x % 32));
    }
  }
  void store(BitVolume& fine, std::int64_t y, std::int64_t z, std::int64_t w) const {
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t half = 0; half < 2; ++half)
        if (const std::int64_t at = 2 * w + static_cast<std::int64_t>(half); at < fine.words_per_row())
          fine.row(2 * y + static_cast<std::int64_t>(r % 2), 2 * z + static_cast<std::int64_t>(r / 2))[at] =
              word[r][half];
  }
};

template <class Visit>
void for_each_word(const BitVolume& lattice, const Visit& visit) {
  for (std::int64_t z = 0; z < lattice.dims().z; ++z)
    for (std::int64_t y = 0; y < lattice.dims().y; ++y)
      for (std::int64_t w = 0; w < lattice.words_per_row(); ++w) visit(y, z, w);
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
      BitVolume sphere(Dims{128, 128, 128});
      for (std::int64_t z = 0; z < 128; ++z)
        for (std::int64_t y = 0; y < 128; ++y) {
          const std::int64_t dy = 2 * y - 127, dz = 2 * z - 127, left = 4 * radius * radius - dy * dy - dz * dz;
          for (std::int64_t x = 64; x < 128 && (2 * x - 127) * (2 * x - 127) < left; ++x) {
            sphere.set(x, y, z, true);
            sphere.set(127 - x, y, z, true);
          }
        }
      const BitVolume coarse = coarser(sphere);
      for_each_word(coarse, [&](std::int64_t y, std::int64_t z, std::int64_t w) {
        const CornerWords corners(coarse, y, z, w);
        const FineWords fine = FineWords::of(sphere, y, z, w);
        for (std::uint64_t rest = corners.mixed(); rest != 0; rest &= rest - 1)
          ++seen[corners.of(std::countr_zero(rest))][fine.octet(std::countr_zero(rest))];
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

/// Ranks in 2 bits, or 4 bits more, or 8 bits more.
void write_rank(BitWriter& out, unsigned rank) {
  out.bits(std::min(rank, 3u), 2);
  if (rank >= 3) out.bits(std::min(rank - 3, 15u), 4);
  if (rank >= 18) out.bits(rank - 18, 8);
}
unsigned read_rank(BitReader& in) {
  auto rank = static_cast<unsigned>(in.bits(2));
  if (rank == 3) rank += static_cast<unsigned>(in.bits(4));
  if (rank == 18) rank += static_cast<unsigned>(in.bits(8));
  return std::min(rank, 255u);
}

/// Cells of the finest lattice.
Dims padded(const Dims& dims) {
  const std::int64_t step = std::int64_t{1} << paper_levels(dims);
  const auto up = [&](std::int64_t n) { return (n + step - 1) / step * step; };
  return {up(dims.x), up(dims.y), up(dims.z)};
}

/// From the rows of one volume to those of another, as far as both go.
void copy_rows(const BitVolume& from, BitVolume& to) {
  const Dims &a = from.dims(), &b = to.dims();
  const std::uint64_t last = b.x % 64 == 0 ? kAll : (std::uint64_t{1} << b.x % 64) - 1;
  for (std::int64_t z = 0; z < std::min(a.z, b.z); ++z)
    for (std::int64_t y = 0; y < std::min(a.y, b.y); ++y) {
      const std::int64_t words = std::min(from.words_per_row(), to.words_per_row());
      std::copy_n(from.row(y, z), words, to.row(y, z));
      if (words == to.words_per_row()) to.row(y, z)[words - 1] &= last;
    }
}

/// Which equal cells of a lattice are not equal inside: gaps between their numbers.
class HiddenCells {
 public:
  explicit HiddenCells(std::vector<std::uint64_t> gaps) : gaps_(std::move(gaps)) { step(); }
  /// Those among `count` (at most 64) cells from the one of number `first` on, which must rise from call to call.
  std::uint64_t among(std::uint64_t first, std::uint64_t count) {
    std::uint64_t found = 0;
    for (; more_ && next_ < first + count; step())
      if (next_ >= first) found |= std::uint64_t{1} << (next_ - first);
    return found;
  }

 private:
  void step() {
    more_ = at_ < gaps_.size();
    if (more_) next_ += gaps_[at_++];
  }
  std::vector<std::uint64_t> gaps_;
  std::size_t at_ = 0;
  std::uint64_t next_ = 0;
  bool more_ = false;
};

std::uint64_t number_of(const BitVolume& lattice, std::int64_t y, std::int64_t z, std::int64_t w) {
  return static_cast<std::uint64_t>((z * lattice.dims().y + y) * lattice.dims().x + 64 * w);
}

std::string encode_level(const BitVolume& coarse, const BitVolume& fine) {
  const RankTable& table = RankTable::instance();
  BitWriter out, ranks;
  std::vector<std::uint64_t> gaps;
  std::uint64_t last = 0;
  for_each_word(coarse, [&](std::int64_t y, std::int64_t z, std::int64_t w) {
    const CornerWords corners(coarse, y, z, w);
    const FineWords octets = FineWords::of(fine, y, z, w);
    const std::uint64_t mixed = corners.mixed(),
                        hidden = octets.apart(FineWords::doubled(corners.lowest())) & ~mixed & corners.present();
    for (std::uint64_t rest = hidden; rest != 0; rest &= rest - 1) {
      const std::uint64_t number = number_of(coarse, y, z, w) + static_cast<std::uint64_t>(std::countr_zero(rest));
      gaps.push_back(number - last);
      last = number;
    }
    for (std::uint64_t rest = mixed | hidden; rest != 0; rest &= rest - 1) {
      const int x = std::countr_zero(rest);
      write_rank(ranks, table.rank(corners.of(x), octets.octet(x)));
    }
  });
  out.number(gaps.size());
  for (const std::uint64_t gap : gaps) out.number(gap);
  return out.take() + ranks.take();
}

Result<BitVolume> decode_level(std::string_view bytes, const BitVolume& coarse) {
  const RankTable& table = RankTable::instance();
  BitReader list(bytes);
  const std::uint64_t count = list.number();
  if (count > bytes.size()) return fail(ErrorKind::kBadData, "exa: {} hidden cells in {} bytes", count, bytes.size());
  std::vector<std::uint64_t> gaps(count);
  for (std::uint64_t& gap : gaps) gap = list.number();
  HiddenCells hidden(std::move(gaps));
  BitReader in(bytes.substr(std::min(list.bytes_used(), bytes.size())));
  BitVolume fine(Dims{2 * coarse.dims().x, 2 * coarse.dims().y, 2 * coarse.dims().z});
  for_each_word(coarse, [&](std::int64_t y, std::int64_t z, std::int64_t w) {
    if (in.past_end()) return;
    const CornerWords corners(coarse, y, z, w);
    FineWords octets = FineWords::doubled(corners.lowest());
    const std::uint64_t coded = corners.mixed() | hidden.among(number_of(coarse, y, z, w), corners.cells());
    for (std::uint64_t rest = coded; rest != 0; rest &= rest - 1) {
      const int x = std::countr_zero(rest);
      octets.set(x, table.octet(corners.of(x), read_rank(in)));
    }
    octets.store(fine, y, z, w);
  });
  if (in.past_end()) return fail(ErrorKind::kBadData, "exa: the code of the signs is cut off");
  return fine;
}
}  // namespace

int paper_levels(const Dims& dims) {
  const auto shortest = static_cast<std::uint64_t>(std::min({dims.x, dims.y, dims.z}));
  return std::min(6, static_cast<int>(std::bit_width(shortest)) - 1);
}

std::uint64_t paper_sign_memory(const Dims& dims) {
  const Dims d = padded(dims);
  const auto words = static_cast<std::uint64_t>((d.x + 63) / 64 * d.y * d.z);
  return words * 8 * 5 / 4 + static_cast<std::uint64_t>(d.y * d.z) * 8;  // two lattices at a time
}

std::vector<std::string> encode_signs_as_paper(const BitVolume& signs) {
  std::vector<BitVolume> lattices{BitVolume(padded(signs.dims()))};
  copy_rows(signs, lattices[0]);
  for (int level = 0; level < paper_levels(signs.dims()); ++level) lattices.push_back(coarser(lattices.back()));
  BitWriter raw;
  const BitVolume& top = lattices.back();
  for_each_word(top, [&](std::int64_t y, std::int64_t z, std::int64_t w) {
    for (std::int64_t x = 64 * w; x < std::min(top.dims().x, 64 * w + 64); ++x) raw.bits(top.get(x, y, z) ? 1 : 0, 1);
  });
  std::vector<std::string> chunks{raw.take()};
  for (std::size_t level = lattices.size() - 1; level-- > 0;)
    chunks.push_back(encode_level(lattices[level + 1], lattices[level]));
  return chunks;
}

Result<BitVolume> decode_signs_as_paper(std::span<const std::string_view> chunks, const Dims& dims, int level) {
  const int levels = paper_levels(dims);
  DUBSAR_TRY(check_memory("exa signs", paper_sign_memory(dims)));
  Dims cells = padded(dims);
  cells = {cells.x >> levels, cells.y >> levels, cells.z >> levels};
  if (chunks.size() != static_cast<std::size_t>(levels) + 1 ||
      chunks[0].size() != static_cast<std::size_t>((cells.count() + 7) / 8))
    return fail(ErrorKind::kBadData, "exa: {} chunks of octets found, {} expected", chunks.size(), levels + 1);
  BitReader in(chunks[0]);
  BitVolume lattice(cells);
  for_each_word(lattice, [&](std::int64_t y, std::int64_t z, std::int64_t w) {
    for (std::int64_t x = 64 * w; x < std::min(cells.x, 64 * w + 64); ++x) lattice.set(x, y, z, in.bits(1) != 0);
  });
  int spacing = levels;
  for (; spacing > level; --spacing) {
    DUBSAR_ASSIGN(BitVolume fine, decode_level(chunks[static_cast<std::size_t>(levels - spacing) + 1], lattice));
    lattice = std::move(fine);
  }
  for (; spacing < level; ++spacing) lattice = coarser(lattice);
  BitVolume signs(Dims{((dims.x - 1) >> level) + 1, ((dims.y - 1) >> level) + 1, ((dims.z - 1) >> level) + 1});
  copy_rows(lattice, signs);
  return signs;
}

}  // namespace dubsar
