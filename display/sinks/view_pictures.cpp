#include "display/sinks/view_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/system/parallel.h"
#include "core/base/text/lower_text.h"
#include "display/optics/srgb.h"
#include "display/render/view_array.h"
#include "display/sinks/quilt.h"

namespace dubsar {
namespace {

using Kind = PictureLayout::Kind;

constexpr double kSameShape = 0.01;
constexpr int kLeastTilePx = 8;

/// Takes one word into `layout`; false when it is none of ours.
bool take_word(std::string_view word, PictureLayout& layout) {
  const auto pair = [&](Kind kind, bool right_first) {
    layout.kind = kind;
    layout.right_first = right_first;
    return true;
  };
  const bool half = word.size() > 2 && word.front() == 'h' && word != "half";
  if (half) word.remove_prefix(1);
  if (!half && word == "half") return layout.half = true;
  if (half && word != "sbs" && word != "tb" && word != "ou") return false;
  layout.half = layout.half || half;
  if (word == "sbs" || word == "lr") return pair(Kind::kSideBySide, false);
  if (word == "rl") return pair(Kind::kSideBySide, true);
  if (word == "tb" || word == "ou") return pair(Kind::kTopBottom, false);
  if (word == "bt") return pair(Kind::kTopBottom, true);
  return false;
}

PictureLayout quilt_layout(const QuiltName& name) {
  PictureLayout layout;
  layout.kind = Kind::kQuilt;
  layout.columns = name.columns;
  layout.rows = name.rows;
  layout.aspect = name.aspect;
  return layout;
}

Image part_of(const Image& picture, int x0, int y0, int width, int height) {
  Image out(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) std::copy_n(picture.at(x0 + x, y0 + y), 3, out.at(x, y));
  return out;
}

/// Weights of source pixels for one target pixel: a triangle that is as wide as a target pixel when that is larger than
/// a source pixel.
struct Taps {
  int first = 0;
  std::vector<float> weights;  ///< of first, first + 1, ..; they may sum to less than 1 at a picture's edge
};

/// Of target pixels along an axis: pixel i's middle comes from from[i], in source pixels; `step` source pixels apart.
Taps taps_at(double from, double step, int size) {
  const double reach = std::max(1.0, std::abs(step));
  Taps out;
  out.first = std::max(0, static_cast<int>(std::ceil(from - 0.5 - reach)));
  const int last = std::min(size - 1, static_cast<int>(std::floor(from - 0.5 + reach)));
  double sum = 0.0;
  for (int i = out.first; i <= last; ++i) {
    const double weight = std::max(0.0, 1.0 - std::abs(i + 0.5 - from) / reach);
    out.weights.push_back(static_cast<float>(weight));
    sum += weight;
  }
  if (from < 0.0 || from > size || sum <= 0.0) {  // beside the picture
    out.weights.clear();
    return out;
  }
  for (float& weight : out.weights) weight = static_cast<float>(weight / sum);
  return out;
}

}  // namespace

PictureLayout layout_of_name(std::string_view file_name) {
  const auto slash = file_name.find_last_of('/');
  std::string name = lower_text(slash == std::string_view::npos ? file_name : file_name.substr(slash + 1));
  if (const auto quilt = parse_quilt_name(name)) return quilt_layout(*quilt);
  PictureLayout layout;
  if (name.ends_with(".jps") || name.ends_with(".pns")) {
    layout.kind = Kind::kSideBySide;
    layout.right_first = true;
  }
  if (const auto dot = name.rfind('.'); dot != std::string::npos) name.erase(dot);
  std::size_t at = 0;
  for (bool first = true; at <= name.size(); first = false) {
    const std::size_t end = std::min(name.find_first_of("_-. ", at), name.size());
    if (!first) take_word(std::string_view(name).substr(at, end - at), layout);  // what a thing is called comes first
    at = end + 1;
  }
  if (layout.kind == Kind::kPlain) layout.half = false;
  return layout;
}

Result<PictureLayout> parse_picture_layout(std::string_view text) {
  constexpr std::string_view kExpected =
      "expected plain, sbs, lr, rl, tb, ou or bt, with half, or qsCOLUMNSxROWSaASPECT";
  const std::string words = lower_text(text);
  if (words == "plain") return PictureLayout{};
  if (const auto quilt = parse_quilt_name('_' + words); quilt && words.find(',') == std::string::npos)
    return quilt_layout(*quilt);
  PictureLayout layout;
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find(',', at), words.size());
    if (!take_word(std::string_view(words).substr(at, end - at), layout))
      return fail(ErrorKind::kUsage, "layout \"{}\" not understood at \"{}\", {}", text, words.substr(at, end - at),
                  kExpected);
    at = end + 1;
  }
  if (layout.kind == Kind::kPlain) return fail(ErrorKind::kUsage, "layout \"{}\" not understood, {}", text, kExpected);
  return layout;
}

