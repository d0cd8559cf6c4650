#include "app/viewer/companion.h"

#include <algorithm>
#include <system_error>

#include "app/stage/marks.h"
#include "app/viewer/first_document.h"
#include "app/words/text.h"
#include "core/base/system/log.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// The same file; how it is compared is no matter of reading.
bool same_file(const Companion& a, const Companion& b) { return a.path == b.path && a.content == b.content; }

LabelItem caption_of(const CompanionNames& names, const std::string& file) {
  LabelItem out;
  out.font = names.font;
  out.text = fs::path(file).stem().string();
  out.height_px = kMarkLettersPx * names.letters;
  out.color = kWrittenColor;
  out.plate = kMarkPlate;
  return out;
}

/// Colours tell how far the surface is from its companion.
Style difference_style(const Style& before, double full_mm) {
  Style out = shading_preset("mean-curvature").value_or(Shading()).style;
  out.map = ColorMap::kDifference;
  out.contrast = field_scale(out).to / full_mm;
  out.lit = true;  // a place is found by the signs around it
  out.ambient_occlusion = before.ambient_occlusion;
  out.mark_inferred = before.mark_inferred;
  out.field_colors = before.field_colors;
  out.hatch = before.hatch;
  out.section = before.section;
  out.back_faces = before.back_faces;
  return out;
}

}  // namespace

CompanionSurface::CompanionSurface(OpenedSurface read)
    : opened(std::make_shared<const OpenedSurface>(std::move(read))), box(surface_box(opened->mesh)) {}

ViewState carried_over(const ViewState& home, const ViewState& seen, const ViewState& next) {
  ViewState out = next;
  if (seen.rotation != home.rotation)
    out.rotation = glm::normalize(seen.rotation * glm::conjugate(home.rotation) * next.rotation);
  out.zoom = next.zoom * seen.zoom / home.zoom;
  out.pan = next.pan + seen.pan - home.pan;
  return out;
}

fs::path companion_file(const Document& document) {
  const fs::path there(document.companion.path);
  std::error_code error;
  if (document.source.path.empty() || fs::exists(there, error)) return there;
  const fs::path near = fs::path(document.source.path).parent_path() / there.filename();
  return fs::exists(near, error) ? near : there;
}

void put_beside(Shown& shown, const Document& document, const CompanionSurface& companion, const StageOptions& stage,
                const CompanionNames& names) {
  Document other = companion.opened->work.document;
  other.style = document.style;
  other.unpack = document.unpack;
  other.fog = document.fog;
  for (Part& part : other.parts)
    for (const Part& own : document.parts)
      if (own.name == part.name) {
        part.visible = own.visible;
        part.opacity = own.opacity;
        part.colour = own.colour;
      }
  ViewState view = carried_over(home_of(document), shown.view, home_of(other));
  view.light_azimuth_deg = shown.view.light_azimuth_deg;
  view.light_elevation_deg = shown.view.light_elevation_deg;
  view.nearer = shown.view.nearer;
  StageOptions with = stage;
  with.shading.parts = {};
  auto beside = std::make_shared<Shown>(shown_of(other, view, with, companion.box));
  beside->lens_zoom = shown.lens_zoom;
  beside->surface = {companion.opened, &companion.opened->mesh};
  beside->fit = shown.fit = std::min(shown.fit, beside->fit);
  if (names.font != nullptr) {
    shown.caption = caption_of(names, names.own);
    beside->caption = caption_of(names, document.companion.path);
  }
  if (document.companion.difference_mm > 0) {
    shown.style = difference_style(shown.style, document.companion.difference_mm);
    shown.other = {};
  }
  shown.compared = std::move(beside);
}

CompanionTool::CompanionTool(ToolScene& scene, ReadSurface read, LabelFont& font)
    : scene_(scene), font_(font), loader_(read, {}), reads_(static_cast<bool>(read)) {}

void CompanionTool::fail_with(const Error& why) {
  failed_ = why;
  log_warning("{}", why.message);
  scene_.ask.say(why.message);
}

void CompanionTool::look_for(const Companion& wanted) {
  asked_ = wanted;
  failed_.reset();
  loader_.stop();
  if (wanted.path.empty() || (surface_ && same_file(wanted, shown_))) return;
  if (!reads_) return fail_with({ErrorKind::kUsage, "this session shows one surface, and no other"});
  if (const auto done = loader_.open({companion_file(*scene_.seen)}); !done) fail_with(done.error());
}

void CompanionTool::update(TimestampNs) {
  if (!same_file(scene_.seen->companion, asked_)) look_for(scene_.seen->companion);
  loader_.start();
  if (scene_.window.waits) loader_.wait();
  auto read = loader_.take();
  if (!read) return;
  if (!*read) return fail_with(read->error());
  surface_.emplace(**std::move(read));
  shown_ = asked_;
  if (surface_->opened->work.document.source.content != asked_.content)
    scene_.ask.say(tr("say.beside_changed", fs::path(asked_.path).filename().string()));
}

void CompanionTool::contribute(Shown& shown) {
  const Document& document = *scene_.seen;
  if (!surface_ || document.companion.path.empty() || !same_file(shown_, document.companion) || shown.compared) return;
  put_beside(shown, document, *surface_, *scene_.options, {&font_, own_name_, scene_.window.letters});
}

}  // namespace dubsar::app
