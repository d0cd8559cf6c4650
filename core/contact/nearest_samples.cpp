#include "core/contact/nearest_samples.h"

#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCellGrain = 1 << 12;
constexpr int kMostLooks = 4;  ///< cells from which the nearest sample is looked for around them

glm::ivec3 coarse_place(const PatchPoint& sample) { return glm::ivec3(glm::round(0.5f * sample.position)); }

}  // namespace

Result<NearestSamples> NearestSamples::find(const std::vector<PatchPoint>& samples, const Dims& dims, float reach,
                                            Progress& progress) {
  NearestSamples found(samples, dims, reach);
  if (!found.run_fronts(progress)) return cancelled_error();
  return found;
}

NearestSamples::NearestSamples(const std::vector<PatchPoint>& samples, const Dims& dims, float reach)
    : samples_(samples),
      dims_(dims),
      reach_(reach),
      known_({dims.x / 2 + 1, dims.y / 2 + 1, dims.z / 2 + 1}, kNone),
      cell_of_(samples.size(), kNone) {
  fill_cells();
}

void NearestSamples::fill_cells() {
  BrickMap<std::uint32_t> cell_at(dims_, kNone);
  std::vector<std::uint32_t> last, before(samples_.size(), kNone);  // of a cell, those that it has in turn
  for (std::uint32_t s = 0; s < samples_.size(); ++s) {
    const glm::ivec3 p = point_of(s);
    if (!in_grid(p)) continue;
    std::uint32_t& cell = cell_at.at(p.x, p.y, p.z);
    if (cell == kNone) {
      cell = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back({p, 0, 0, 0, 0});
      last.push_back(kNone);
    }
    cell_of_[s] = cell;
    std::uint32_t same = last[cell];  // triangles beside each other have the same samples on their edge
    while (same != kNone && samples_[same].position != samples_[s].position) same = before[same];
    if (same != kNone) continue;
    before[s] = last[cell];
    last[cell] = s;
    ++cells_[cell].places;
  }
  std::uint32_t places = 0;
  for (Cell& cell : cells_) {
    cell.first_place = places;
    places += cell.places;
  }
  places_.resize(places);
  parallel_for(static_cast<std::int64_t>(cells_.size()), kCellGrain, [&](std::int64_t c) {
    std::uint32_t place = cells_[static_cast<std::size_t>(c)].first_place;
    for (std::uint32_t s = last[static_cast<std::size_t>(c)]; s != kNone; s = before[s])
      places_[place++] = {samples_[s].position, s};
  });
  find_cells_beside(cell_at);
}

void NearestSamples::find_cells_beside(const BrickMap<std::uint32_t>& cell_at) {
  const auto count = static_cast<std::int64_t>(cells_.size());
  using Ids = std::vector<std::uint32_t>;
  beside_ = parallel_gather<std::uint32_t>(count, kCellGrain, [&](std::int64_t begin, std::int64_t end, Ids& found) {
    for (std::int64_t c = begin; c < end; ++c) {
      Cell& cell = cells_[static_cast<std::size_t>(c)];
      for (int n = 0; n < 27; ++n) {
        const int k = (n + 13) % 27;  // itself first
        const glm::ivec3 q = cell.point + glm::ivec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        const std::uint32_t other = cell_at.get(q.x, q.y, q.z);
        if (other == kNone) continue;
        found.push_back(other);
        ++cell.beside;
      }
    }
  });
  std::uint32_t first = 0;
  for (Cell& cell : cells_) {
    cell.first_beside = first;
    first += cell.beside;
  }
}

std::vector<glm::ivec3> NearestSamples::bricks() const {
  const Dims coarse = known_.bricks();
  const auto count = [](std::int64_t points) { return (points + kEdge - 1) / kEdge; };
  std::vector<glm::ivec3> found;
  for (std::int64_t z = 0; z < count(dims_.z); ++z)
    for (std::int64_t y = 0; y < count(dims_.y); ++y)
      for (std::int64_t x = 0; x < count(dims_.x); ++x)
        if (x / 2 < coarse.x && y / 2 < coarse.y && z / 2 < coarse.z && known_.has_brick(x / 2, y / 2, z / 2))
          found.emplace_back(x, y, z);
  return found;
}

