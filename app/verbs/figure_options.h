#pragma once
// Options of `render` that make an article's figure: its size in print, its ground, a scale bar, words.

#include <string>
#include <vector>

#include "app/cli/arguments.h"
#include "app/document/document.h"
#include "core/image_io/picture_file.h"
#include "core/mesh/tablet_frame.h"
#include "display/render/images/render_image.h"

namespace dubsar::app {

struct FigureOptions {
  double dpi = 0.0, width_mm = 0.0;  ///< of the printed figure; 0: not said
  std::string ground;                ///< white, grey, black, none; empty: as the style has it
  bool scale_bar = false, labels = false;
  bool asked() const { return dpi > 0 || width_mm > 0 || !ground.empty() || scale_bar || labels; }
  /// Dots an inch in print, where they are said or follow from a width.
  double print_dpi() const { return dpi > 0 ? dpi : width_mm > 0 ? kFigureDpi : 0.0; }
  static constexpr double kFigureDpi = 600.0;  ///< what journals ask of line and tone together
};

void add_figure_options(Arguments& command, FigureOptions& options);

/// kUsage: options that contradict each other or those of the camera.
Result<void> check_figure(const FigureOptions& options, const CameraOptions& camera, bool sized, bool transparent);

/// Scale and ground. With dots an inch alone the figure is as large as the object; with a width it has round(width
/// / 25.4
/// * dpi) pixels. `mesh` is what will be drawn.
Result<void> apply_figure(const FigureOptions& options, const TriMesh& mesh, RenderOptions& render);

/// What stands in and below the figure.
struct FigureWords {
  std::string caption;        ///< "AO 8295, obverse"
  std::vector<Note> lines{};  ///< whose numbers stand beside their beginnings; in the mesh's mm
};
/// Name and side, and the lines that were kept. `way`: the mesh lies in its axes, seen from the side of that name
/// (front
/// ...); null: it lies as in the scan.
FigureWords figure_words(const std::string& file, const std::string& view, const Document& kept,
                         const TabletFrame* way);

/// Dots an inch, title and rights.
PictureOptions figure_file(const FigureOptions& options, const Picture& picture, const TabletRecord& record);

/// Draws numbers, bar and caption; the picture grows below. Errors of LabelFont::create().
Result<void> finish_figure(const FigureOptions& options, const FigureWords& words, const Shading& shading,
                           Picture& picture);

}  // namespace dubsar::app
