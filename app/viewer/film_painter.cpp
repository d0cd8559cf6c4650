#include "app/viewer/film_painter.h"

#include <algorithm>

#include "app/panels/overlay.h"
#include "app/panels/panel_font.h"
#include "app/viewer/first_document.h"

namespace dubsar::app {
namespace {

Result<void> check_traits(const SinkTraits& traits) {
  if (traits.worn)
    return fail(ErrorKind::kUsage, "display {}: is worn and shows what is there now, expected one that makes a picture",
                traits.name);
  if (traits.fields > 1 || traits.stereo_visual)
    return fail(ErrorKind::kUsage,
                "display {}: shows its eyes one after the other, expected one that makes a picture of both such as "
                "side_by_side",
                traits.name);
  return {};
}

}  // namespace

Document film_document(const Document& base, const TriMesh& mesh) {
  ViewOptions options;
  options.work.document = base;
  return first_document(options, mesh).document;
}

std::vector<std::string> strange_parts(std::span<const Keyframe> film, const Document& document) {
  std::vector<std::string> out;
  for (const Keyframe& key : film)
    for (const KeyedPart& keyed : key.parts) {
      const bool known = std::any_of(document.parts.begin(), document.parts.end(),
                                     [&](const Part& part) { return part.name == keyed.name; });
      if (!known && std::find(out.begin(), out.end(), keyed.name) == out.end()) out.push_back(keyed.name);
    }
  return out;
}

Result<FilmPainter> FilmPainter::create(const TriMesh& mesh, const StageOptions& options, Document document,
                                        std::vector<Keyframe> film, std::optional<CompanionSurface> companion) {
  DUBSAR_ASSIGN(auto sink, options.catalog->make(options.display));
  DUBSAR_TRY(sink->configure(options.screen));
  DUBSAR_TRY(check_traits(sink->traits()));
  DUBSAR_ASSIGN(auto presenter, FilePresenter::create());
  StageOptions exact = options;
  exact.quality = Quality::kExact;
  DUBSAR_ASSIGN(auto stage, Stage::create(mesh, exact, std::move(sink)));
  DUBSAR_TRY(presenter->fit(stage->traits()));
  FilmPainter out(std::move(presenter), std::move(stage));
  out.options_ = std::move(exact);
  out.document_ = std::move(document);
  out.film_ = std::move(film);
  out.companion_ = std::move(companion);
  if (out.companion_) {
    DUBSAR_ASSIGN(out.font_, LabelFont::create(panel_font()));
  }
  return out;
}

Result<DisplayPicture> FilmPainter::picture(double time_s) {
  Document now = document_;
  show_keyframe(now, moment_at(film_, time_s));
  Shown shown = shown_of(now, view_of(now), options_, stage_->box_mm());
  const int height = stage_->traits().view.height;
  const double letters = std::max(1.0, height / Overlay::layout(height, stage_->window_mm(), 0.0).y);
  if (companion_) put_beside(shown, now, *companion_, options_, {font_.get(), now.source.path, letters});
  stage_->show(shown, FollowedEyes(), 0);
  DUBSAR_TRY(stage_->paint(presenter_->surface()));
  const SinkTraits traits = stage_->traits();
  DisplayPicture out;
  DUBSAR_ASSIGN(out.image, presenter_->picture());
  out.views = traits.views;
  out.file_suffix = traits.file_suffix;
  out.light = stage_->light();
  return out;
}

}  // namespace dubsar::app
