#include "core/volume/formats/tiff_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/base/numbers/units.h"
#include "core/base/text/json_text.h"

namespace dubsar {
namespace {

constexpr double kMostImages = 65535.0;
constexpr std::int64_t kMostComposite = 7;  ///< channels that ImageJ shows together (CompositeImage.MAX_CHANNELS)

double to_number(std::string_view text, double otherwise) {
  double value = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return std::isfinite(value) ? value : otherwise;
}

std::int64_t count_of(double value) {
  return value >= 1.0 && value <= kMostImages ? static_cast<std::int64_t>(value) : 1;
}

void add_several(TiffDescription& out, std::int64_t count, std::string_view what) {
  if (count <= 1) return;
  out.several = true;
  out.several_of += fmt::format("{}{} {}", out.several_of.empty() ? "" : ", ", count, what);
}

/// Lines "name=value".
TiffDescription imagej(std::string_view text) {
  std::map<std::string, std::string, std::less<>> fields;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    if (const auto equals = line.find('='); equals != std::string_view::npos)
      fields.emplace(line.substr(0, equals), line.substr(equals + 1));
    begin = end + 1;
  }
  const auto number = [&](const char* key, double otherwise) {
    const auto found = fields.find(key);
    return found == fields.end() ? otherwise : to_number(found->second, otherwise);
  };
  TiffDescription out;
  out.said_by = "ImageJ";
  out.images = count_of(number("images", 1.0));
  const std::int64_t channels = count_of(number("channels", 1.0)), frames = count_of(number("frames", 1.0));
  // tifffile counts the slices of an array of three axes as channels where it is told no axes.
  const bool slices = channels > kMostComposite && frames == 1 && count_of(number("slices", 1.0)) == 1;
  if (slices) out.slices = channels;
  add_several(out, slices ? 1 : channels, "channels");
  add_several(out, frames, "time points");
  if (const auto unit = fields.find("unit"); unit != fields.end()) out.unit_mm = mm_per_unit(unit->second);
  out.spacing = number("spacing", 0.0);
  return out;
}

/// The text of an attribute with its entities: "&#181;m", "&#xB5;m".
std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::size_t end = text[at] == '&' ? text.find(';', at) : std::string_view::npos;
    if (end == std::string_view::npos || end - at > 8) {
      out += text[at];
      continue;
    }
    const std::string_view name = text.substr(at + 1, end - at - 1);
    int code = 0;
    if (name.starts_with("#x") || name.starts_with("#X"))
      std::from_chars(name.data() + 2, name.data() + name.size(), code, 16);
    else if (name.starts_with('#'))
      std::from_chars(name.data() + 1, name.data() + name.size(), code);
    if (code == 0xB5 || code == 0x3BC)
      out += "\u00B5";
    else if (code == 0xC5 || code == 0x212B)
      out += "\u00C5";
    else if (code > 0 && code < 0x80)
      out += static_cast<char>(code);
    at = end;
  }
  return out;
}

/// `name="value"` or `name='value'` of a start tag.
std::optional<std::string> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::size_t value = at + name.size();
    const auto space = [&](std::size_t i) {
      return i < tag.size() && std::string_view(" \t\r\n").find(tag[i]) != std::string_view::npos;
    };
    if (at == 0 || !space(at - 1)) continue;
    while (space(value)) ++value;
    if (value >= tag.size() || tag[value] != '=') continue;
    ++value;
    while (space(value)) ++value;
    if (value >= tag.size() || (tag[value] != '"' && tag[value] != '\'')) continue;
    const std::size_t end = tag.find(tag[value], value + 1);
    if (end == std::string_view::npos) return std::nullopt;
    return plain(tag.substr(value + 1, end - value - 1));
  }
  return std::nullopt;
}

