#include "core/parts/air_space.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPadX = 64;

/// Bits of the last word of a row that are inside the grid.
std::uint64_t tail_mask(std::int64_t width) {
  return (width & 63) == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (width & 63)) - 1;
}

/// Slices of `words` words each that are worth a thread: starting one costs as much as 100 kB of bit work.
std::int64_t slice_grain(std::int64_t words) {
  return std::max<std::int64_t>(1, (1 << 15) / std::max<std::int64_t>(words, 1));
}

/// out = in dilated by one along x.
void dilate_row(const std::uint64_t* in, std::uint64_t* out, std::int64_t words, std::uint64_t tail) {
  const auto both = [&](std::int64_t w) { return in[w] | in[w] << 1 | in[w] >> 1; };
  out[0] = both(0) | (words > 1 ? in[1] << 63 : 0);
  for (std::int64_t w = 1; w + 1 < words; ++w) out[w] = both(w) | in[w - 1] >> 63 | in[w + 1] << 63;
  if (words > 1) out[words - 1] = both(words - 1) | in[words - 2] >> 63;
  out[words - 1] &= tail;
}

/// One step of dilation by the 3 x 3 x 3 cube, without what is set in `barred` (if given). Slices run through a window
/// of three, so that each is read and written once.
BitVolume dilate_once(const BitVolume& in, const BitVolume* barred = nullptr) {
  const Dims d = in.dims();
  const std::int64_t words = in.words_per_row(), slice = words * d.y;
  const std::uint64_t tail = tail_mask(d.x);
  BitVolume out(d);
  constexpr std::int64_t kSlices = 16;  // of a chunk: two more are dilated along x and y than are written
  parallel_chunks(d.z, std::max(kSlices, slice_grain(slice)), [&](std::int64_t z_begin, std::int64_t z_end) {
    std::vector<std::uint64_t> rows(static_cast<std::size_t>(slice));
    std::vector<std::uint64_t> window(static_cast<std::size_t>(3 * slice), 0);
    const auto place = [&](std::int64_t z) { return window.data() + (z + 3) % 3 * slice; };
    const auto spread = [&](std::int64_t z) {  // slice z, dilated along x and y
      std::uint64_t* const to = place(z);
      if (z < 0 || z >= d.z) {
        std::fill_n(to, slice, 0);
        return;
      }
      for (std::int64_t y = 0; y < d.y; ++y) dilate_row(in.row(y, z), rows.data() + y * words, words, tail);
      for (std::int64_t y = 0; y < d.y; ++y) {
        const std::uint64_t* here = rows.data() + y * words;
        const std::uint64_t* before = y > 0 ? here - words : here;
        const std::uint64_t* after = y + 1 < d.y ? here + words : here;
        for (std::int64_t w = 0; w < words; ++w) to[y * words + w] = here[w] | before[w] | after[w];
      }
    };
    spread(z_begin - 1);
    spread(z_begin);
    for (std::int64_t z = z_begin; z < z_end; ++z) {
      spread(z + 1);
      const std::uint64_t *before = place(z - 1), *here = place(z), *after = place(z + 1);
      std::uint64_t* to = out.row(0, z);
      if (barred == nullptr) {
        for (std::int64_t w = 0; w < slice; ++w) to[w] = here[w] | before[w] | after[w];
      } else {
        const std::uint64_t* bar = barred->row(0, z);
        for (std::int64_t w = 0; w < slice; ++w) to[w] = (here[w] | before[w] | after[w]) & ~bar[w];
      }
    }
  });
  return out;
}

struct RowRun {
  std::uint32_t begin, end;
};

/// Runs of clear bits of a row.
void clear_runs(const std::uint64_t* row, std::int64_t width, std::vector<RowRun>& runs) {
  runs.clear();
  std::int64_t x = 0;
  const std::int64_t words = (width + 63) / 64;
  const auto next = [&](std::int64_t from, bool set) {  // first x >= from whose bit equals `set`
    std::int64_t w = from >> 6;
    if (w >= words) return width;
    std::uint64_t bits = (set ? row[w] : ~row[w]) & (~std::uint64_t{0} << (from & 63));
    while (bits == 0) {
      if (++w >= words) return width;
      bits = set ? row[w] : ~row[w];
    }
    return std::min(width, w * 64 + std::countr_zero(bits));
  };
  while ((x = next(x, false)) < width) {
    const std::int64_t end = next(x, true);
    runs.push_back({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(end)});
    x = end;
  }
}

/// Runs of the clear bits of a whole volume, joined where they overlap in neighbouring rows.
struct RunGraph {
  std::vector<std::int64_t> first;  ///< first run of each row
  std::vector<RowRun> runs;
  ConcurrentSets sets{0};

