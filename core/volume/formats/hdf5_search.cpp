#include "core/volume/formats/hdf5_search.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>

#include "core/base/text/lower_text.h"
#include "core/volume/formats/external_access.h"
#include "core/volume/formats/hdf5_imaris.h"
#include "core/volume/formats/hdf5_path.h"

namespace dubsar {
namespace {

using Kind = Hdf5Target::Kind;

std::string name_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }

std::uint64_t count_of(const Hdf5DatasetInfo& info) {
  double count = 1.0;  // the shape is not checked yet: saturate instead of wrapping
  for (const std::uint64_t n : info.dims) count *= static_cast<double>(n);
  return count < 1e18 ? static_cast<std::uint64_t>(count) : std::uint64_t{1000000000000000000};
}

bool is_volume(const Hdf5DatasetInfo& info) {
  const auto axes = volume_axes(info.dims);
  return info.scalar && axes &&
         std::all_of(axes->begin(), axes->end(), [&](std::size_t axis) { return info.dims[axis] >= 2; });
}

class Search {
 public:
  Search(std::shared_ptr<Hdf5File> file, const ImportOptions& options) : file_(std::move(file)), options_(options) {}

  Result<Hdf5Volume> run() {
    if (!options_.dataset.empty()) return named();
    struct Convention {
      const char* found_by;
      Result<std::vector<std::string>> (Search::*paths)();
    };
    static constexpr Convention kConventions[] = {
        {"NeXus default", &Search::nexus_default}, {"NeXus NXtomoproc", &Search::nexus_tomoproc},
        {"nabu reconstruction", &Search::nabu},    {"Data Exchange", &Search::data_exchange},
        {"VTKHDF ImageData", &Search::vtkhdf},     {"Imaris", &Search::imaris},
    };
    for (const Convention& convention : kConventions) {
      DUBSAR_ASSIGN(const std::vector<std::string> paths, (this->*convention.paths)());
      std::vector<Hdf5Volume> found;
      for (const std::string& path : paths) {
        auto volume = open(path);
        if (!volume) {
          note(volume.error());
        } else if (const auto reason = projections(*volume, false)) {
          note(*reason);
        } else if (is_volume(volume->info)) {
          found.push_back(std::move(*volume));
        }
      }
      if (!found.empty()) return choose(std::move(found), convention.found_by);
    }
    return largest("/", "largest array");
  }

 private:
  void note(Error error) {
    if (!first_refusal_) first_refusal_ = std::move(error);
  }

  // Follows a path, through external links into files of the allowed folder.
  Result<Hdf5Volume> open(const std::string& named) {
    std::shared_ptr<Hdf5File> file = file_;
    std::string path = named;
    for (int hops = 0; hops <= 4; ++hops) {
      DUBSAR_ASSIGN(const Hdf5Target target, file->resolve(path));
      if (target.kind == Kind::kExternal) {
        DUBSAR_ASSIGN(const std::filesystem::path next,
                      allowed_file(fmt::format("import_hdf5: \"{}\"", named), file->path(), target.external_file,
                                   options_.allow_external));
        DUBSAR_ASSIGN(Hdf5File opened, Hdf5File::open(next));
        file = std::make_shared<Hdf5File>(std::move(opened));
        path = target.external_path;
        continue;
      }
      if (target.kind != Kind::kDataset)
        return fail(ErrorKind::kBadData,
                    "import_hdf5: \"{}\" is {}, expected a dataset; dubsar info lists what {} holds", named,
                    target.kind == Kind::kMissing ? "not in the file" : "not a dataset", file_->path().string());
      DUBSAR_ASSIGN(Hdf5DatasetInfo info, file->inspect(target.path));
      if (info.layout == Hdf5Layout::kVirtual) DUBSAR_TRY(open_virtual(*file, info));
      return Hdf5Volume{file, std::move(info), file_, named, "", {}};
    }
    return fail(ErrorKind::kBadData, "import_hdf5: more than 4 external links on the way to \"{}\", expected fewer",
                named);
  }

