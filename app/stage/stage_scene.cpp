// What a stage draws: the scene of a picture, and the figures of the surface that its colours wait for.

#include <algorithm>
#include <utility>
#include <vector>

#include "app/stage/stage_parts.h"
#include "app/stage/worn_room.h"
#include "core/base/system/log.h"

namespace dubsar::app {

/// Figures of a surface that a look tells: at once where every picture has to be exact, else beside the pictures, which
/// show them when they are there. A difference that nobody wants any more is no longer worked on.
void Stage::Parts::measure(Object& of, FieldNeeds needs) {
  needs.difference = needs.difference && beside.mesh && &of == &object && !of.refused;
  if (of.maker && of.maker->needs().difference && (!needs.difference || of.maker->other() != beside.kept))
    of.maker.reset();
  const FieldNeeds missing = needs.without(measured(of));
  std::optional<Result<SurfaceFields>> made;
  std::shared_ptr<const TriMesh> other = missing.difference ? beside.kept : nullptr;
  if (of.maker) {
    made = of.maker->take();
    if (!made) return;
    other = of.maker->other();
    of.maker.reset();
  } else if (missing.any() && options.quality == Quality::kExact) {
    SilentProgress progress;
    made = measure_fields(*of.source, missing, progress, other.get());
  } else if (missing.any()) {
    of.maker = std::make_unique<FieldMaker>(*of.source, missing, std::move(other));
  }
  if (!made) return;
  Result<void> done = *made ? carry(of, **std::move(made), other) : tl::unexpected<Error>(made->error());
  if (done) return;
  of.refused = other != nullptr;
  log_warning("view: {}", done.error().message);
}

Result<void> Stage::Parts::carry(Object& of, SurfaceFields made, std::shared_ptr<const TriMesh> other) {
  if (const SurfaceFields* const had = of.mesh->fields()) made = joined(std::move(made), *had);
  if (other) of.differs_from = std::move(other);
  painted.of.reset();
  return of.mesh->carry(std::make_shared<const SurfaceFields>(std::move(made)));
}

FieldNeeds Stage::Parts::measured(const Object& of) const noexcept {
  const SurfaceFields* const fields = of.mesh->fields();
  FieldNeeds out = fields == nullptr ? FieldNeeds() : fields->has;
  out.difference = out.difference && of.differs_from == beside.kept;
  return out;
}

/// A style that tells figures is plain clay until they are measured: in one colour nobody would see the object.
Style Stage::Parts::ready(Style style, const Object& of) const {
  if (!is_field(style.map) || measured(of).covers(fields_needed(style))) return style;
  style.map = ColorMap::kPlain;
  style.lit = true;
  return style;
}

const SurfaceDifference* Stage::difference() const noexcept {
  const Parts& p = *parts_;
  return p.beside.mesh && p.next.shown.style.map == ColorMap::kDifference && p.measured(p.object).difference
             ? &p.object.mesh->fields()->difference
             : nullptr;
}

std::optional<double> Stage::measuring() const noexcept {
  if (!parts_->object.maker) return std::nullopt;
  return parts_->object.maker->share();
}

/// Below what is in a half, above the strip of sides that windows have there.
void Stage::Parts::add_caption(const Shown& shown, int half) {
  if (!shown.caption) return;
  constexpr double kStripShare = 0.03, kLeastShare = 0.02;  // of the panel's shorter side
  const double low = std::min(plane.window.x, plane.window.y),
               share = std::max(options.room.margin - kStripShare, kLeastShare);
  LabelItem caption = *shown.caption;
  const double below = in_halves() ? 0.5 * (upright() ? 0.5 : 1.0) * plane.window.y - share * low
                                   : 0.6 * plane.magnification * glm::length(of(shown).box.size());
  caption.at_mm = glm::dvec3(plane.middle + half_middle(half) - glm::dvec2(0.0, below), 0.0);
  caption.anchor = 0.5;
  caption.hidden_opacity = 1.0;
  painted.items.emplace_back(std::move(caption));
}

/// The scene of the next picture, in mm of the screen. Marks of what is cut away go with it, but for texts that are
/// wanted wherever they are.
void Stage::Parts::set_scene(const Shown& shown, int half) {
  const glm::dmat4 world = placed(shown, half);
  const double scale = glm::length(glm::dvec3(world[0]));  // lifts count mm of the object
  const auto place = [&](glm::dvec3& p) { p = glm::dvec3(world * glm::dvec4(p, 1.0)); };
  painted.light = shown.light.value_or(options.shading.light);
  painted.light.azimuth_deg = shown.view.light_azimuth_deg;
  painted.light.elevation_deg = shown.view.light_elevation_deg;
  painted.fog = shown.fog.strength > 0 ? shown.fog : options.shading.fog;
  painted.glow = shown.glow;
  painted.clips = dubsar::moved(options.shading.clips, world);
  for (const ClipPlane& clip : dubsar::moved(shown.clips, world)) painted.clips.push_back(clip);
  OtherLook other = shown.other;
  const Object& own = of(shown);
  other.style = ready(other.style, own);
  painted.items = {MeshItem{&*own.mesh, world, ready(shown.style, own), shown.parts, other}};
  add_caption(shown, half);
  if (next.shown.compared && !in_halves()) {
    const Shown& there = *next.shown.compared;
    painted.items.emplace_back(
        MeshItem{&*beside.mesh, placed(there, 1 - half), ready(there.style, beside), there.parts,
                 OtherLook{ready(there.other.style, beside), there.other.light, there.other.share}});
    add_caption(there, 1 - half);
  }
  for (const LinesItem& lines : shown.before) painted.items.emplace_back(lines);
  if (const auto wearer = sink->wearer())
    for (LinesItem& lines : worn_room(*wearer, 0.5 * glm::length(object.box.size()), sink->traits().see_through))
      painted.items.emplace_back(std::move(lines));
  const auto cut = [&](const glm::dvec3& p) {
    return std::any_of(painted.clips.begin(), painted.clips.end(),
                       [&](const ClipPlane& clip) { return glm::dot(clip.normal, p - clip.point_mm) < 0.0; });
  };
  for (LinesItem lines : shown.marks.lines) {
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i + 1 < lines.points_mm.size(); i += 2) {
      for (const std::size_t end : {i, i + 1}) place(lines.points_mm[end]);
      if (cut(lines.points_mm[i]) && cut(lines.points_mm[i + 1])) continue;
      points.insert(points.end(), {lines.points_mm[i], lines.points_mm[i + 1]});
    }
    lines.points_mm = std::move(points);
    lines.lift_mm *= scale;
    painted.items.emplace_back(std::move(lines));
  }
  painted.judge.reset();
  if (shown.marks.labels.empty()) return;
  const std::span<const View> views = sink->views(cameras(half));
  const View middle = middle_view(views);
  if (views.size() > 1) painted.judge = middle;
  std::vector<LabelItem> labels;
  for (LabelItem label : shown.marks.labels) {
    label.along_mm = glm::dmat3(world) * label.along_mm;
    label.normal = glm::dmat3(world) * label.normal;
    place(label.at_mm);
    if (!turn_to_reader(label, middle)) continue;
    if (label.hidden_opacity == 0.0 && cut(label.at_mm)) continue;
    label.lift_mm *= scale;
    labels.push_back(std::move(label));
  }
  const glm::dvec3 centre(world * glm::dvec4(own.box.centre(), 1.0));
  layouts[static_cast<std::size_t>(half)].arrange(labels, centre, middle, sink->traits().view);
  for (LabelItem& label : labels) painted.items.emplace_back(std::move(label));
}

}  // namespace dubsar::app
