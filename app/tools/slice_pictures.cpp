#include "app/tools/slice_pictures.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "app/stage/ground_color.h"

namespace dubsar::app {
namespace {

constexpr double kRoom = 1.1;                             // around the surface at zoom 1
constexpr double kDarkShare = 0.01, kLightShare = 0.995;  // of the values that are black and white
constexpr Rgb8 kSurfaceColour{0xe8, 0xb4, 0x4c}, kPatchColour{0x56, 0xb4, 0xff};
constexpr int kMostSide = 8192;
constexpr double kOutlineSide = 1024.0;  // pixels where there is no scan

Rgb8 grey_of(float value, double black, double white) {
  if (std::isnan(value)) return kGroundColor;
  const double share = std::clamp((double{value} - black) / (white - black), 0.0, 1.0);
  const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * share));
  return {grey, grey, grey};
}

/// Values that are shown black and white where nobody says: those that 1 % are below and .5 % above.
std::optional<std::array<double, 2>> greys_of(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return std::nullopt;
  const auto at = [&](double share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return double{*place};
  };
  const double black = at(kDarkShare), white = at(kLightShare);
  return std::array{black, white > black ? white : black + 1.0};
}

void draw_line(Image& image, const glm::dvec2& a, const glm::dvec2& b, const Rgb8& color) {
  const double length = std::max(1.0, std::ceil(2.0 * glm::distance(a, b)));
  for (double i = 0; i <= length; ++i) {
    const glm::dvec2 p = glm::mix(a, b, i / length);
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
    std::copy_n(&color[0], 3, image.at(x, y));
  }
}

}  // namespace

SlicePictures::SlicePictures(const TriMesh& mesh, const Box& box_mm, std::optional<ScanLink> link)
    : mesh_(mesh), link_(std::move(link)) {
  const glm::dvec3 size = box_mm.size();
  whole_mm_ = kRoom * std::max({size.x, size.y, size.z, 1e-6});
}

void SlicePictures::update(const ScanView& view, const std::array<PanelRect, kSlices>& rects, const glm::dvec2& px) {
  if (!reader_) {
    SliceReader::OpenScan open;
    if (link_) open = [link = *link_] { return open_scan(link); };
    reader_ = std::make_unique<SliceReader>(mesh_, std::move(open));
  }
  for (std::size_t i = 0; i < kSlices; ++i) {
    SlicePane& pane = state_.panes[i];
    if (!rects[i].shown()) {
      pane.wanted = {};
      continue;
    }
    pane.wanted = slice_frame(view, i, static_cast<int>(std::lround(double{rects[i].width} * px.x)),
                              static_cast<int>(std::lround(double{rects[i].height} * px.y)), whole_mm_);
    reader_->ask(i, pane.wanted);
  }
  state_.note = reader_->note();
  state_.scan = reader_->has_scan();
  std::array<SharedSlice, kSlices> now;
  for (std::size_t i = 0; i < kSlices; ++i) now[i] = reader_->picture(i);
  const std::array before{state_.black, state_.white};
  std::array<bool, kSlices> other{};
  for (std::size_t i = 0; i < kSlices; ++i) {
    other[i] = state_.panes[i].picture != now[i];
    state_.panes[i].picture = std::move(now[i]);
  }
  find_greys(view);
  const bool greys = before != std::array{state_.black, state_.white};
  for (std::size_t i = 0; i < kSlices; ++i)
    if (other[i] || greys) shade(state_.panes[i], textures_[i]);
  state_.value.reset();
  for (const SlicePane& pane : state_.panes) {
    if (!pane.ready() || pane.picture->image.values.empty()) continue;
    const glm::dvec2 at = glm::floor(pane.wanted.px_at(view.cursor_mm));
    if (at.x < 0 || at.y < 0 || at.x >= pane.wanted.width || at.y >= pane.wanted.height) continue;
    const float value =
        pane.picture->image.values[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(pane.wanted.width) +
                                   static_cast<std::size_t>(at.x)];
    if (!std::isnan(value)) state_.value = value;
    break;
  }
}

void SlicePictures::wait() {
  if (reader_) reader_->wait();
}

