// What a stage draws: the scene of a picture, and the figures of the surface that its colours wait for.

#include <algorithm>
#include <utility>
#include <vector>

#include "app/stage/stage_parts.h"
#include "app/stage/worn_room.h"
#include "core/base/system/log.h"

namespace dubsar::app {

/// Figures of the surface that a look tells: at once where every picture has to be exact, else beside the pictures,
/// which show them when they are there.
void Stage::Parts::measure(const FieldNeeds& needs) {
  LodMesh& mesh = *object.mesh;
  Result<void> done;
  if (options.quality == Quality::kExact) {
    SilentProgress progress;
    done = carry_fields(mesh, *object.source, needs, progress);
  } else if (object.maker) {
    auto made = object.maker->take();
    if (!made) return;
    object.maker.reset();
    if (*made) {
      SurfaceFields all = mesh.fields() == nullptr ? std::move(**made) : joined(std::move(**made), *mesh.fields());
      done = mesh.carry(std::make_shared<const SurfaceFields>(std::move(all)));
      painted.of.reset();
    } else {
      done = tl::unexpected<Error>(made->error());
    }
  } else if (const FieldNeeds missing = needs.without(measured()); missing.any()) {
    object.maker = std::make_unique<FieldMaker>(*object.source, missing);
  }
  if (!done) log_warning("view: {}", done.error().message);
}

FieldNeeds Stage::Parts::measured() const noexcept {
  const SurfaceFields* const fields = object.mesh->fields();
  return fields == nullptr ? FieldNeeds() : fields->has;
}

/// A style that tells figures is plain clay until they are measured: in one colour nobody would see the object.
Style Stage::Parts::ready(Style style) const {
  if (!is_field(style.map) || measured().covers(fields_needed(style))) return style;
  style.map = ColorMap::kPlain;
  style.lit = true;
  return style;
}

std::optional<double> Stage::measuring() const noexcept {
  if (!parts_->object.maker) return std::nullopt;
  return parts_->object.maker->share();
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
  other.style = ready(other.style);
  painted.items = {MeshItem{&*object.mesh, world, ready(shown.style), shown.parts, other}};
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
  const glm::dvec3 centre(world * glm::dvec4(object.box.centre(), 1.0));
  layouts[static_cast<std::size_t>(half)].arrange(labels, centre, middle, sink->traits().view);
  for (LabelItem& label : labels) painted.items.emplace_back(std::move(label));
}

}  // namespace dubsar::app
