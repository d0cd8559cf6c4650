#include "input/tracking/hands/hand_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dubsar {

void blur_121(GrayView in, std::span<std::uint8_t> out) {
  const int w = in.width, h = in.height;
  std::copy_n(in.pixels, static_cast<std::size_t>(w) * static_cast<std::size_t>(h), out.begin());
  std::vector<std::uint16_t> column(static_cast<std::size_t>(w));
  for (int y = 1; y + 1 < h; ++y) {
    const std::uint8_t* p = in.pixels + y * w;
    for (int x = 0; x < w; ++x)
      column[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(p[x - w] + 2 * p[x] + p[x + w]);
    std::uint8_t* to = out.data() + y * w;
    for (int x = 1; x + 1 < w; ++x) {
      const auto i = static_cast<std::size_t>(x);
      to[x] = static_cast<std::uint8_t>((column[i - 1] + 2 * column[i] + column[i + 1] + 8) >> 4);
    }
  }
}

std::optional<SkinThreshold> skin_threshold(GrayView picture, double fraction, int margin) {
  std::array<int, 256> histogram{};
  for (int i = 0; i < picture.width * picture.height; ++i) ++histogram[picture.pixels[i]];
  histogram[0] = 0;  // what the lens does not see
  const int background = static_cast<int>(std::max_element(histogram.begin(), histogram.end()) - histogram.begin());
  int bright = 0;
  for (int level = background + margin; level < 256; ++level) bright += histogram[static_cast<std::size_t>(level)];
  if (bright == 0) return std::nullopt;
  int level = 255;
  for (int seen = 0; level > background + margin; --level)
    if ((seen += histogram[static_cast<std::size_t>(level)]) > bright / 5) break;
  return SkinThreshold{background + std::max(margin, static_cast<int>(fraction * (level - background))), background};
}

std::vector<Region> find_regions(GrayView picture, int threshold, int min_area_px, int most,
                                 std::span<std::uint8_t> labels, std::vector<std::uint32_t>& stack) {
  constexpr std::uint8_t kNew = 254;
  const int w = picture.width, h = picture.height;
  std::fill(labels.begin(), labels.end(), std::uint8_t{0});
  std::vector<Region> regions;
  std::vector<std::uint32_t> members;
  for (int start = 0; start < w * h; ++start) {
    if (picture.pixels[start] < threshold || labels[static_cast<std::size_t>(start)] != 0) continue;
    Region region{w, h, 0, 0, 0, 0};
    members.clear();
    stack.assign(1, static_cast<std::uint32_t>(start));
    labels[static_cast<std::size_t>(start)] = kNew;
    while (!stack.empty()) {
      const int at = static_cast<int>(stack.back());
      stack.pop_back();
      members.push_back(static_cast<std::uint32_t>(at));
      const int x = at % w, y = at / w;
      region.x0 = std::min(region.x0, x);
      region.x1 = std::max(region.x1, x + 1);
      region.y0 = std::min(region.y0, y);
      region.y1 = std::max(region.y1, y + 1);
      const auto visit = [&](int next) {
        if (picture.pixels[next] < threshold || labels[static_cast<std::size_t>(next)] != 0) return;
        labels[static_cast<std::size_t>(next)] = kNew;
        stack.push_back(static_cast<std::uint32_t>(next));
      };
      if (x > 0) visit(at - 1);
      if (x + 1 < w) visit(at + 1);
      if (y > 0) visit(at - w);
      if (y + 1 < h) visit(at + w);
    }
    region.area_px = static_cast<int>(members.size());
    const bool keep = region.area_px >= min_area_px && regions.size() < 32;
    region.label = static_cast<std::uint8_t>(regions.size() + 1);
    for (const std::uint32_t at : members) labels[at] = keep ? region.label : kDroppedRegion;
    if (keep) regions.push_back(region);
  }
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.area_px > b.area_px; });
  if (regions.size() > static_cast<std::size_t>(most)) regions.resize(static_cast<std::size_t>(most));
  return regions;
}