/// Start tags of an element, with any prefix of a namespace.
std::vector<std::string_view> start_tags(std::string_view text, std::string_view element) {
  std::vector<std::string_view> tags;
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::size_t end = std::min(text.find('>', at), text.size());
    std::string_view tag = text.substr(at + 1, end - at - 1);
    const std::size_t name_end = std::min(tag.find_first_of(" \t\r\n/"), tag.size());
    if (const std::size_t colon = tag.substr(0, name_end).find(':'); colon != std::string_view::npos)
      tag.remove_prefix(colon + 1);
    if (tag.starts_with(element) && (tag.size() == element.size() ||
                                     std::string_view(" \t\r\n/").find(tag[element.size()]) != std::string_view::npos))
      tags.push_back(tag);
  }
  return tags;
}

TiffDescription ome(std::string_view text) {
  TiffDescription out;
  const auto pixels = start_tags(text, "Pixels");
  if (pixels.empty()) return out;
  const auto number = [&](std::string_view name, double otherwise) {
    const auto value = attribute(pixels.front(), name);
    return value ? to_number(*value, otherwise) : otherwise;
  };
  out.said_by = "OME";
  add_several(out, count_of(number("SizeC", 1.0)), "channels");
  add_several(out, count_of(number("SizeT", 1.0)), "time points");
  add_several(out, static_cast<std::int64_t>(pixels.size()), "images");
  out.slices = count_of(number("SizeZ", 1.0));
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = fmt::format("PhysicalSize{}", "XYZ"[axis]);
    const auto unit = mm_per_unit(attribute(pixels.front(), name + "Unit").value_or("um"));
    const double size = number(name, 0.0);
    if (unit && size > 0.0) out.voxel_mm[axis] = size * *unit;
  }
  return out;
}

/// {"shape": [2, 48, 64, 96], "axes": "TZYX", "spacing": 0.05, "unit": "mm"}
TiffDescription tifffile(const std::string& text) {
  TiffDescription out;
  const auto json = parse_json(text, "description");
  if (!json || !json->is_object() || !json->contains("shape") || !json->at("shape").is_array()) return out;
  std::vector<std::int64_t> shape;
  for (const auto& n : json->at("shape")) shape.push_back(n.is_number_integer() ? count_of(n.get<double>()) : 1);
  if (shape.size() < 3) return out;
  out.said_by = "tifffile";
  const auto member = [&](const char* name) {
    return json->contains(name) && json->at(name).is_string() ? json->at(name).get<std::string>() : std::string();
  };
  const std::string axes = member("axes");
  std::int64_t stacks = 0;
  for (std::size_t i = 0; i + 2 < shape.size(); ++i) {
    const char axis = axes.size() == shape.size() ? axes[i] : '?';
    if (shape[i] == 1) continue;
    out.images = std::min<std::int64_t>(out.images * shape[i], static_cast<std::int64_t>(kMostImages));
    if (axis == 'T')
      add_several(out, shape[i], "time points");
    else if (axis == 'C' || axis == 'S')
      add_several(out, shape[i], "channels");
    else if (++stacks == 2)
      add_several(out, shape[i], "stacks");
  }
  if (const std::string unit = member("unit"); !unit.empty()) out.unit_mm = mm_per_unit(unit);
  if (json->contains("spacing") && json->at("spacing").is_number()) out.spacing = json->at("spacing").get<double>();
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = fmt::format("PhysicalSize{}", "XYZ"[axis]);
    const std::string unit_text = member((name + "Unit").c_str());
    const auto unit = mm_per_unit(unit_text.empty() ? "um" : unit_text);
    if (unit && json->contains(name) && json->at(name).is_number())
      out.voxel_mm[axis] = json->at(name).get<double>() * *unit;
  }
  return out;
}

}  // namespace

TiffDescription parse_tiff_description(const std::string& text) {
  if (text.starts_with("ImageJ=")) return imagej(text);
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (begin == std::string::npos) return {};
  if (text[begin] == '<' && (text.find("OME") != std::string::npos)) return ome(text);
  if (text[begin] == '{') return tifffile(text.substr(begin));
  return {};
}

}  // namespace dubsar