  // A virtual dataset is opened when all its parts lie in the same file or are plain files of the allowed folder.
  Result<void> open_virtual(const Hdf5File& file, Hdf5DatasetInfo& info) {
    for (const std::string& name : info.virtual_files) {
      if (name == ".") continue;
      const std::string what = fmt::format("import_hdf5: virtual dataset \"{}\"", info.path);
      DUBSAR_ASSIGN(const std::filesystem::path part, allowed_file(what, file.path(), name, options_.allow_external));
      if (name.find('%') != std::string::npos)
        return fail(ErrorKind::kBadData,
                    "{} names its files by the pattern \"{}\", expected plain names; copy it with "
                    "h5repack",
                    what, name);
      DUBSAR_ASSIGN(const Hdf5File source, Hdf5File::open(part));
      DUBSAR_ASSIGN(const auto links, source.list());
      for (const Hdf5Link& link : links) {
        if (link.kind != Hdf5Link::Kind::kDataset) continue;
        DUBSAR_ASSIGN(const Hdf5DatasetInfo inner, source.inspect(link.path));
        if (!inner.virtual_files.empty() || !inner.external.empty())
          return fail(ErrorKind::kBadData,
                      "{} is made of \"{}\", which refers to further files, expected plain data; "
                      "copy it with h5repack",
                      what, name);
      }
    }
    DUBSAR_ASSIGN(info, file.inspect(info.path, true));
    return {};
  }

  Result<Hdf5Volume> named() {
    DUBSAR_ASSIGN(const Hdf5Target target, file_->resolve(options_.dataset));
    if (target.kind == Kind::kGroup) return largest(target.path, "largest array of the named group");
    auto volume = open(options_.dataset);
    if (!volume) {
      if (target.kind == Kind::kMissing) return missing();
      return volume;
    }
    if (auto reason = projections(*volume, true)) return tl::unexpected<Error>(std::move(*reason));
    volume->found_by = "named by the user";
    return volume;
  }

  tl::unexpected<Error> missing() {
    std::string names;
    if (const auto links = file_->list()) {
      int listed = 0;
      for (const Hdf5Link& link : *links)
        if (link.kind == Hdf5Link::Kind::kDataset && ++listed <= 8) names += (listed > 1 ? ", " : "") + link.path;
      if (listed > 8) names += fmt::format(" and {} more", listed - 8);
    }
    return fail(ErrorKind::kBadData, "import_hdf5: dataset \"{}\" is not in {}, expected one of: {}", options_.dataset,
                file_->path().string(), names.empty() ? "(no dataset)" : names);
  }

  // Tomography projections in place of a volume; `insisted`: the user named the dataset.
  std::optional<Error> projections(const Hdf5Volume& volume, bool insisted) const {
    const Hdf5File& file = *volume.file;
    const std::string& path = volume.info.path;
    const std::string group = hdf5_parent(path);
    const auto is_dataset = [&](const std::string& at) {
      const auto target = file.resolve(at);
      return target && target->kind == Kind::kDataset;
    };
    const auto refusal = [&](const std::string& why) {
      return Error{
          ErrorKind::kBadData,
          fmt::format("import_hdf5: \"{}\" holds projections ({}), expected a reconstructed volume; reconstruct "
                      "it first, e.g. with nabu or tomopy",
                      path, why)};
    };
    for (const char* key : {"image_key", "image_key_control"})
      if (is_dataset(hdf5_child(group, key)))
        return refusal(fmt::format("\"{}\" lies beside it", hdf5_child(group, key)));
    if (const auto definition = file.string_dataset("/" + path.substr(1, path.find('/', 1) - 1) + "/definition");
        definition == "NXtomo" && path.find("/reconstruction/") == std::string::npos)
      return refusal("the definition of its entry is NXtomo");
    if (name_of(group).rfind("exchange", 0) != 0 || !is_dataset(hdf5_child(group, "theta"))) return std::nullopt;
    const std::string said =
        lower_text(file.string(path, "axes").value_or("") + " " + file.string(path, "description").value_or(""));
    if (said.rfind("theta", 0) == 0) return refusal("its first axis is theta");
    if (said.rfind("z:", 0) == 0 || said.find("recon") != std::string::npos) return std::nullopt;
    const auto theta = file.inspect(hdf5_child(group, "theta"));
    const bool one_each =
        theta && !theta->dims.empty() && !volume.info.dims.empty() && theta->dims.front() == volume.info.dims.front();
    if (insisted && !one_each) return std::nullopt;
    return refusal(fmt::format("\"{}\" lies beside it", hdf5_child(group, "theta")));
  }

  Result<std::vector<std::string>> entries() {
    std::vector<std::string> groups;
    DUBSAR_ASSIGN(const auto links, file_->list());
    for (const Hdf5Link& link : links)
      if (link.kind == Hdf5Link::Kind::kGroup && link.path.rfind('/') == 0) groups.push_back(link.path);
    return groups;
  }

