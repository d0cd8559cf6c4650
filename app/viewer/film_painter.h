#pragma once
// The pictures of a film, without a window: what a session would show at each time, always with all triangles.

#include <memory>
#include <span>
#include <vector>

#include "app/document/document.h"
#include "app/stage/stage.h"
#include "app/viewer/companion.h"
#include "app/viewer/presenter/presenter.h"
#include "display/sinks/render_display.h"

namespace dubsar::app {

/// The document that a film of this surface is shown with: its parts are those of `mesh`, with the looks that `base`
/// has for parts of the same names; style, cuts and fog are those of `base`.
Document film_document(const Document& base, const TriMesh& mesh);

/// Names of parts in the film that the surface does not have, each once, in the film's order.
std::vector<std::string> strange_parts(std::span<const Keyframe> film, const Document& document);

/// One thread. A picture depends on its time alone, not on those that were made before it.
class FilmPainter {
 public:
  /// `companion` is what the document names, where it does. `options` says which display, of how many pixels, and how
  /// many samples. kUsage for displays that make no single picture (worn ones, and those that show fields in turn);
  /// kUnavailable without GL 4.5; errors of Stage::create().
  static Result<FilmPainter> create(const TriMesh& mesh, const StageOptions& options, Document document,
                                    std::vector<Keyframe> film, std::optional<CompanionSurface> companion = {});

  /// What the display's panel shows at `time_s`, RGB.
  Result<DisplayPicture> picture(double time_s);
  SinkTraits traits() const { return stage_->traits(); }

 private:
  FilmPainter(std::unique_ptr<FilePresenter> presenter, std::unique_ptr<Stage> stage)
      : presenter_(std::move(presenter)), stage_(std::move(stage)) {}
  std::unique_ptr<FilePresenter> presenter_;  // has the context, goes last
  std::unique_ptr<Stage> stage_;
  StageOptions options_;
  Document document_;
  std::vector<Keyframe> film_;
  std::optional<CompanionSurface> companion_;
  std::unique_ptr<LabelFont> font_;
};

}  // namespace dubsar::app