Result<ViewPictures> split_picture(const Image& picture, const PictureLayout& layout) {
  const int columns = layout.kind == Kind::kQuilt ? layout.columns : layout.kind == Kind::kSideBySide ? 2 : 1;
  const int rows = layout.kind == Kind::kQuilt ? layout.rows : layout.kind == Kind::kTopBottom ? 2 : 1;
  const int width = picture.width / std::max(columns, 1), height = picture.height / std::max(rows, 1);
  if (width < kLeastTilePx || height < kLeastTilePx)
    return fail(ErrorKind::kBadData, "picture of {} x {} pixels: {} x {} views of at least {} pixels do not fit",
                picture.width, picture.height, columns, rows, kLeastTilePx);
  ViewPictures out;
  out.aspect = static_cast<double>(width) / height;
  if (layout.kind == Kind::kQuilt) {
    out.views = split_quilt(picture, {columns, rows, picture.width, picture.height});
    out.aspect = layout.aspect.value_or(out.aspect);
    return out;
  }
  if (layout.kind != Kind::kPlain && layout.half) out.aspect *= layout.kind == Kind::kSideBySide ? 2.0 : 0.5;
  // The second view is flush with the far side: an odd picture has a spare line between the two.
  out.views.push_back(part_of(picture, 0, 0, width, height));
  if (layout.kind != Kind::kPlain)
    out.views.push_back(part_of(picture, picture.width - width, picture.height - height, width, height));
  if (layout.right_first && out.views.size() == 2) std::swap(out.views[0], out.views[1]);
  return out;
}

int picture_for_layer(const ViewPictures& pictures, const SinkTraits& traits, int layer, const Observer& viewer) {
  const int count = static_cast<int>(pictures.views.size());
  if (count == 1) return 0;
  if (traits.views == 1) return count == 2 ? 0 : count / 2;
  if (traits.views > 2) return std::min(count - 1, static_cast<int>((layer + 0.5) / traits.views * count));
  const int eye = viewer.swap_eyes ? 1 - layer : layer;
  if (count == 2) return eye;
  const glm::dvec3& at = eye == 0 ? viewer.left_mm : viewer.right_mm;
  const double angle_deg = std::atan2(at.x, std::max(at.z, kNearestEyeMm)) * 180.0 / std::numbers::pi;
  const double place = angle_deg / pictures.cone_deg + 0.5;
  return static_cast<int>(std::clamp(std::floor(place * count), 0.0, count - 1.0));
}

Image layer_of_picture(const Image& picture, double picture_aspect, const SinkTraits& traits, int layer) {
  const double seen =
      traits.aspect > 0 ? traits.aspect : static_cast<double>(traits.output.width) / traits.output.height;
  const double ratio = picture_aspect / seen;
  glm::dvec2 filled(1.0);  // share of what is seen that the picture covers
  if (std::abs(ratio - 1.0) >= kSameShape) filled = ratio > 1.0 ? glm::dvec2(1.0, 1.0 / ratio) : glm::dvec2(ratio, 1.0);
  Image out(traits.view.width, traits.view.height, 4);
  const auto source = [&](double u, double v) {
    return (focus_source(traits.focus, layer, traits.views, {u, v}) - 0.5) / filled + 0.5;
  };
  std::vector<Taps> columns, rows;
  const double step_x = (source(1.0, 0.0).x - source(0.0, 0.0).x) * picture.width / out.width;
  const double step_y = (source(0.0, 1.0).y - source(0.0, 0.0).y) * picture.height / out.height;
  for (int x = 0; x < out.width; ++x)
    columns.push_back(taps_at(source((x + 0.5) / out.width, 0.0).x * picture.width, step_x, picture.width));
  for (int y = 0; y < out.height; ++y)
    rows.push_back(taps_at(source(0.0, (y + 0.5) / out.height).y * picture.height, step_y, picture.height));
  const auto& light = linear_of_byte();
  parallel_for(out.height, 16, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    const Taps& down = rows[static_cast<std::size_t>(row)];
    for (int x = 0; x < out.width; ++x) {
      const Taps& across = columns[static_cast<std::size_t>(x)];
      std::array<double, 3> sum{};
      for (std::size_t j = 0; j < down.weights.size(); ++j)
        for (std::size_t i = 0; i < across.weights.size(); ++i) {
          const std::uint8_t* const from =
              picture.at(across.first + static_cast<int>(i), down.first + static_cast<int>(j));
          const double weight = static_cast<double>(down.weights[j]) * across.weights[i];
          for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * light[from[c]];
        }
      std::uint8_t* const to = out.at(x, y);
      for (std::size_t c = 0; c < 3; ++c) to[c] = srgb_from_linear(sum[c]);
      to[3] = 255;
    }
  });
  return out;
}

Result<void> write_pictures(const ViewPictures& pictures, const SinkTraits& traits, const Observer& viewer,
                            ViewArray& layers) {
  DUBSAR_CHECK(!pictures.views.empty());
  for (int layer = 0; layer < traits.views; ++layer) {
    const int chosen = picture_for_layer(pictures, traits, layer, viewer);
    DUBSAR_TRY(layers.write_layer(
        layer, layer_of_picture(pictures.views[static_cast<std::size_t>(chosen)], pictures.aspect, traits, layer)));
  }
  return {};
}

}  // namespace dubsar
