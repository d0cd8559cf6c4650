#include "core/volume/formats/hdf5_voxel_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/numbers/units.h"
#include "core/volume/formats/hdf5_imaris.h"
#include "core/volume/formats/hdf5_path.h"
#include "core/volume/formats/hdf5_scales.h"

namespace dubsar {
namespace {

std::vector<std::string> split_axes(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':' || c == ',' || c == ' ')
      parts.emplace_back();
    else if (c != '[' && c != ']' && c != '"')
      parts.back() += c;
  }
  parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
  return parts;
}

// "mm", and the spelling "[u_m]" of EMD files.
std::optional<double> length_unit(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '[' || c == ']' || c == '_'; }),
             text.end());
  return mm_per_unit(text);
}

bool positive(const glm::dvec3& v) { return v.x > 0.0 && v.y > 0.0 && v.z > 0.0 && std::isfinite(v.x + v.y + v.z); }

class Finder {
 public:
  Finder(const Hdf5Volume& volume, std::vector<std::string>& warnings) : volume_(volume), warnings_(warnings) {}

  StatedVoxelSize find() {
    VoxelSize size;
    // What the file that was asked for says about the volume comes before what a linked file says.
    const auto search = [&](const Hdf5File& file, const std::string& path) {
      return from_axes(file, path, size) || from_names(file, path, size) || from_vtk(file, path, size);
    };
    if (volume_.named_file != volume_.file && search(*volume_.named_file, volume_.named)) return {size, by_name_};
    if (search(*volume_.file, volume_.info.path)) return {size, by_name_};
    if (from_scales(size)) return {size, by_name_};
    if (const auto imaris = imaris_voxel_size(volume_)) return {*imaris, true};
    return {};
  }

 private:
  // Spacing of an axis in mm; nullopt without positions, unit or even steps.
  std::optional<double> axis_spacing(const Hdf5File& file, const std::string& path, std::uint64_t length) {
    const auto positions = file.number_dataset(path);
    if (!positions || positions->size() != length || length < 2) return std::nullopt;
    const auto text = file.string(path, "units");
    const auto unit = text ? length_unit(*text) : std::nullopt;
    if (!unit) {
      if (!text || text->find("pixel") == std::string::npos)
        warnings_.push_back(fmt::format("the axis \"{}\" has no unit of length and is not used as voxel size", path));
      return std::nullopt;
    }
    const double step = (positions->back() - positions->front()) / static_cast<double>(length - 1);
    for (std::size_t i = 0; i + 1 < positions->size(); ++i)
      if (!(std::abs((*positions)[i + 1] - (*positions)[i] - step) <= 0.01 * std::abs(step))) {
        warnings_.push_back(fmt::format("the axis \"{}\" has uneven steps and is not used as voxel size", path));
        return std::nullopt;
      }
    return std::abs(step) * *unit;
  }

  bool from_axes(const Hdf5File& file, const std::string& path, VoxelSize& size) {
    const auto axes = volume_axes(volume_.info.dims);
    const std::string group = hdf5_parent(path);
    auto names = file.strings(group, "axes");
    if (!names) names = file.strings(path, "axes");
    if (names && names->size() == 1) names = split_axes(names->front());
    const std::size_t rank = volume_.info.dims.size();
    if (!names && file.numbers(group, "emd_group_type")) {
      names.emplace();
      for (std::size_t axis = 0; axis < rank; ++axis) names->push_back(fmt::format("dim{}", axis + 1));
    }
    if (!axes || !names || names->size() != rank) return false;
    glm::dvec3 mm(0.0);
    for (int i = 0; i < 3; ++i) {
      const std::size_t axis = (*axes)[static_cast<std::size_t>(i)];
      const auto spacing = axis_spacing(file, hdf5_child(group, (*names)[axis]), volume_.info.dims[axis]);
      if (!spacing) return false;
      mm[2 - i] = *spacing;
    }
    if (!positive(mm)) return false;
    size = {mm,
            fmt::format("{} axes {}, {}, {}", group, (*names)[(*axes)[0]], (*names)[(*axes)[1]], (*names)[(*axes)[2]])};
    return true;
  }

  bool from_scales(VoxelSize& size) {
    const auto scales = hdf5_scales(*volume_.file, volume_.info);
    const auto axes = volume_axes(volume_.info.dims);
    if (!scales || !axes) return false;
    glm::dvec3 mm(0.0);
    for (int i = 0; i < 3; ++i) {
      const std::string& scale = (*scales)[static_cast<std::size_t>(i)];
      const auto spacing =
          scale.empty() ? std::nullopt
                        : axis_spacing(*volume_.file, scale, volume_.info.dims[(*axes)[static_cast<std::size_t>(i)]]);
      if (!spacing) return false;
      mm[2 - i] = *spacing;
    }
    if (!positive(mm)) return false;
    size = {mm, fmt::format("dimension scales {}, {}, {}", (*scales)[0], (*scales)[1], (*scales)[2])};
    return true;
  }