  explicit RunGraph(const BitVolume& blocked) {
    const Dims d = blocked.dims();
    std::vector<std::vector<RowRun>> of_slice(static_cast<std::size_t>(d.z));
    first.assign(static_cast<std::size_t>(d.y * d.z + 1), 0);
    parallel_for(d.z, slice_grain(blocked.words_per_row() * d.y), [&](std::int64_t z) {
      std::vector<RowRun> row_runs;
      auto& all = of_slice[static_cast<std::size_t>(z)];
      for (std::int64_t y = 0; y < d.y; ++y) {
        clear_runs(blocked.row(y, z), d.x, row_runs);
        first[static_cast<std::size_t>(z * d.y + y)] = static_cast<std::int64_t>(row_runs.size());
        all.insert(all.end(), row_runs.begin(), row_runs.end());
      }
    });
    runs.resize(static_cast<std::size_t>(exclusive_scan(first)));
    DUBSAR_CHECK(runs.size() < 0xffffffffu);
    parallel_for(d.z, 1, [&](std::int64_t z) {
      auto& slice = of_slice[static_cast<std::size_t>(z)];
      std::copy(slice.begin(), slice.end(), runs.begin() + first[static_cast<std::size_t>(z * d.y)]);
      slice = {};
    });
    sets = ConcurrentSets(runs.size());
    parallel_for(d.z, slice_grain(blocked.words_per_row() * d.y), [&](std::int64_t z) {
      for (std::int64_t y = 0; y < d.y; ++y) {
        if (y > 0) join_rows(z * d.y + y - 1, z * d.y + y);
        if (z > 0) join_rows((z - 1) * d.y + y, z * d.y + y);
      }
    });
  }

  void join_rows(std::int64_t row_a, std::int64_t row_b) {
    std::int64_t a = first[static_cast<std::size_t>(row_a)], b = first[static_cast<std::size_t>(row_b)];
    const std::int64_t end_a = first[static_cast<std::size_t>(row_a + 1)];
    const std::int64_t end_b = first[static_cast<std::size_t>(row_b + 1)];
    while (a < end_a && b < end_b) {
      const RowRun &run_a = runs[static_cast<std::size_t>(a)], &run_b = runs[static_cast<std::size_t>(b)];
      if (run_a.begin < run_b.end && run_b.begin < run_a.end)
        sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
      if (run_a.end < run_b.end)
        ++a;
      else
        ++b;
    }
  }
};

void set_run(std::uint64_t* row, const RowRun& run) {
  for (std::uint32_t x = run.begin; x < run.end;) {
    const std::uint32_t bit = x & 63, count = std::min(64 - bit, run.end - x);
    const std::uint64_t mask = count == 64 ? ~std::uint64_t{0} : ((std::uint64_t{1} << count) - 1) << bit;
    row[x >> 6] |= mask;
    x += count;
  }
}

/// Grid faces between set bits of a and set bits of b (disjoint volumes).
std::int64_t count_faces(const BitVolume& a, const BitVolume& b) {
  const Dims d = a.dims();
  const std::int64_t words = a.words_per_row();
  return parallel_reduce<std::int64_t>(
      d.z, slice_grain(words * d.y), 0,
      [&](std::int64_t z0, std::int64_t z1) {
        std::int64_t count = 0;
        const auto both = [&](std::uint64_t p, std::uint64_t q) {
          if ((p & q) != 0) count += std::popcount(p & q);  // a call where every processor is served, and mostly 0
        };
        for (std::int64_t z = z0; z < z1; ++z)
          for (std::int64_t y = 0; y < d.y; ++y) {
            const std::uint64_t *ra = a.row(y, z), *rb = b.row(y, z);
            for (std::int64_t w = 0; w < words; ++w) {
              const std::uint64_t below_a = ra[w] << 1 | (w > 0 ? ra[w - 1] >> 63 : 0);
              const std::uint64_t below_b = rb[w] << 1 | (w > 0 ? rb[w - 1] >> 63 : 0);
              both(ra[w], below_b);
              both(rb[w], below_a);
            }
            for (int axis = 0; axis < 2; ++axis) {
              if (axis == 0 ? y == 0 : z == 0) continue;
              const std::uint64_t* pa = axis == 0 ? a.row(y - 1, z) : a.row(y, z - 1);
              const std::uint64_t* pb = axis == 0 ? b.row(y - 1, z) : b.row(y, z - 1);
              for (std::int64_t w = 0; w < words; ++w) {
                both(ra[w], pb[w]);
                both(rb[w], pa[w]);
              }
            }
          }
        return count;
      },
      [](std::int64_t p, std::int64_t q) { return p + q; });
}