bool NearestSamples::run_fronts(Progress& progress) {
  struct Front {
    glm::ivec3 at;
    std::uint32_t sample;
  };
  constexpr float kBucket = 0.5f;
  const float reach = reach_ + 2.0f;  // whatever lies between known points is in reach of them
  std::vector<std::vector<Front>> buckets(static_cast<std::size_t>(reach / kBucket) + 2);
  const Dims d = known_.dims();
  const auto distance = [&](const glm::ivec3& p, std::uint32_t s) {
    return glm::distance(2.0f * glm::vec3(p), samples_[s].position);
  };
  const auto offer = [&](const glm::ivec3& p, std::uint32_t s) {
    if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= d.x || p.y >= d.y || p.z >= d.z) return;
    const std::uint32_t before = known_.get(p.x, p.y, p.z);
    if (before == s) return;
    const float far = distance(p, s);
    if (far > reach || (before != kNone && distance(p, before) <= far)) return;
    known_.at(p.x, p.y, p.z) = s;
    buckets[static_cast<std::size_t>(far / kBucket)].push_back({p, s});
  };
  for (std::uint32_t s = 0; s < samples_.size(); ++s) offer(coarse_place(samples_[s]), s);
  for (std::size_t b = 0; b < buckets.size(); ++b) {
    if (progress.cancelled()) return false;
    for (std::size_t i = 0; i < buckets[b].size(); ++i) {
      const Front front = buckets[b][i];
      if (known_.get(front.at.x, front.at.y, front.at.z) == front.sample)
        each_beside(front.at, [&](const glm::ivec3& q) { offer(q, front.sample); });
    }
    buckets[b] = {};
  }
  return true;
}

std::uint32_t NearestSamples::nearest_of(const glm::ivec3& p, std::uint32_t guess) const {
  const glm::ivec3 low = p / 2, high = (p + 1) / 2;
  std::uint32_t nearest = kNone, last = kNone;
  float least = INFINITY;
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        const std::uint32_t s = known_.get(x, y, z);
        if (s == kNone || s == last) continue;
        last = s;
        const glm::vec3 off = glm::vec3(p) - samples_[s].position;
        const float square = glm::dot(off, off);
        if (square >= least) continue;
        least = square;
        nearest = s;
      }
  if (guess != kNone && nearest != kNone && least < reach_ * reach_) {
    const glm::vec3 off = glm::vec3(p) - samples_[guess].position;
    if (const float square = glm::dot(off, off); square < least) {
      least = square;
      nearest = guess;
    }
  }
  constexpr float kFar = 3.0f;  ///< no sample beside it is nearer by as much
  if (nearest != kNone && least < (reach_ + kFar) * (reach_ + kFar)) look_around(p, nearest, least);
  return nearest;
}

/// Goes on to the nearest of the samples around `nearest`, at the square of a distance `least`. One beyond the grid has
/// none around it.
void NearestSamples::look_around(const glm::ivec3& p, std::uint32_t& nearest, float& least) const {
  glm::ivec3 middle(-kMostLooks);  // of the look before
  std::uint32_t seen = 0;          // bits of cells around it whose samples were looked at
  for (int look = 0; look < kMostLooks; ++look) {
    const std::uint32_t before = nearest, own = cell_of_[before];
    if (own == kNone) return;
    // Beside the foot of the point on the patch, by no more than what is known lies, and half a diagonal of a cell.
    const glm::vec3 normal = samples_[before].normal, off = glm::vec3(p) - samples_[before].position;
    const float height = glm::dot(off, normal), aside = std::sqrt(std::max(least - height * height, 0.0f)) + 0.87f;
    const glm::ivec3 from = cells_[own].point - 1 - middle;
    std::uint32_t now = 0;
    const std::uint32_t* const first = beside_.data() + cells_[own].first_beside;
    for (const std::uint32_t* beside = first; beside != first + cells_[own].beside; ++beside) {
      const Cell& cell = cells_[*beside];
      const glm::vec3 way(cell.point - p);
      const float up = glm::dot(way, normal);
      if (glm::dot(way, way) - up * up > aside * aside) continue;
      const glm::ivec3 at = cell.point - cells_[own].point + 1, then = from + at + 1;
      now |= 1u << ((at.z * 3 + at.y) * 3 + at.x);
      const auto around = [](int along) { return static_cast<unsigned>(along) < 3; };
      if (around(then.x) && around(then.y) && around(then.z) && seen >> ((then.z * 3 + then.y) * 3 + then.x) & 1u)
        continue;
      const Place* const places = places_.data() + cell.first_place;
      for (const Place* place = places; place != places + cell.places; ++place) {
        const glm::vec3 to = glm::vec3(p) - place->position;
        const float square = glm::dot(to, to);
        if (square >= least) continue;
        least = square;
        nearest = place->sample;
      }
    }
    if (nearest == before || cell_of_[nearest] == own) break;
    middle = cells_[own].point;
    seen = now;
  }
}

}  // namespace dubsar
