#pragma once
// Gray TIFF files byte by byte, in both byte orders and as BigTIFF: an oracle that shares nothing with libtiff.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace dubsar::testing_tools {

struct TiffFixture {
  int width = 0, height = 0, bits = 8;
  int sample_format = 1;  ///< 1 unsigned, 2 signed, 3 float
  int channels = 1;
  int photometric = 1;  ///< 0 white is zero, 1 black is zero, 2 RGB
  bool big_endian = false, big_tiff = false;
  std::uint32_t x_pixels = 0, unit = 2;  ///< resolution x_pixels / 1 per inch (2), centimetre (3), nothing (1)
  std::string description = {};
  int orientation = 0;         ///< tag 274; 0: not there
  bool oriented_once = false;  ///< in the first page only
  std::string trailing = {};   ///< bytes right behind the pixels of the first page
  int depth = 0;               ///< ImageDepth, tag 32997; 0: not there

  /// `pages`: samples of each page, row by row, as bit patterns.
  std::string bytes(const std::vector<std::vector<std::uint64_t>>& pages) const {
    std::string out = big_endian ? "MM" : "II";
    put(out, big_tiff ? 43 : 42, 2);
    if (big_tiff) {
      put(out, 8, 2);
      put(out, 0, 2);
    }
    std::size_t link = out.size();
    put(out, 0, word());
    for (const auto& page : pages) {
      const std::size_t data = out.size();
      for (const std::uint64_t sample : page) put(out, sample, bits / 8);
      const std::size_t data_bytes = out.size() - data;
      if (&page == &pages.front()) out += trailing;
      const std::size_t text = out.size();
      out += description + '\0';
      const std::size_t rational = out.size();
      put(out, x_pixels, 4);
      put(out, 1, 4);
      while (out.size() % 8 != 0) out += '\0';
      patch(out, link, out.size());
      std::vector<Entry> entries{{256, 4, 1, static_cast<std::uint64_t>(width)},
                                 {257, 4, 1, static_cast<std::uint64_t>(height)},
                                 {258, 3, 1, static_cast<std::uint64_t>(bits)},
                                 {259, 3, 1, 1},
                                 {262, 3, 1, static_cast<std::uint64_t>(photometric)}};
      if (description.size() > 8) entries.push_back({270, 2, description.size() + 1, text});
      entries.push_back({273, 4, 1, data});
      if (orientation > 0 && (!oriented_once || &page == &pages.front()))
        entries.push_back({274, 3, 1, static_cast<std::uint64_t>(orientation)});
      entries.push_back({277, 3, 1, static_cast<std::uint64_t>(channels)});
      entries.push_back({278, 4, 1, static_cast<std::uint64_t>(height)});
      entries.push_back({279, 4, 1, data_bytes});
      if (x_pixels > 0) {
        entries.push_back({282, 5, 1, rational});
        entries.push_back({283, 5, 1, rational});
        entries.push_back({296, 3, 1, unit});
      }
      entries.push_back({339, 3, 1, static_cast<std::uint64_t>(sample_format)});
      if (depth > 0) entries.push_back({32997, 4, 1, static_cast<std::uint64_t>(depth)});
      put(out, entries.size(), big_tiff ? 8 : 2);
      for (const Entry& entry : entries) {
        put(out, static_cast<std::uint64_t>(entry.tag), 2);
        put(out, static_cast<std::uint64_t>(entry.type), 2);
        put(out, entry.count, word());
        if (entry.type == 5 && big_tiff) {  // eight bytes fit into the entry itself
          put(out, x_pixels, 4);
          put(out, 1, 4);
        } else if (entry.type == 3) {
          put(out, entry.value, 2);
          put(out, 0, word() - 2);
        } else if (entry.type == 4) {
          put(out, entry.value, 4);
          put(out, 0, word() - 4);
        } else {
          put(out, entry.value, word());
        }
      }
      link = out.size();
      put(out, 0, word());
    }
    return out;
  }

 private:
  struct Entry {
    int tag, type;
    std::uint64_t count, value;
  };
  int word() const { return big_tiff ? 8 : 4; }
  void put(std::string& out, std::uint64_t value, int count) const {
    for (int i = 0; i < count; ++i) out += static_cast<char>(value >> 8 * (big_endian ? count - 1 - i : i));
  }
  void patch(std::string& out, std::size_t at, std::uint64_t value) const {
    std::string field;
    put(field, value, word());
    out.replace(at, field.size(), field);
  }
};

}  // namespace dubsar::testing_tools
