#include "app/tools/cut_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/words/text.h"

namespace dubsar::app {
namespace {

constexpr double kLeastLeft = 1.0;  // percent, between sides that face each other
constexpr double kStraight = 0.97;  // cosine to the line of sight from which on a side comes straight at the viewer
constexpr std::size_t kFacing = 1;  // sides 2k and 2k + 1 face each other

}  // namespace

CutBox::CutBox(const std::array<Workplace::Reach, kBoxSides.size()>& reach, const Document& document) : reach_(reach) {
  for (std::size_t side = 0; side < reach_.size(); ++side) {
    const Cut* const cut = cut_across(document, reach_[side].direction);
    at_mm_[side] = cut != nullptr ? std::min(cut->distance_mm, reach_[side].to_mm) : reach_[side].to_mm;
  }
}

/// Bit k: the end of axis k (to the right, up, to the viewer) that it stands at.
glm::dvec3 CutBox::corner(std::size_t bits) const {
  glm::dvec3 out(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t side = 2 * axis + (bits >> axis & 1);
    out += at_mm_[side] * reach_[side].direction;
  }
  return out;
}

glm::dvec3 CutBox::middle(std::size_t side) const {
  const glm::dvec3 centre = 0.5 * (corner(0) + corner(7));
  const glm::dvec3& direction = reach_[side].direction;
  return centre + direction * (at_mm_[side] - glm::dot(centre, direction));
}

double CutBox::percent(std::size_t side, double at_mm) const {
  const Workplace::Reach& reach = reach_[side];
  const double length = reach.to_mm - reach.from_mm;
  if (!(length > 0)) return 0.0;
  const std::size_t other = side ^ kFacing;
  const double cut_there = 100.0 * (reach_[other].to_mm - at_mm_[other]) / length;
  return std::clamp(100.0 * (reach.to_mm - at_mm) / length, 0.0, std::max(0.0, 100.0 - kLeastLeft - cut_there));
}

bool CutBox::faces(std::size_t side, const PickCamera& camera) const {
  return glm::dot(camera.camera_of_model() - middle(side), reach_[side].direction) > 0.0;
}

BoxPicture CutBox::picture(const PickCamera& camera) const {
  BoxPicture out;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t low = 0; low < 8; ++low) {
      if ((low >> axis & 1) != 0) continue;
      bool before = false;  // one of the two sides that meet here looks at the viewer
      for (std::size_t k = 0; k < 3; ++k) before = before || (k != axis && faces(2 * k + (low >> k & 1), camera));
      out.edges.push_back({camera.seen(corner(low)), camera.seen(corner(low | std::size_t{1} << axis)), before});
    }
  for (std::size_t side = 0; side < kBoxSides.size(); ++side) {
    const Workplace::Reach& reach = reach_[side];
    const glm::dvec3 at = middle(side);
    BoxHandle handle;
    handle.at = camera.seen(at);
    handle.towards = camera.seen(at + 0.05 * (reach.to_mm - reach.from_mm) * reach.direction) - handle.at;
    handle.before = faces(side, camera);
    handle.distance_mm = glm::distance(camera.camera_of_model(), at);
    handle.words = local_figures(tr("cut.handle", tr_name("box_side", kBoxSides[side].name),
                                    fmt::format("{:.1f}", reach.to_mm - at_mm_[side]),
                                    fmt::format("{:.0f}", percent(side, at_mm_[side]))));
    out.handles.push_back(std::move(handle));
  }
  return out;
}

std::optional<std::size_t> handle_at(const BoxPicture& picture, const glm::dvec2& at, double within) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < picture.handles.size(); ++i) {
    const BoxHandle& handle = picture.handles[i];
    if (glm::distance(handle.at, at) > within) continue;
    if (!best || handle.distance_mm < picture.handles[*best].distance_mm) best = i;
  }
  return best;
}

BoxDrag::BoxDrag(const CutBox& box, std::size_t side, const PickCamera& camera, const glm::dvec2& at)
    : side_(side), handle_mm_(box.middle(side)), direction_(box.direction(side)), begun_mm_(box.at_mm(side)) {
  const glm::dvec3 look = glm::normalize(handle_mm_ - camera.camera_of_model());
  straight_ = std::abs(glm::dot(look, direction_)) > kStraight;
  begun_along_ = along(camera, at);
}

/// Of the place on the handle's line that is nearest to the pointer's ray.
double BoxDrag::along(const PickCamera& camera, const glm::dvec2& at) const {
  const Ray ray = camera.ray(at);
  const double straight = glm::dot(ray.direction, direction_);
  if (straight_) return (straight < 0 ? -1.0 : 1.0) * at.y * camera.height_mm / camera.scale();
  const glm::dvec3 between = ray.from - handle_mm_;
  return (glm::dot(between, direction_) - straight * glm::dot(between, ray.direction)) / (1.0 - straight * straight);
}

double BoxDrag::at_mm(const PickCamera& camera, const glm::dvec2& at) const {
  return begun_mm_ + along(camera, at) - begun_along_;
}

}  // namespace dubsar::app