  // One or three numbers; three are those of the stored axes, slowest first, unless the convention behind the name has
  // the fastest first.
  static std::optional<glm::dvec3> in_order(const std::vector<double>& values, bool x_first) {
    if (values.size() == 1) return glm::dvec3(values[0]);
    if (values.size() != 3) return std::nullopt;
    return x_first ? glm::dvec3(values[0], values[1], values[2]) : glm::dvec3(values[2], values[1], values[0]);
  }

  struct Name {
    const char* name;
    double mm;     ///< unit in the name; 0: stated apart
    bool x_first;  ///< order of three values
  };
  static constexpr std::array<Name, 15> kNames{{
      {"element_size_um", 1e-3, false},
      {"element_size_mm", 1.0, false},
      {"pixelResolution", 0.0, true},
      {"voxel_size", 0.0, false},
      {"voxelsize", 0.0, false},
      {"voxel_size_mm", 1.0, false},
      {"voxel_size_um", 1e-3, false},
      {"voxel_size_m", 1e3, false},
      {"voxel_size_cm", 10.0, false},
      {"pixel_size", 0.0, false},
      {"pixel_size_mm", 1.0, false},
      {"pixel_size_um", 1e-3, false},
      {"pixel_size_m", 1e3, false},
      {"pixel_size_cm", 10.0, false},
      {"pixelsize", 0.0, false},
  }};

  bool accept(const std::vector<double>& values, const Name& name, std::optional<std::string> unit_text,
              const std::string& where, VoxelSize& size) {
    const auto unit = name.mm > 0.0 ? std::optional<double>(name.mm)
                      : unit_text   ? length_unit(*unit_text)
                                    : std::nullopt;
    const auto mm = in_order(values, name.x_first);
    if (!unit || !mm || !positive(*mm)) {
      warnings_.push_back(fmt::format("\"{}\" is not used as voxel size: it has {}", where,
                                      !unit ? "no unit of length" : "not one or three positive numbers"));
      return false;
    }
    size = {*mm * *unit, where};
    return true;
  }

  // Attributes of the volume and of the groups above it, and datasets beside these.
  bool from_names(const Hdf5File& file, const std::string& path, VoxelSize& size) {
    for (std::string at = path;; at = hdf5_parent(at)) {
      for (const Name& name : kNames) {
        if (const auto values = file.numbers(at, name.name)) {
          std::optional<std::string> unit;
          for (const std::string& key : {std::string(name.name) + "_units", std::string(name.name) + "_unit",
                                         std::string("units"), std::string("unit")})
            if (!unit || !length_unit(*unit)) {
              if (auto text = file.string(at, key)) unit = text;
            }
          if (accept(*values, name, unit, fmt::format("{}@{}", at, name.name), size)) return true;
        }
        if (at == path) continue;
        const std::string sibling = hdf5_child(at, name.name);
        if (const auto values = file.number_dataset(sibling)) {
          auto unit = file.string(sibling, "units");
          if (!unit) unit = file.string(sibling, "unit");
          if (accept(*values, name, unit, sibling, size)) return true;
        }
      }
      if (at != path && from_xyz(file, at, size)) return true;
      if (at == "/") return false;
    }
  }

  // x_pixel_size, y_pixel_size (NeXus) and x_voxel_size ... beside the volume.
  bool from_xyz(const Hdf5File& file, const std::string& group, VoxelSize& size) {
    for (const char* kind : {"voxel_size", "pixel_size"}) {
      glm::dvec3 mm(0.0);
      for (int axis = 0; axis < 3; ++axis) {
        const std::string path = hdf5_child(group, fmt::format("{}_{}", "xyz"[axis], kind));
        const auto values = file.number_dataset(path);
        const auto unit = file.string(path, "units");
        if (values && values->size() == 1 && unit && length_unit(*unit))
          mm[axis] = values->front() * *length_unit(*unit);
      }
      if (!positive(mm)) continue;
      size = {mm, fmt::format("{} x_{}, y_{}, z_{}", group, kind, kind, kind)};
      by_name_ = true;
      return true;
    }
    return false;
  }

  bool from_vtk(const Hdf5File& file, const std::string& path, VoxelSize& size) {
    if (path.rfind("/VTKHDF/", 0) != 0) return false;
    const auto values = file.numbers("/VTKHDF", "Spacing");
    const auto mm = values ? in_order(*values, true) : std::nullopt;
    if (!mm || !positive(*mm)) return false;
    warnings_.push_back("/VTKHDF@Spacing has no unit, millimetres are taken; a given voxel size overrides it");
    size = {*mm, "/VTKHDF@Spacing (unit taken as mm)"};
    return true;
  }

  const Hdf5Volume& volume_;
  std::vector<std::string>& warnings_;
  bool by_name_ = false;
};

}  // namespace

StatedVoxelSize hdf5_voxel_size(const Hdf5Volume& volume, std::vector<std::string>& warnings) {
  return Finder(volume, warnings).find();
}

}  // namespace dubsar
