#include "app/verbs/figure_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "app/document/export_choice.h"
#include "app/panels/panel_font.h"
#include "app/publish/xmp.h"
#include "core/edition/line_label.h"
#include "display/render/images/label_text.h"

namespace dubsar::app {
namespace {

// mm in print, as figures of articles have them.
constexpr double kFigureLetters = 2.8, kFigureBar = 0.7, kFigureGap = 2.0;
constexpr int kLeastFigureLetters = 12;  // pixels
constexpr double kFacing = 0.2;          // cosine: a line that is seen flatter is not numbered

/// Of what is drawn, where it is drawn; mm.
Box figure_box(const TriMesh& mesh, const PartLooks& parts) {
  Box box{glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const PartLook& look = parts[mesh.partition_of(t) % parts.size()];
    if (!look.visible) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      const glm::dvec3 p = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])) + look.offset_mm;
      if (!std::isfinite(p.x + p.y + p.z)) continue;
      box.min = glm::min(box.min, p);
      box.max = glm::max(box.max, p);
    }
  }
  return box;
}

/// 1, 2, 5, 10, 20, 50 ... mm: the longest that a third of the picture holds.
double bar_length_mm(double width_mm) {
  double best = 0.001;
  for (double decade = 0.001; decade < 1e6; decade *= 10.0)
    for (const double step : {1.0, 2.0, 5.0})
      if (step * decade <= width_mm / 3.0) best = std::max(best, step * decade);
  return best;
}

std::string bar_words(double mm) { return mm < 10.0 ? fmt::format("{:g} mm", mm) : fmt::format("{:g} cm", mm / 10.0); }

Rgb8 ink_on(const Shading& shading) {
  const Rgb8& ground = shading.background.color;
  const bool dark = !shading.background.transparent && ground[0] + ground[1] + ground[2] < 384;
  return dark ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
}

void fill_box(Image& image, int x0, int y0, int x1, int y1, const Rgb8& color) {
  for (int y = std::max(0, y0); y < std::min(y1, image.height); ++y)
    for (int x = std::max(0, x0); x < std::min(x1, image.width); ++x) {
      std::copy(color.begin(), color.end(), image.at(x, y));
      if (image.channels == 4) image.at(x, y)[3] = 255;
    }
}

/// Rows of the ground below the picture.
void grow(Image& image, int rows, const Shading& shading) {
  Image out(image.width, image.height + rows, image.channels);
  std::copy(image.pixels.begin(), image.pixels.end(), out.pixels.begin());
  if (!shading.background.transparent) fill_box(out, 0, image.height, out.width, out.height, shading.background.color);
  image = std::move(out);
}

}  // namespace

void add_figure_options(Arguments& command, FigureOptions& options) {
  command.value("--dpi", options.dpi, "dots an inch: at life size, or of a figure of --width-mm (600)")
      .range(kFigureDpi.least, kFigureDpi.most);
  command.value("--width-mm", options.width_mm, "width of the printed figure, e.g. 85 for a column")
      .range(kFigureMm.least, kFigureMm.most);
  command.value("--ground", options.ground, "white, grey, black, or none (transparent)")
      .one_of({"white", "grey", "black", "none"});
  command.flag("--scale-bar", options.scale_bar, "a bar with its length, below the object");
  command.flag("--labels", options.labels, "name and side below it, numbers of the lines that were kept beside them");
}

Result<void> check_figure(const FigureOptions& options, const CameraOptions& camera, bool sized, bool transparent) {
  if ((options.dpi > 0 || options.width_mm > 0) && (camera.mm_per_pixel > 0 || sized))
    return fail(ErrorKind::kUsage,
                "--dpi or --width-mm found with {}, expected one way to say how large the picture is",
                sized ? "--size" : "--mm-per-pixel");
  if (camera.perspective && (options.dpi > 0 || options.width_mm > 0 || options.scale_bar))
    return fail(ErrorKind::kUsage,
                "--perspective has no scale, expected none of --dpi, --width-mm and --scale-bar with it");
  if (transparent && !options.ground.empty() && options.ground != "none")
    return fail(ErrorKind::kUsage, "--transparent found with --ground {}, expected one of them", options.ground);
  return {};
}

Result<void> apply_figure(const FigureOptions& options, const TriMesh& mesh, RenderOptions& render) {
  Background& ground = render.shading.background;
  if (options.ground == "none") ground.transparent = true;
  if (options.ground == "white") ground.color = {255, 255, 255};
  if (options.ground == "grey") ground.color = {128, 128, 128};
  if (options.ground == "black") ground.color = {0, 0, 0};
  if (options.print_dpi() <= 0) return {};
  CameraOptions& camera = render.camera;
  camera.width = camera.height = 0;
  camera.mm_per_pixel = 25.4 / options.print_dpi();
  if (options.width_mm <= 0) return {};
  const Box box = figure_box(mesh, render.shading.parts);
  const double wanted_px = std::round(options.width_mm / 25.4 * options.print_dpi());
  CameraOptions fine = camera;  // how wide all of it is, with its border
  constexpr double kFine = 20000.0;
  fine.mm_per_pixel = std::max(glm::length(box.size()), 1e-9) / kFine;
  DUBSAR_ASSIGN(const Camera fitted, fit_camera(box, fine));
  camera.mm_per_pixel = fine.mm_per_pixel * fitted.width / wanted_px;
  return {};
}

