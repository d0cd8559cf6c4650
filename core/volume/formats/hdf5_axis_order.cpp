#include "core/volume/formats/hdf5_axis_order.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"
#include "core/volume/formats/hdf5_imaris.h"
#include "core/volume/formats/hdf5_path.h"
#include "core/volume/formats/hdf5_scales.h"

namespace dubsar {
namespace {

constexpr const char* kOrderNames[] = {"axis_order",      "axes_order", "axisOrder",   "axesOrder",
                                       "dimension_order", "dim_order",  "axis_labels", "dimension_labels"};

bool all_empty(const std::vector<std::string>& labels) {
  return std::all_of(labels.begin(), labels.end(), [](const std::string& label) { return label.empty(); });
}

/// Statements in the order in which they count; the first is taken, others are compared with it.
class Reader {
 public:
  Reader(const Hdf5Volume& volume, std::vector<std::string>& warnings) : volume_(volume), warnings_(warnings) {
    if (const auto axes = volume_axes(volume.info.dims)) used_.assign(axes->begin(), axes->end());
  }

  AxisOrder find() {
    // What the file that was asked for says about the volume comes before what a linked file says.
    if (volume_.named_file != volume_.file) search(*volume_.named_file, volume_.named);
    search(*volume_.file, volume_.info.path);
    return found_.value_or(AxisOrder{});
  }

 private:
  void search(const Hdf5File& file, const std::string& path) {
    by_order_names(file, path);
    if (auto labels = file.strings(path, "DIMENSION_LABELS"); labels && !all_empty(*labels))
      offer(*labels, path + "@DIMENSION_LABELS", true);
    by_axistags(file, path);
    by_openpmd(file, path);
    by_axes(file, path);
    by_emd(file, path);
    by_vtk(file, path);
    if (&file == volume_.file.get()) by_scales(file);
    if (auto order = imaris_axis_order(volume_); order && &file == volume_.file.get()) offer(*std::move(order));
    for (std::string at = path; at != "/";) {
      at = hdf5_parent(at);
      by_order_names(file, at);
    }
    if (!found_ && file.string(path, "MATLAB_class"))
      warnings_.push_back(
          fmt::format("\"{}\" was written by MATLAB, whose arrays may have y or x first: whether the volume is a "
                      "mirror image cannot "
                      "be told; a given axis order states it",
                      path));
  }

  /// `labels`: slowest first. `insists`: the statement can only be about the order of axes.
  void offer(const std::vector<std::string>& labels, const std::string& where, bool insists) {
    auto order = parse_axis_labels(labels, used_);
    if (!order) {
      if (insists)
        warnings_.push_back(
            fmt::format("\"{}\" says \"{}\", expected x, y and z once each; it is not used as order of axes", where,
                        fmt::join(labels, ", ")));
      return;
    }
    order->provenance = where;
    offer(*std::move(order));
  }

  void offer(AxisOrder order) {
    if (!found_) {
      found_ = std::move(order);
    } else if (found_->letters() != order.letters()) {
      warnings_.push_back(
          fmt::format("\"{}\" says that the axes are stored {}, slowest first, but \"{}\" says {}: the "
                      "first is taken",
                      found_->provenance, found_->letters(), order.provenance, order.letters()));
    }
  }

  void by_order_names(const Hdf5File& file, const std::string& object) {
    for (const char* name : kOrderNames)
      if (const auto labels = file.strings(object, name)) offer(*labels, fmt::format("{}@{}", object, name), true);
  }

  void by_axistags(const Hdf5File& file, const std::string& path) {
    const auto text = file.string(path, "axistags");
    if (!text) return;
    const auto tags = parse_json(*text, "axistags");
    if (!tags || !tags->is_object() || !tags->contains("axes") || !(*tags)["axes"].is_array()) return;
    std::vector<std::string> labels;
    for (const nlohmann::json& axis : (*tags)["axes"])
      labels.push_back(axis.is_object() && axis.contains("key") && axis["key"].is_string() ? axis["key"] : "");
    offer(labels, path + "@axistags", false);
  }

  void by_openpmd(const Hdf5File& file, const std::string& path) {
    for (const std::string& object : {path, hdf5_parent(path)}) {
      auto labels = file.strings(object, "axisLabels");
      if (!labels) continue;
      if (file.string(object, "dataOrder") == "F") std::reverse(labels->begin(), labels->end());
      offer(*labels, object + "@axisLabels", false);
    }
  }

  void by_axes(const Hdf5File& file, const std::string& path) {
    for (const std::string& object : {path, hdf5_parent(path)}) {
      auto labels = file.strings(object, "axes");
      if (!labels) continue;
      // N5 counts axes from the fastest one
      if (file.string("/", "n5")) std::reverse(labels->begin(), labels->end());
      offer(*labels, object + "@axes", false);
    }
  }

  void by_emd(const Hdf5File& file, const std::string& path) {
    const std::string group = hdf5_parent(path);
    if (!file.numbers(group, "emd_group_type")) return;
    std::vector<std::string> labels;
    for (std::size_t axis = 0; axis < volume_.info.dims.size(); ++axis)
      labels.push_back(file.string(hdf5_child(group, fmt::format("dim{}", axis + 1)), "name").value_or(""));
    offer(labels, group + "/dim1@name ...", false);
  }

  /// Names of the coordinates of the axes, "-" before those that fall.
  void by_scales(const Hdf5File& file) {
    const auto scales = hdf5_scales(file, volume_.info);
    if (!scales) return;
    std::vector<std::string> labels(volume_.info.dims.size());
    for (std::size_t i = 0; i < 3 && used_.size() == 3; ++i) {
      const std::string& scale = (*scales)[i];
      const auto values = scale.empty() ? std::nullopt : file.number_dataset(scale);
      const bool falls = values && values->size() > 1 && values->back() < values->front();
      labels[used_[i]] = fmt::format("{}{}", falls ? "-" : "", scale.substr(scale.rfind('/') + 1));
    }
    offer(labels, "dimension scales", false);
  }

  void by_vtk(const Hdf5File& file, const std::string& path) {
    if (!path.starts_with("/VTKHDF/")) return;
    const auto rows = file.numbers("/VTKHDF", "Direction");
    AxisOrder order;
    order.provenance = "VTKHDF";
    if (rows && rows->size() == 9) {
      // point = Origin + Direction * (Spacing * index): the columns are the directions of i, j, k
      std::array<glm::dvec3, 3> columns{};
      for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
          columns[static_cast<std::size_t>(column)][row] = (*rows)[static_cast<std::size_t>(3 * row + column)];
      const auto turned = axis_order_of(columns, false);
      if (!turned) {
        warnings_.emplace_back("\"/VTKHDF@Direction\" spans no volume and is not used as order of axes");
        return;
      }
      order = *turned;
      order.provenance = "/VTKHDF@Direction";
    }
    offer(std::move(order));
  }

  const Hdf5Volume& volume_;
  std::vector<std::string>& warnings_;
  std::vector<std::size_t> used_;
  std::optional<AxisOrder> found_;
};

}  // namespace

AxisOrder hdf5_axis_order(const Hdf5Volume& volume, std::vector<std::string>& warnings) {
  return Reader(volume, warnings).find();
}

}  // namespace dubsar