/// As the view says; else as the first exact pictures have them, and until there are any, as the coarse ones do.
void SlicePictures::find_greys(const ScanView& view) {
  if (!greys_exact_) {
    std::vector<float> values;
    bool exact = false;
    for (const SlicePane& pane : state_.panes) {
      if (!pane.picture) continue;
      exact = exact || pane.picture->image.exact();
      values.insert(values.end(), pane.picture->image.values.begin(), pane.picture->image.values.end());
    }
    if (!values.empty() && (!greys_ || exact)) {
      if (const auto found = greys_of(std::move(values))) {
        greys_ = found;
        greys_exact_ = exact;
      }
    }
  }
  const std::array given{view.black, view.white};
  const auto greys = view.black != view.white ? given : greys_.value_or(std::array{0.0, 1.0});
  state_.black = greys[0];
  state_.white = greys[1];
}

void SlicePictures::shade(SlicePane& pane, GlTexture& texture) const {
  pane.texture = 0;
  ++pane.shade;
  if (!pane.picture || pane.picture->image.values.empty()) return;
  const PlaneImage& image = pane.picture->image;
  std::vector<std::uint8_t> pixels(4 * image.values.size(), 255);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const Rgb8 color = grey_of(image.values[i], state_.black, state_.white);
    std::copy_n(&color[0], 3, &pixels[4 * i]);
  }
  texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture, 1, GL_RGBA8, image.width, image.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(texture, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTextureParameteri(texture, wrap, GL_CLAMP_TO_EDGE);
  pane.texture = texture;
}

std::vector<LinesItem> SlicePictures::lines(const ScanView& view, const PartLooks& parts) const {
  std::vector<LinesItem> out;
  const std::size_t which = view.large > 0 ? static_cast<std::size_t>(view.large - 1) : 3;
  if (const SharedSlice& picture = state_.panes[which].picture) {
    LinesItem cut;
    cut.width_px = 2.0;
    cut.color = kSurfaceColour;
    cut.hidden_opacity = 0.1;
    for (const OutlinePiece& piece : picture->outline) {
      const PartLook& look = parts[std::min<std::size_t>(piece.partition, parts.size() - 1)];
      if (!look.visible || look.opacity == 0) continue;
      cut.points_mm.push_back(picture->frame.mm_at(piece.a) + look.offset_mm);
      cut.points_mm.push_back(picture->frame.mm_at(piece.b) + look.offset_mm);
    }
    if (!cut.points_mm.empty()) out.push_back(std::move(cut));
  }
  LinesItem cross;
  cross.width_px = 2.0;
  cross.hidden_opacity = 0.6;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (const double reach : {0.004, 0.02}) {
        glm::dvec3 p = view.cursor_mm;
        p[axis] += side * reach * whole_mm_;
        cross.points_mm.push_back(p);
      }
  out.push_back(std::move(cross));
  return out;
}

Result<Image> SlicePictures::whole(const ScanView& view, std::size_t which) {
  OpenedScan scan;
  scan.voxel_mm = glm::dvec3(whole_mm_ / kOutlineSide);
  if (link_) {
    DUBSAR_ASSIGN(scan, open_scan(*link_));
  }
  const double voxel = std::min({scan.voxel_mm.x, scan.voxel_mm.y, scan.voxel_mm.z});
  const double side = std::ceil(whole_mm_ / voxel - 1e-6);
  if (side > kMostSide)
    return fail(ErrorKind::kTryAgain, "write_slice: {:.0f} pixels on a side, expected at most {}", side, kMostSide);
  ScanView all = view;
  all.zoom = 1.0;
  const SliceFrame frame = slice_frame(all, which, static_cast<int>(side), static_cast<int>(side), side * voxel);
  Image out(frame.width, frame.height, 3);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = kGroundColor[i % 3];
  if (scan.sampler) {
    DUBSAR_ASSIGN(const PlaneImage values, scan.sampler->sample(frame.grid(scan.voxel_mm)));
    std::array greys{view.black, view.white};
    if (view.black == view.white) greys = greys_of(values.values).value_or(std::array{0.0, 1.0});
    for (std::size_t i = 0; i < values.values.size(); ++i) {
      const Rgb8 color = grey_of(values.values[i], greys[0], greys[1]);
      std::copy_n(&color[0], 3, &out.pixels[3 * i]);
    }
  }
  for (const OutlinePiece& piece : outline_in(mesh_, frame))
    draw_line(out, piece.a, piece.b, piece.inferred ? kPatchColour : kSurfaceColour);
  return out;
}

}  // namespace dubsar::app