/// Gives back to the exterior what the erosion by r took, as far as it is air.
Exterior grow_back(const BitVolume& inside, BitVolume eroded, int r) {
  Exterior e;
  e.crack_radius = r;
  e.air = std::move(eroded);
  for (int step = 0; r > 0 && step <= r; ++step) e.air = dilate_once(e.air, &inside);
  BitVolume enclosed(inside.dims());
  const std::uint64_t tail = tail_mask(inside.dims().x);
  const std::int64_t words = inside.words_per_row(), slice = words * inside.dims().y;
  parallel_for(inside.dims().z, slice_grain(slice), [&](std::int64_t z) {
    const std::uint64_t *in = inside.row(0, z), *air = std::as_const(e.air).row(0, z);
    std::uint64_t* const to = enclosed.row(0, z);
    for (std::int64_t w = 0; w < slice; ++w) to[w] = ~(in[w] | air[w]);
    for (std::int64_t w = words - 1; w < slice; w += words) to[w] &= tail;
  });
  e.enclosed_faces = count_faces(inside, enclosed);
  return e;
}

}  // namespace

BitVolume pad(const BitVolume& bits, int margin) {
  const Dims d = bits.dims();
  const std::int64_t more = 2 * std::int64_t{margin};
  BitVolume result({d.x + 2 * kPadX, d.y + more, d.z + more});
  parallel_for(d.z, slice_grain(bits.words_per_row() * d.y), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < d.y; ++y)
      std::copy_n(bits.row(y, z), bits.words_per_row(), result.row(y + margin, z + margin) + 1);
  });
  return result;
}

BitVolume crop(const BitVolume& bits, int margin) {
  const Dims d = bits.dims();
  const std::int64_t less = 2 * std::int64_t{margin};
  BitVolume result({d.x - 2 * kPadX, d.y - less, d.z - less});
  const std::int64_t words = result.words_per_row();
  parallel_for(result.dims().z, slice_grain(words * result.dims().y), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < result.dims().y; ++y) {
      std::copy_n(bits.row(y + margin, z + margin) + 1, words, result.row(y, z));
      result.row(y, z)[words - 1] &= tail_mask(result.dims().x);
    }
  });
  return result;
}

/// A cube is a line along x, along y, and along z, and a line of 2 r + 1 grows threefold with each step: so the whole
/// volume is gone through about log3 r times instead of r times.
BitVolume dilate(const BitVolume& inside, int r) {
  const Dims d = inside.dims();
  const std::int64_t words = inside.words_per_row(), slice = words * d.y;
  const std::uint64_t tail = tail_mask(d.x);
  std::vector<int> steps;  // shifts; each covers what is there three times without a gap
  for (int reach = 0; reach < r;) {
    steps.push_back(std::min({r - reach, 2 * reach + 1, 63}));
    reach += steps.back();
  }
  BitVolume result = inside;
  parallel_for(d.z, slice_grain(slice), [&](std::int64_t z) {
    std::vector<std::uint64_t> before(static_cast<std::size_t>(slice));
    std::uint64_t* const here = result.row(0, z);
    for (const int step : steps) {
      std::copy_n(here, slice, before.begin());
      for (std::int64_t y = 0; y < d.y; ++y) {
        const std::uint64_t* const from = before.data() + y * words;
        std::uint64_t* const to = here + y * words;
        for (std::int64_t w = 0; w < words; ++w)
          to[w] |= from[w] << step | (w > 0 ? from[w - 1] >> (64 - step) : 0) | from[w] >> step |
                   (w + 1 < words ? from[w + 1] << (64 - step) : 0);
        to[words - 1] &= tail;
      }
    }
    for (const int step : steps) {
      std::copy_n(here, slice, before.begin());
      for (std::int64_t y = 0; y < d.y; ++y)
        for (const std::int64_t other : {y - step, y + step}) {
          if (other < 0 || other >= d.y) continue;
          const std::uint64_t* const from = before.data() + other * words;
          std::uint64_t* const to = here + y * words;
          for (std::int64_t w = 0; w < words; ++w) to[w] |= from[w];
        }
    }
  });
  for (const int step : steps) {
    const BitVolume before = result;
    parallel_for(d.z, slice_grain(slice), [&](std::int64_t z) {
      std::uint64_t* const to = result.row(0, z);
      for (const std::int64_t other : {z - step, z + step}) {
        if (other < 0 || other >= d.z) continue;
        const std::uint64_t* const from = before.row(0, other);
        for (std::int64_t w = 0; w < slice; ++w) to[w] |= from[w];
      }
    });
  }
  return result;
}

