#pragma once
// A mesh as a display's panel shows it, without a window: `dubsar render --display NAME[:options]`, and tests of whole
// chains from the viewer to the panel's picture.

#include <memory>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image_io/image.h"
#include "core/mesh/tri_mesh.h"
#include "display/optics/off_axis.h"
#include "display/optics/optics.h"
#include "display/render/camera.h"
#include "display/render/shading.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/view_pictures.h"

namespace dubsar {

/// Where the object is put before the viewer: its box's centre at `place_mm` in the screen frame, turned as `direction`
/// says.
struct DisplayOptions {
  Screen screen{};
  Observer viewer{};  ///< front_mm and back_mm are set from the object
  ViewDirection direction{};
  glm::dvec3 place_mm{0.0, 0.0, 0.0};
  double magnification = 0.0;  ///< 1: life size; 0: as large as fits into the window
  double margin = 0.05;        ///< free border when it is fitted, 0..0.45
  Shading shading{};
  int samples = 2;  ///< samples x samples a pixel of a view, 1..8
  std::shared_ptr<SinkCatalog> catalog = std::make_shared<SinkCatalog>();  ///< displays and panels that may be named
};

struct DisplayPicture {
  Image image;  ///< what the sink composed, RGB
  int views = 0;
  double magnification = 0.0;
  std::string file_suffix;          ///< for the file's name, e.g. "_qs8x6a0.75"
  std::optional<PanelLight> light;  ///< for displays with lenses: see() and light_at() say what eyes see of the image
};

/// Errors: those of SinkCatalog::make, kUsage (no such sink, bad options, nothing to draw),
/// kUnavailable without GL 4.5, kTryAgain (memory), kCancelled. Cost: all views, one after the other.
Result<DisplayPicture> render_display(const TriMesh& mesh, const SinkSpec& display, const DisplayOptions& options,
                                      Progress& progress);

/// The numbered-view test pattern (display/render/images/test_pattern.h) as the display shows it. Uses the screen, the
/// viewer and the catalog of `options`. Errors as render_display.
Result<DisplayPicture> render_pattern(const SinkSpec& display, const DisplayOptions& options);

/// A picture that exists already, as the display shows it. Uses the screen, the viewer and the catalog of `options`.
/// Errors as render_display.
Result<DisplayPicture> show_pictures(const ViewPictures& pictures, const SinkSpec& display,
                                     const DisplayOptions& options);

/// What an eye (screen frame, mm) sees of the picture, of the panel's size. kUsage for displays without lenses, and for
/// eyes that are not before the panel.
Result<Image> see_display(const DisplayPicture& picture, const glm::dvec3& eye_mm);

/// screen_from_model: turns the object as `direction` says, scales it and puts the centre of `box` at `place_mm`.
glm::dmat4 place_object(const Box& box, const ViewDirection& direction, const glm::dvec3& place_mm,
                        double magnification);

}  // namespace dubsar
