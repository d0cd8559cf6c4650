#include "core/contact/kept_shape.h"

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_set>
#include <utility>

#include "core/base/result.h"
#include "core/mesh/evidence.h"

namespace dubsar {

std::size_t KeptShape::Hash::operator()(const Bits& b) const noexcept {
  std::uint64_t h = (std::uint64_t{b.x} << 32 | b.y) * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 29 ^ b.z) * 0xbf58476d1ce4e5b9u;
  return static_cast<std::size_t>(h ^ h >> 32);
}

KeptShape::Bits KeptShape::bits_of(const glm::vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y), std::bit_cast<std::uint32_t>(p.z)};
}

KeptShape::KeptShape(std::span<const glm::vec3> cut, std::span<const glm::vec3> places,
                     std::span<const std::uint8_t> evidence, std::uint32_t surface, std::vector<PatchSplit> splits)
    : vertices_(places.size()), surface_(surface), splits_(std::move(splits)) {
  DUBSAR_CHECK(places.size() == cut.size() + splits_.size() && evidence.size() == places.size());
  first_.reserve(cut.size());
  for (std::size_t i = places.size(); i-- > 0;) {
    vertices_[i] = {places[i], evidence[i], kNone};
    if (i >= cut.size()) continue;
    const auto [at, fresh] = first_.try_emplace(bits_of(cut[i]), kNone);
    vertices_[i].next = at->second;
    at->second = static_cast<std::uint32_t>(i);
  }
}

KeptShape::Known KeptShape::shape(InterfaceMesh& mesh) const {
  Known known{std::vector<std::uint8_t>(mesh.added.size(), evidence_byte(Evidence::kInferred)),
              std::vector<std::uint8_t>(mesh.added.size(), 0),
              {}};
  std::vector<std::uint32_t> id_now(vertices_.size(), kNone);
  std::unordered_map<std::uint32_t, std::uint32_t> taken;  // of places with several vertices: those come in their order
  for (std::size_t i = 0; i < mesh.added.size(); ++i) {
    const auto found = first_.find(bits_of(mesh.added[i]));
    if (found == first_.end()) continue;
    std::uint32_t at = found->second;
    if (vertices_[at].next != kNone) {
      const auto [next, fresh] = taken.try_emplace(at, at);
      at = next->second;
      if (at == kNone) continue;
      next->second = vertices_[at].next;
    }
    mesh.added[i] = vertices_[at].place;
    known.evidence[i] = vertices_[at].evidence;
    known.settled[i] = 1;
    id_now[at] = surface_ + static_cast<std::uint32_t>(i);
  }
  split_again(std::move(id_now), mesh, known);
  return known;
}

void KeptShape::split_again(std::vector<std::uint32_t> id_now, InterfaceMesh& mesh, Known& known) const {
  const auto now = [&](std::uint32_t v) { return v < surface_ ? v : id_now[v - surface_]; };
  std::unordered_set<std::uint32_t> ends;
  for (const PatchSplit& split : splits_)
    for (const std::uint32_t v : {split.a, split.b}) ends.insert(now(v));
  ends.erase(kNone);
  std::unordered_map<std::uint64_t, std::uint32_t> sides;  // triangle by where its side comes from and goes to
  const auto key = [](std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; };
  const auto add_sides = [&](std::uint32_t t) {
    const Triangle& v = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) sides[key(v[i], v[(i + 1) % 3])] = t;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    if (std::any_of(v.begin(), v.end(), [&](std::uint32_t w) { return ends.count(w) != 0; })) add_sides(t);
  }
  const std::size_t of_cut = vertices_.size() - splits_.size();
  for (std::size_t k = 0; k < splits_.size(); ++k) {
    const std::uint32_t a = now(splits_[k].a), b = now(splits_[k].b);
    if (a == kNone || b == kNone) continue;
    const auto up = sides.find(key(a, b)), down = sides.find(key(b, a));
    if (up == sides.end() || down == sides.end()) continue;
    const std::array<std::uint32_t, 2> beside{up->second, down->second};
    const Vertex& vertex = vertices_[of_cut + k];
    const auto middle = surface_ + static_cast<std::uint32_t>(mesh.added.size());
    mesh.added.push_back(vertex.place);
    mesh.strength.push_back(0.0f);
    known.evidence.push_back(vertex.evidence);
    known.settled.push_back(1);
    known.splits.push_back({a, b});
    id_now[of_cut + k] = middle;
    sides.erase(key(a, b));
    sides.erase(key(b, a));
    for (const std::uint32_t t : beside) {
      mesh.triangles.push_back(halve(mesh.triangles[t], a, b, middle));
      add_sides(t);
      add_sides(static_cast<std::uint32_t>(mesh.triangles.size() - 1));
    }
  }
}

}  // namespace dubsar