BitVolume flood_from_border(const BitVolume& blocked) {
  const Dims d = blocked.dims();
  RunGraph graph(blocked);
  std::vector<std::uint8_t> reached(graph.runs.size(), 0);  // bytes, since several threads write them
  const std::int64_t grain = slice_grain(blocked.words_per_row() * d.y);
  const auto each_run = [&](std::int64_t z, const auto& visit) {
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t i = graph.first[static_cast<std::size_t>(z * d.y + y)];
           i < graph.first[static_cast<std::size_t>(z * d.y + y + 1)]; ++i)
        visit(y, static_cast<std::uint32_t>(i));
  };
  parallel_for(d.z, grain, [&](std::int64_t z) {
    each_run(z, [&](std::int64_t y, std::uint32_t i) {
      const RowRun& run = graph.runs[i];
      if (y == 0 || y == d.y - 1 || z == 0 || z == d.z - 1 || run.begin == 0 || run.end == d.x)
        std::atomic_ref(reached[graph.sets.root(i)]).store(1, std::memory_order_relaxed);
    });
  });
  BitVolume result(d);
  parallel_for(d.z, grain, [&](std::int64_t z) {
    each_run(z, [&](std::int64_t y, std::uint32_t i) {
      if (reached[graph.sets.root(i)] != 0) set_run(result.row(y, z), graph.runs[i]);
    });
  });
  return result;
}

Result<Exterior> find_exterior(const BitVolume& inside, int largest_radius, Progress& progress) {
  // Enclosing 85 % of what the widest closing encloses: cracks give steps of tens of per cent, relief on the
  // outer wall that a wide closing bridges gives a few.
  constexpr double kEnough = 0.85;
  const int margin = largest_radius + 2;  // so that a dilated object near the border does not block the way around it
  const BitVolume padded = pad(inside, margin);
  const auto eroded = [&](int r) { return flood_from_border(dilate(padded, r)); };
  const auto close = [&](int r) {
    BitVolume air = eroded(r);  // apart, so that what was dilated is gone before the air grows back
    return grow_back(padded, std::move(air), r);
  };
  Exterior chosen = close(0);
  if (largest_radius > 0) {
    if (progress.cancelled()) return cancelled_error();
    Exterior widest = close(largest_radius);
    const double enough = kEnough * static_cast<double>(std::max(chosen.enclosed_faces, widest.enclosed_faces));
    const auto encloses = [&](const Exterior& e) { return static_cast<double>(e.enclosed_faces) >= enough; };
    // From radius 1 on a wider closing encloses all that a narrower one does: every step back from the exterior of r +
    // 1 begins inside that of r. So the least radius that is enough is found by halving, from the narrow end: most
    // cracks are narrow, and to close them takes the fewest steps.
    if (!encloses(chosen)) {
      int too_small = 0;
      chosen = std::move(widest);
      while (chosen.crack_radius - too_small > 1) {
        if (progress.cancelled()) return cancelled_error();
        Exterior middle = close(std::min(std::max(1, 2 * too_small), (too_small + chosen.crack_radius) / 2));
        if (encloses(middle))
          chosen = std::move(middle);
        else
          too_small = middle.crack_radius;
      }
    }
  }
  chosen.air = crop(chosen.air, margin);
  return chosen;
}

EnclosedAir::EnclosedAir(const BitVolume& inside, const BitVolume& exterior) : dims_(inside.dims()) {
  BitVolume blocked = inside;
  const std::int64_t slice = blocked.words_per_row() * dims_.y;
  parallel_for(dims_.z, slice_grain(slice), [&](std::int64_t z) {
    const std::uint64_t* const from = exterior.row(0, z);
    std::uint64_t* const to = blocked.row(0, z);
    for (std::int64_t w = 0; w < slice; ++w) to[w] |= from[w];
  });
  RunGraph graph(blocked);
  std::vector<std::uint32_t> id(graph.runs.size(), kNone);
  runs_.reserve(graph.runs.size());
  for (std::uint32_t i = 0; i < graph.runs.size(); ++i) {
    const std::uint32_t root = graph.sets.root(i);
    if (id[root] == kNone) id[root] = count_++;
    runs_.push_back({graph.runs[i].begin, graph.runs[i].end, id[root]});
  }
  first_run_ = std::move(graph.first);
}

std::uint32_t EnclosedAir::at(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
  if (x < 0 || y < 0 || z < 0 || x >= dims_.x || y >= dims_.y || z >= dims_.z) return kNone;
  const auto row = static_cast<std::size_t>(z * dims_.y + y);
  const auto begin = runs_.begin() + first_run_[row], end = runs_.begin() + first_run_[row + 1];
  const auto run =
      std::partition_point(begin, end, [&](const Run& r) { return static_cast<std::int64_t>(r.end) <= x; });
  return run != end && static_cast<std::int64_t>(run->begin) <= x ? run->component : kNone;
}

}  // namespace dubsar