  // NXdata of a group, following @default; its signal.
  std::optional<std::string> signal_of(std::string group) {
    for (int hops = 0; hops < 8; ++hops) {
      const auto next = file_->string(group, "default");
      if (!next) break;
      group = hdf5_child(group, *next);
      const auto target = file_->resolve(group);
      if (!target || (target->kind != Kind::kGroup && target->kind != Kind::kDataset)) return group;
      if (target->kind == Kind::kDataset) return group;
    }
    if (const auto signal = file_->string(group, "signal")) return hdf5_child(group, *signal);
    if (file_->string(group, "NX_class") != "NXdata") return std::nullopt;
    if (const auto links = file_->list(group))
      for (const Hdf5Link& link : *links)
        if (hdf5_parent(link.path) == group && file_->numbers(link.path, "signal") == std::vector<double>{1.0})
          return link.path;
    return hdf5_child(group, "data");
  }

  Result<std::vector<std::string>> nexus_default() {
    std::vector<std::string> paths;
    if (file_->string("/", "default")) {
      if (auto path = signal_of("/")) paths.push_back(*path);
      return paths;
    }
    DUBSAR_ASSIGN(const auto groups, entries());
    for (const std::string& group : groups)
      if (file_->string(group, "NX_class") == "NXentry" && file_->string(group, "default"))
        if (auto path = signal_of(group)) paths.push_back(*path);
    return paths;
  }

  Result<std::vector<std::string>> nexus_tomoproc() {
    std::vector<std::string> paths;
    DUBSAR_ASSIGN(const auto groups, entries());
    for (const std::string& group : groups)
      if (file_->string_dataset(hdf5_child(group, "definition")) == "NXtomoproc")
        paths.push_back(hdf5_child(group, "data/data"));
    return paths;
  }

  Result<std::vector<std::string>> nabu() {
    std::vector<std::string> paths;
    DUBSAR_ASSIGN(const auto groups, entries());
    for (const std::string& group : groups) {
      const std::string path = hdf5_child(group, "reconstruction/results/data");
      const auto target = file_->resolve(path);
      if (target && (target->kind == Kind::kDataset || target->kind == Kind::kExternal)) paths.push_back(path);
    }
    return paths;
  }

  Result<std::vector<std::string>> data_exchange() {
    const auto target = file_->resolve("/exchange/data");
    if (!target || target->kind == Kind::kMissing) return std::vector<std::string>{};
    return std::vector<std::string>{"/exchange/data"};
  }

  Result<std::vector<std::string>> vtkhdf() {
    std::vector<std::string> paths;
    if (file_->string("/VTKHDF", "Type") != "ImageData") return paths;
    for (const char* group : {"/VTKHDF/PointData", "/VTKHDF/CellData"}) {
      if (const auto scalars = file_->string(group, "Scalars")) return std::vector{hdf5_child(group, *scalars)};
      if (const auto links = file_->list(group))
        for (const Hdf5Link& link : *links)
          if (link.kind == Hdf5Link::Kind::kDataset) paths.push_back(link.path);
    }
    return paths;
  }

  // All levels, channels and time points: the finest is taken, several of it are told.
  Result<std::vector<std::string>> imaris() {
    std::vector<std::string> paths;
    const auto target = file_->resolve(kImarisFinest);
    if (!target || target->kind != Kind::kGroup) return paths;
    DUBSAR_ASSIGN(const auto links, file_->list(hdf5_parent(target->path)));
    for (const Hdf5Link& link : links)
      if (link.kind == Hdf5Link::Kind::kDataset && name_of(link.path) == "Data") paths.push_back(link.path);
    return paths;
  }

  // Whether `path` is a coarser level of a volume of `all`: the same path with another number in one place, and larger.
  static bool coarser_level(const Hdf5Volume& volume, const std::vector<Hdf5Volume>& all) {
    const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    const std::string& path = volume.info.path;
    for (const Hdf5Volume& other : all) {
      const std::string& fine = other.info.path;
      const auto front = std::mismatch(path.begin(), path.end(), fine.begin(), fine.end());
      if (front.first == path.end() || !digit(*front.first) || front.second == fine.end() || !digit(*front.second))
        continue;
      const std::string_view a(path.data() + (front.first - path.begin()),
                               static_cast<std::size_t>(path.end() - front.first));
      const std::string_view b(fine.data() + (front.second - fine.begin()),
                               static_cast<std::size_t>(fine.end() - front.second));
      const auto rest_a = a.substr(static_cast<std::size_t>(std::find_if_not(a.begin(), a.end(), digit) - a.begin()));
      const auto rest_b = b.substr(static_cast<std::size_t>(std::find_if_not(b.begin(), b.end(), digit) - b.begin()));
      if (rest_a != rest_b || other.info.dims.size() != volume.info.dims.size()) continue;
      bool no_axis_larger = true;
      for (std::size_t axis = 0; axis < volume.info.dims.size(); ++axis)
        no_axis_larger = no_axis_larger && volume.info.dims[axis] <= other.info.dims[axis];
      if (no_axis_larger && volume.info.dims != other.info.dims) return true;
    }
    return false;
  }

