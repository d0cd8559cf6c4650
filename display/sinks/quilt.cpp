#include "display/sinks/quilt.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"

namespace dubsar {
namespace {

constexpr GLint kTileLocation = 0, kColumnsLocation = 1;  // shaders/quilt.frag
constexpr int kMaxTiles = 100, kMinTilePx = 8, kMaxQuiltPx = 16384;
constexpr double kMinAspect = 0.05, kMaxAspect = 20.0;
constexpr double kFieldOfViewDeg =
    14.0;  // vertical, at the place the maker expects the viewer (Looking Glass documentation)

/// Letters of "_qs8x6a0.75" or "_qs8x6" at the start of `text`; 0 when it starts otherwise.
std::size_t suffix_length(std::string_view text) {
  std::size_t at = 3;
  const auto digits = [&] {
    const std::size_t first = at;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
    return at > first;
  };
  const auto letter = [&](char c) { return at < text.size() && text[at] == c && (++at, true); };
  if (!digits() || !letter('x') || !digits()) return 0;
  std::size_t end = at;
  if (letter('a') && digits()) {
    end = at;
    if (letter('.') && digits()) end = at;
  }
  return end;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

struct QuiltSetup {
  QuiltLayout layout;
  double aspect = 0.0, cone_deg = 0.0;
  ViewFocus focus{};
  double height_mm = 0.0, distance_mm = 0.0;  ///< 0: from the screen, from the field of view
};

class QuiltSink : public OutputSink {
 public:
  explicit QuiltSink(const QuiltSetup& setup) : setup_(setup) {}

  SinkTraits traits() const noexcept override {
    const QuiltLayout& layout = setup_.layout;
    return {.name = "quilt",
            .views = layout.views(),
            .view = {layout.tile_width(), layout.tile_height()},
            .output = {layout.width_px, layout.height_px},
            .own_pixels = true,
            .own_size = setup_.height_mm > 0,
            .aspect = setup_.aspect,
            .focus = setup_.focus,
            .file_suffix = quilt_suffix(layout.columns, layout.rows, setup_.aspect)};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_height_mm_ = screen.height_mm;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override {
    const double half_h = (setup_.height_mm > 0 ? setup_.height_mm : screen_height_mm_) / 2;
    const double half_w = half_h * setup_.aspect;
    const double distance =
        setup_.distance_mm > 0 ? setup_.distance_mm : half_h / std::tan(radians(kFieldOfViewDeg) / 2);
    const WindowRect window{{-half_w, -half_h, 0}, {half_w, -half_h, 0}, {-half_w, half_h, 0}};
    views_.clear();
    for (const glm::dvec3& eye : cone_eyes(setup_.layout.views(), radians(setup_.cone_deg), distance))
      views_.push_back(focused_view(viewer_view(window, viewer, eye), setup_.focus, static_cast<int>(views_.size()),
                                    setup_.layout.views()));
    return views_;
  }
  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    DUBSAR_TRY(pass_.begin(target, views.coded()));
    glUniform2i(kTileLocation, setup_.layout.tile_width(), setup_.layout.tile_height());
    glUniform2i(kColumnsLocation, setup_.layout.columns, setup_.layout.rows);
    return pass_.draw();
  }

 private:
  QuiltSetup setup_;
  double screen_height_mm_ = Screen().height_mm;
  std::vector<View> views_;
  ComposePass pass_{"quilt.frag"};
};

}  // namespace

std::string quilt_suffix(int columns, int rows, double aspect) {
  return fmt::format("_qs{}x{}a{:.5g}", columns, rows, aspect);
}

std::filesystem::path name_with_suffix(const std::filesystem::path& path, std::string_view suffix) {
  if (suffix.empty()) return path;
  std::string stem = path.stem().string();
  for (std::size_t at = stem.find("_qs"); at != std::string::npos; at = stem.find("_qs", at)) {
    if (const std::size_t length = suffix_length(std::string_view(stem).substr(at)); length > 0)
      stem.erase(at, length);
    else
      ++at;
  }
  std::filesystem::path out = path;
  return out.replace_filename(stem + std::string(suffix) + path.extension().string());
}

std::optional<QuiltName> parse_quilt_name(std::string_view file_name) {
  const auto mark = file_name.rfind("_qs");
  if (mark == std::string_view::npos) return std::nullopt;
  const char* at = file_name.data() + mark + 3;
  const char* const end = file_name.data() + file_name.size();
  QuiltName name;
  auto number = std::from_chars(at, end, name.columns);
  if (number.ec != std::errc() || number.ptr == end || *number.ptr != 'x') return std::nullopt;
  number = std::from_chars(number.ptr + 1, end, name.rows);
  if (number.ec != std::errc()) return std::nullopt;
  if (name.columns < 1 || name.rows < 1 || name.columns > kMaxTiles || name.rows > kMaxTiles) return std::nullopt;
  if (number.ptr == end || *number.ptr != 'a') return name;
  double aspect = 0;
  // Fixed notation: an exponent would swallow the e of an extension.
  number = std::from_chars(number.ptr + 1, end, aspect, std::chars_format::fixed);
  if (number.ec != std::errc() || !(aspect >= kMinAspect && aspect <= kMaxAspect)) return std::nullopt;
  name.aspect = aspect;
  return name;
}

PixelSize quilt_tile_corner(const QuiltLayout& layout, int view) noexcept {
  return {view % layout.columns * layout.tile_width(), view / layout.columns * layout.tile_height()};
}

std::vector<Image> split_quilt(const Image& quilt, const QuiltLayout& layout) {
  std::vector<Image> views;
  for (int i = 0; i < layout.views(); ++i) {
    Image view(layout.tile_width(), layout.tile_height(), 3);
    const PixelSize corner = quilt_tile_corner(layout, i);
    const int top = layout.height_px - corner.height - layout.tile_height();
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) std::copy_n(quilt.at(corner.width + x, top + y), 3, view.at(x, y));
    views.push_back(std::move(view));
  }
  return views;
}

Result<std::unique_ptr<OutputSink>> make_quilt_sink(SinkOptions options) {
  QuiltSetup setup{.layout = {8, 6, 3360, 3360}, .aspect = 0.75, .cone_deg = 40.0};  // a Looking Glass Portrait
  DUBSAR_ASSIGN(const auto panel, options.panel());
  if (panel) {
    const PanelProfile& profile = *panel;
    if (profile.quilt.views() < 1)
      return fail(ErrorKind::kUsage, "display quilt: panel \"{}\" takes no quilts, expected a Looking Glass",
                  profile.name);
    setup = {.layout = profile.quilt,
             .aspect = profile.aspect,
             .cone_deg = profile.zone.cone_deg,
             .height_mm = profile.height_mm(),
             .distance_mm = profile.zone.design_distance_mm};
  }
  QuiltLayout& layout = setup.layout;
  layout = {options.whole("columns", 1, kMaxTiles, layout.columns), options.whole("rows", 1, kMaxTiles, layout.rows),
            options.whole("width", kMinTilePx, kMaxQuiltPx, layout.width_px),
            options.whole("height", kMinTilePx, kMaxQuiltPx, layout.height_px)};
  setup.aspect = options.number("aspect", kMinAspect, kMaxAspect, setup.aspect);
  setup.cone_deg = options.number("cone", 1, 170, setup.cone_deg);
  setup.focus = options.focus();
  DUBSAR_TRY(options.finish(
      "panel=PROFILE, calibration=FILE, columns=, rows=, width=, height=, aspect=, cone=, focus=, zoom="));
  if (setup.layout.tile_width() < kMinTilePx || setup.layout.tile_height() < kMinTilePx)
    return fail(ErrorKind::kUsage, "display quilt: tiles of {} x {} pixels are too small, expected at least {} a side",
                setup.layout.tile_width(), setup.layout.tile_height(), kMinTilePx);
  return std::make_unique<QuiltSink>(setup);
}

}  // namespace dubsar
