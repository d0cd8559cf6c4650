#include "core/extract/labelled/taking_back.h"

#include <algorithm>
#include <cmath>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/extract/labelled/near_pairs.h"

namespace dubsar {
namespace {

constexpr std::int64_t kBackGrain = 1 << 13;

std::uint32_t quad_with(const SafeDrawing& safe, std::uint32_t triangle) {
  const auto& first = safe.first_triangle;
  return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), triangle) - first.begin() - 1);
}

/// Triangles of which a corner is marked.
std::vector<std::uint8_t> triangles_at(const SafeDrawing& safe, const std::vector<std::uint8_t>& marked) {
  std::vector<std::uint8_t> wanted(safe.triangles.size());
  parallel_for(static_cast<std::int64_t>(wanted.size()), kBackGrain, [&](std::int64_t i) {
    const Triangle& t = safe.triangles[static_cast<std::size_t>(i)];
    wanted[static_cast<std::size_t>(i)] = marked[t[0]] | marked[t[1]] | marked[t[2]];
  });
  return wanted;
}

}  // namespace

std::vector<ExactPlace> follow_vertices(const SafeDrawing& safe, std::vector<ExactPlace> moved) {
  const std::size_t vertices = moved.size(), added = safe.places.size() - vertices;
  std::vector<glm::dvec3> sum(added, glm::dvec3(0.0));
  std::vector<int> count(added, 0);
  for (const Triangle& t : safe.triangles)
    for (const std::uint32_t p : t) {
      if (p < vertices) continue;
      for (const std::uint32_t v : t) {
        if (v >= vertices) continue;
        sum[p - vertices] += glm::dvec3(moved[v] - safe.places[v]);
        ++count[p - vertices];
      }
    }
  for (std::size_t i = 0; i < added; ++i) {
    ExactPlace place = safe.places[vertices + i];
    for (int a = 0; a < 3 && count[i] > 0; ++a) place[a] += std::llround(sum[i][a] / count[i]);
    moved.push_back(place);
  }
  return moved;
}

TakenBack take_back(const SafeDrawing& safe, std::vector<ExactPlace>& places) {
  DUBSAR_CHECK(places.size() == safe.places.size());
  TakenBack result;
  std::vector<std::uint8_t> changed(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) changed[i] = places[i] != safe.places[i];
  for (;;) {
    const std::vector<std::uint8_t> wanted = triangles_at(safe, changed);
    const TrianglePairs pairs = touching_pairs_near(places, safe.triangles, wanted);
    std::vector<std::uint32_t> quads;
    for (const auto& pair : pairs)
      for (const std::uint32_t t : pair) quads.push_back(quad_with(safe, t));
    for (std::uint32_t t = 0; t < wanted.size(); ++t) {
      const Triangle& corners = safe.triangles[t];
      if (wanted[t] && has_zero_area(places[corners[0]], places[corners[1]], places[corners[2]]))
        quads.push_back(quad_with(safe, t));
    }
    result.left = static_cast<std::int64_t>(pairs.size());
    if (quads.empty()) return result;
    std::fill(changed.begin(), changed.end(), std::uint8_t{0});
    std::int64_t back = 0;
    for (const std::uint32_t q : quads)
      for (std::uint32_t t = safe.first_triangle[q]; t < safe.first_triangle[q + 1]; ++t)
        for (const std::uint32_t p : safe.triangles[t]) {
          if (places[p] == safe.places[p]) continue;
          places[p] = safe.places[p];
          changed[p] = 1;
          ++back;
        }
    if (back == 0) return result;  // what is left was there before anything moved
    result.points += back;
    ++result.rounds;
  }
}

}  // namespace dubsar