FigureWords figure_words(const std::string& file, const std::string& view, const Document& kept,
                         const TabletFrame* way) {
  FigureWords out;
  out.caption = name_of(kept.edition.record);
  if (out.caption.empty()) out.caption = std::filesystem::path(file).stem().string();
  constexpr std::array<std::pair<const char*, const char*>, 6> kViewSides{{{"front", "obverse"},
                                                                           {"back", "reverse"},
                                                                           {"left", "left edge"},
                                                                           {"right", "right edge"},
                                                                           {"top", "upper edge"},
                                                                           {"bottom", "lower edge"}}};
  for (const auto& [name, side] : kViewSides)
    if (way != nullptr && view == name) out.caption += std::string(", ") + side;
  const glm::dmat3 turn = way != nullptr ? way->tablet_from_model() : glm::dmat3(1.0);
  for (Note line : kept.notes) {
    if (line.line_mm.size() < 2) continue;
    line.line_mm.front() = turn * line.line_mm.front();
    line.normal = turn * line.normal;
    out.lines.push_back(std::move(line));
  }
  return out;
}

PictureOptions figure_file(const FigureOptions& options, const Picture& picture, const TabletRecord& record) {
  PictureOptions out;
  out.dpi = options.print_dpi() > 0 ? options.print_dpi() : picture.dpi();
  out.description = name_of(record);
  out.copyright = record.rights;
  out.xmp = xmp_packet({out.description, record.rights, record.institution, "dubsar " DUBSAR_VERSION});
  return out;
}

Result<void> finish_figure(const FigureOptions& options, const FigureWords& words, const Shading& shading,
                           Picture& picture) {
  if (!options.scale_bar && !options.labels) return {};
  DUBSAR_ASSIGN(const auto font, LabelFont::create(panel_font()));
  Image& image = picture.image;
  const double dpi = options.print_dpi() > 0 ? options.print_dpi() : 25.4 / picture.mm_per_pixel;
  const double per_mm = dpi / 25.4;
  // At life size in print; of pictures that nobody prints, of their height.
  const double letters = options.print_dpi() > 0 ? std::max<double>(kLeastFigureLetters, kFigureLetters * per_mm)
                                                 : std::max<double>(kLeastFigureLetters, image.height / 45.0);
  const double mm = letters / kFigureLetters;  // one of print, in pixels
  const Rgb8 ink = ink_on(shading);
  const int object_height = image.height;
  if (options.labels)
    for (const Note& line : words.lines) {
      const glm::dvec4 at = picture.clip_from_mm * glm::dvec4(line.line_mm.front(), 1.0);
      const auto spot = spot_of_label(line.label);
      if (!spot || glm::dot(line.normal, picture.to_viewer) < kFacing) continue;
      const double x = (0.5 + 0.5 * at.x / at.w) * image.width, y = (0.5 - 0.5 * at.y / at.w) * object_height;
      // Letters of the ground's ink on clay are lost: they stand on a small ground of their own.
      const double width = letters * font->width_em(spot->number);
      fill_box(image, static_cast<int>(x - width - mm), static_cast<int>(y - 0.55 * letters),
               static_cast<int>(x - 0.5 * mm), static_cast<int>(y + 0.6 * letters), {255, 255, 255});
      write_text(image, *font, spot->number, x - width - 0.75 * mm, y + 0.35 * letters, letters, {0, 0, 0});
    }
  const int row = static_cast<int>(std::lround(1.5 * letters + kFigureGap * mm));
  grow(image, row, shading);
  const double base = object_height + 1.1 * letters;
  double x = kFigureGap * mm;
  if (options.scale_bar) {
    const double bar_mm = bar_length_mm(image.width * picture.mm_per_pixel);
    const int left = static_cast<int>(std::lround(x)),
              length = static_cast<int>(std::lround(bar_mm / picture.mm_per_pixel));
    const int top = static_cast<int>(std::lround(base - 0.35 * letters - 0.5 * kFigureBar * mm));
    fill_box(image, left, top, left + length, top + std::max(2, static_cast<int>(std::lround(kFigureBar * mm))), ink);
    picture.bar_mm = bar_mm;
    picture.bar_px = length;
    const std::string text = bar_words(bar_mm);
    write_text(image, *font, text, left + length + mm, base, letters, ink);
    x = left + length + 4.0 * mm + letters * font->width_em(text);
  }
  if (options.labels && !words.caption.empty()) {
    const double room = image.width - x - kFigureGap * mm, wide = letters * font->width_em(words.caption);
    const double size = wide > room ? letters * room / wide : letters;
    if (size > 4.0)
      write_text(image, *font, words.caption, image.width - kFigureGap * mm - size * font->width_em(words.caption),
                 base, size, ink);
  }
  return {};
}

}  // namespace dubsar::app