  Result<Hdf5Volume> choose(std::vector<Hdf5Volume> found, const std::string& found_by) {
    std::vector<Hdf5Volume> levels;
    std::set<std::pair<const Hdf5File*, std::uint64_t>> seen;
    for (const Hdf5Volume& volume : found)
      if (!coarser_level(volume, found) && seen.insert({volume.file.get(), volume.info.address}).second)
        levels.push_back(volume);
    std::stable_sort(levels.begin(), levels.end(),
                     [](const Hdf5Volume& a, const Hdf5Volume& b) { return count_of(a.info) > count_of(b.info); });
    if (levels.size() > 1 && count_of(levels[1].info) >= count_of(levels[0].info) / 2) {
      std::vector<std::string> names;
      for (const Hdf5Volume& volume : levels)
        if (count_of(volume.info) >= count_of(levels[0].info) / 2 && names.size() < 8)
          names.push_back(fmt::format("{} ({})", volume.named, describe_array(volume.info)));
      return fail(ErrorKind::kBadData,
                  "import_hdf5: {} holds several volumes of similar size, expected one: name its dataset: {}",
                  file_->path().string(), fmt::join(names, ", "));
    }
    Hdf5Volume chosen = levels.front();
    chosen.found_by = found_by;
    for (const Hdf5Volume& volume : found)
      if (volume.info.path != chosen.info.path)
        chosen.others.push_back({volume.named, volume.info.dims, volume.info.type_text});
    return chosen;
  }

  Result<Hdf5Volume> largest(const std::string& group, const std::string& found_by) {
    DUBSAR_ASSIGN(const auto links, file_->list(group));
    std::vector<Hdf5Volume> found;
    std::optional<Hdf5DatasetInfo> biggest;
    for (const Hdf5Link& link : links) {
      const bool external = link.kind == Hdf5Link::Kind::kExternal;
      if (link.kind != Hdf5Link::Kind::kDataset && !external) continue;
      auto volume = open(link.path);
      if (!volume) {
        note(volume.error());
      } else if (!is_volume(volume->info)) {
        if (!biggest || count_of(volume->info) > count_of(*biggest)) biggest = volume->info;
      } else if (auto reason = projections(*volume, false)) {
        note(*reason);
      } else {
        found.push_back(std::move(*volume));
      }
    }
    if (!found.empty()) return choose(std::move(found), found_by);
    if (first_refusal_) return tl::unexpected<Error>(*first_refusal_);
    if (!biggest)
      return fail(ErrorKind::kBadData, "import_hdf5: {} holds no dataset, expected an array of rank 3",
                  file_->path().string());
    return fail(
        ErrorKind::kBadData,
        "import_hdf5: {} holds no volume: its largest dataset \"{}\" is {} of rank {}, expected numbers of rank 3",
        file_->path().string(), biggest->path, describe_array(*biggest), biggest->dims.size());
  }

  std::shared_ptr<Hdf5File> file_;
  const ImportOptions& options_;
  std::optional<Error> first_refusal_;
};

}  // namespace

std::optional<std::array<std::size_t, 3>> volume_axes(const std::vector<std::uint64_t>& dims) {
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < dims.size(); ++axis)
    if (dims.size() == 3 || dims[axis] != 1) axes.push_back(axis);
  if (axes.size() != 3 || dims.size() > kHdf5MaxRank) return std::nullopt;
  return std::array<std::size_t, 3>{axes[0], axes[1], axes[2]};
}

std::string describe_array(const Hdf5DatasetInfo& info) {
  return fmt::format("{} {}", info.dims.empty() ? "a single" : fmt::format("{}", fmt::join(info.dims, "x")),
                     info.type_text);
}

Result<Hdf5Volume> find_hdf5_volume(std::shared_ptr<Hdf5File> file, const ImportOptions& options) {
  return Search(std::move(file), options).run();
}

}  // namespace dubsar