namespace {

/// Lower envelope of parabolas: squared distances along one line, `stride` apart.
void transform_line(float* values, int count, int stride, std::vector<float>& f, std::vector<int>& v,
                    std::vector<float>& z) {
  for (int i = 0; i < count; ++i) f[static_cast<std::size_t>(i)] = values[i * stride];
  int k = 0;
  v[0] = 0;
  z[0] = -std::numeric_limits<float>::infinity();
  z[1] = std::numeric_limits<float>::infinity();
  for (int q = 1; q < count; ++q) {
    const auto fq = f[static_cast<std::size_t>(q)] + static_cast<float>(q * q);
    float s;
    for (;;) {
      const int p = v[static_cast<std::size_t>(k)];
      s = (fq - (f[static_cast<std::size_t>(p)] + static_cast<float>(p * p))) / static_cast<float>(2 * (q - p));
      if (s > z[static_cast<std::size_t>(k)]) break;
      --k;
    }
    ++k;
    v[static_cast<std::size_t>(k)] = q;
    z[static_cast<std::size_t>(k)] = s;
    z[static_cast<std::size_t>(k) + 1] = std::numeric_limits<float>::infinity();
  }
  k = 0;
  for (int q = 0; q < count; ++q) {
    while (z[static_cast<std::size_t>(k) + 1] < static_cast<float>(q)) ++k;
    const int p = v[static_cast<std::size_t>(k)];
    values[q * stride] = static_cast<float>((q - p) * (q - p)) + f[static_cast<std::size_t>(p)];
  }
}

}  // namespace

void distance_inside(std::span<const std::uint8_t> labels, int width, int height, const Region& region,
                     std::vector<float>& distance) {
  const int w = region.x1 - region.x0 + 2, h = region.y1 - region.y0 + 2;
  constexpr float kFar = 1e6F;
  distance.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int px = region.x0 + x - 1, py = region.y0 + y - 1;
      const bool inside = px >= 0 && py >= 0 && px < width && py < height &&
                          labels[static_cast<std::size_t>(py * width + px)] == region.label;
      distance[static_cast<std::size_t>(y * w + x)] = inside ? kFar : 0.0F;
    }
  const auto longest = static_cast<std::size_t>(std::max(w, h));
  std::vector<float> f(longest), z(longest + 1);
  std::vector<int> v(longest);
  for (int x = 0; x < w; ++x) transform_line(distance.data() + x, h, w, f, v, z);
  for (int y = 0; y < h; ++y) transform_line(distance.data() + y * w, w, 1, f, v, z);
  for (float& d : distance) d = std::sqrt(d);
}

std::optional<Match> match_disk(GrayView left, GrayView right, const glm::dvec2& centre, double radius_px, int step,
                                int d_min, int d_max, double min_score) {
  struct Sample {
    int offset;
    float value;
  };
  std::vector<Sample> samples;
  const int cx = static_cast<int>(std::lround(centre.x)), cy = static_cast<int>(std::lround(centre.y));
  const int reach = static_cast<int>(radius_px);
  double sum = 0.0;
  for (int dy = -reach; dy <= reach; dy += step)
    for (int dx = -reach; dx <= reach; ++dx) {
      const int x = cx + dx, y = cy + dy;
      if (dx * dx + dy * dy > reach * reach || y < 0 || y >= left.height || x - d_max < 0 || x >= left.width) continue;
      samples.push_back({y * left.width + x, static_cast<float>(left.at(x, y))});
      sum += samples.back().value;
    }
  if (samples.size() < 12) return std::nullopt;
  const auto n = static_cast<double>(samples.size());
  const auto mean = static_cast<float>(sum / n);
  double left_energy = 0.0;
  for (Sample& s : samples) {
    s.value -= mean;
    left_energy += static_cast<double>(s.value * s.value);
  }
  std::vector<double> scores;
  for (int d = d_min; d <= d_max; ++d) {
    float cross = 0.0F, total = 0.0F, energy = 0.0F;
    for (const Sample& s : samples) {
      const auto r = static_cast<float>(right.pixels[s.offset - d]) - mean;
      cross += s.value * r;
      total += r;
      energy += r * r;
    }
    const double variance = static_cast<double>(energy) - static_cast<double>(total) * static_cast<double>(total) / n;
    scores.push_back(
        variance > 0.0 && left_energy > 0.0 ? static_cast<double>(cross) / std::sqrt(variance * left_energy) : 0.0);
  }
  const auto best = static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  if (best == 0 || best + 1 >= scores.size() || scores[best] < min_score) return std::nullopt;
  const double before = scores[best - 1], top = scores[best], after = scores[best + 1];
  const double curvature = before - 2.0 * top + after;
  const double shift = curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
  return Match{d_min + static_cast<double>(best) + shift, top};
}

}  // namespace dubsar
