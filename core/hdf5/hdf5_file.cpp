#include "core/hdf5/hdf5_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <functional>
#include <set>
#include <utility>

#include "core/hdf5/dataset_info.h"
#include "core/hdf5/hdf5_filters.h"
#include "core/hdf5/library.h"

namespace dubsar {
using hdf5::child_path;
using hdf5::dataset_access;
using hdf5::Handle;
using hdf5::Library;
using hdf5::link_access;
using hdf5::open_with_info;
using hdf5::OpenDataset;
using hdf5::path_parts;
using hdf5::reason;

namespace {

constexpr std::size_t kMaxLinks = 200000;
constexpr int kMaxLevels = 64;
constexpr std::size_t kMaxLinkValue = 1 << 16;

// Soft and external link values.
void read_link_value(hid_t file, const std::string& path, const H5L_info_t& info, std::string& target_file,
                     std::string& target_path) {
  if (info.u.val_size == 0 || info.u.val_size > kMaxLinkValue) return;
  std::vector<char> value(info.u.val_size + 1, '\0');
  const Handle access = link_access();
  if (H5Lget_val(file, path.c_str(), value.data(), info.u.val_size, access.get()) < 0) return;
  if (info.type == H5L_TYPE_SOFT) {
    target_path = value.data();
  } else {
    unsigned int flags = 0;
    const char* external_file = nullptr;
    const char* external_path = nullptr;
    if (H5Lunpack_elink_val(value.data(), info.u.val_size, &flags, &external_file, &external_path) < 0) return;
    target_file = external_file;
    target_path = external_path;
  }
}

/// Whether another program holds the lock that the library takes for writing.
bool is_locked(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);  // and with it our own lock
  return locked;
}

}  // namespace

bool Hdf5File::has_signature(const std::filesystem::path& path) {
  const auto file = InputFile::open(path);
  return file && has_signature(*file);
}

bool Hdf5File::has_signature(const InputFile& file) {
  static constexpr std::array<unsigned char, 8> kSignature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  for (std::int64_t offset = 0; offset + 8 <= file.size(); offset = offset == 0 ? 512 : offset * 2) {
    std::array<unsigned char, 8> bytes{};
    if (!file.read_at(offset, std::as_writable_bytes(std::span(bytes)))) return false;
    if (bytes == kSignature) return true;
  }
  return false;
}

Result<Hdf5File> Hdf5File::open(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const InputFile probe, InputFile::open(path));
  if (!has_signature(probe))
    return fail(ErrorKind::kBadData, "{} is not an HDF5 file, its signature is missing", path.string());
  const Library library;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.get(), true, true);  // read-only media and network shares have no locks
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  H5Pset_elink_file_cache_size(access.get(), 0);
  Handle id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!id.ok() && is_locked(path))
    return fail(ErrorKind::kTryAgain,
                "{} is locked: another program has it open for writing; wait until it is finished, or close it there",
                path.string());
  if (const std::string why = reason(); !id.ok() && why.find("already open for") != std::string::npos)
    return fail(
        ErrorKind::kTryAgain,
        "{} is marked as open for writing: wait until its writer is finished; if that has crashed, h5clear -s {} "
        "takes the mark away",
        path.string(), path.string());
  if (!id.ok())
    return fail(ErrorKind::kBadData, "{} ({} bytes) is damaged, truncated or still being written ({}); copy it again",
                path.string(), probe.size(), reason());
  Hdf5File file;
  file.path_ = path;
  file.id_ = id.release();
  return file;
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept : id_(std::exchange(other.id_, -1)), path_(std::move(other.path_)) {}

Hdf5File::~Hdf5File() {
  if (id_ < 0) return;
  const Library library;
  H5Fclose(id_);
}

Result<std::vector<Hdf5Link>> Hdf5File::list(const std::string& group) const {
  const Library library;
  const Handle access = link_access();
  std::vector<Hdf5Link> links;
  std::set<haddr_t> entered;
  const auto too_much = [&] {
    return fail(ErrorKind::kBadData,
                "{} has more than {} links or {} levels of groups, expected fewer; "
                "name the volume",
                path_.string(), kMaxLinks, kMaxLevels);
  };
  const std::function<Result<void>(const std::string&, int)> walk = [&](const std::string& at,
                                                                        int level) -> Result<void> {
    const Handle id(H5Gopen2(id_, at.c_str(), access.get()), H5Gclose);
    H5O_info_t self;
    if (!id.ok() || H5Oget_info2(id.get(), &self, H5O_INFO_BASIC) < 0)
      return fail(ErrorKind::kBadData, "group \"{}\" cannot be opened ({}); the file is damaged", at, reason());
    if (!entered.insert(self.addr).second) return {};
    std::vector<std::string> names;
    const herr_t status = H5Literate(
        id.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
        [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
          auto& found = *static_cast<std::vector<std::string>*>(out);
          try {
            found.emplace_back(name);
          } catch (const std::exception&) {  // no exception may cross the library's frames
            return -1;
          }
          return found.size() > kMaxLinks ? 1 : 0;
        },
        &names);
    if (status < 0)
      return fail(ErrorKind::kBadData, "group \"{}\" cannot be listed ({}); the file is damaged", at, reason());
    if (status > 0 || level > kMaxLevels) return too_much();
    for (const std::string& name : names) {
      if (links.size() >= kMaxLinks) return too_much();
      Hdf5Link link;
      link.path = child_path(at, name);
      H5L_info_t info;
      if (H5Lget_info(id.get(), name.c_str(), &info, access.get()) < 0) continue;
      if (info.type == H5L_TYPE_HARD) {
        H5O_info_t object;
        if (H5Oget_info_by_name2(id.get(), name.c_str(), &object, H5O_INFO_BASIC, access.get()) >= 0) {
          if (object.type == H5O_TYPE_GROUP) link.kind = Hdf5Link::Kind::kGroup;
          if (object.type == H5O_TYPE_DATASET) link.kind = Hdf5Link::Kind::kDataset;
        }
      } else if (info.type == H5L_TYPE_SOFT || info.type == H5L_TYPE_EXTERNAL) {
        link.kind = info.type == H5L_TYPE_SOFT ? Hdf5Link::Kind::kSoft : Hdf5Link::Kind::kExternal;
        read_link_value(id_, link.path, info, link.target_file, link.target_path);
      }
      const bool descend = link.kind == Hdf5Link::Kind::kGroup;
      links.push_back(link);
      if (descend) DUBSAR_TRY(walk(link.path, level + 1));
    }
    return {};
  };
  DUBSAR_TRY(walk(group, 0));
  return links;
}

Result<Hdf5Target> Hdf5File::resolve(const std::string& path) const {
  const Library library;
  const Handle access = link_access();
  Hdf5Target target;
  target.kind = Hdf5Target::Kind::kGroup;
  std::string at = "/";
  std::vector<std::string> parts = path_parts(path);
  for (int links_followed = 0; !parts.empty();) {
    const std::string next = child_path(at, parts.front());
    parts.erase(parts.begin());
    H5L_info_t info;
    if (target.kind != Hdf5Target::Kind::kGroup || H5Lexists(id_, next.c_str(), access.get()) <= 0 ||
        H5Lget_info(id_, next.c_str(), &info, access.get()) < 0) {
      target.kind = Hdf5Target::Kind::kMissing;
      target.path = next;
      return target;
    }
    if (info.type == H5L_TYPE_HARD) {
      H5O_info_t object;
      if (H5Oget_info_by_name2(id_, next.c_str(), &object, H5O_INFO_BASIC, access.get()) < 0)
        return fail(ErrorKind::kBadData, "\"{}\" cannot be opened ({}); the file is damaged", next, reason());
      target.kind = object.type == H5O_TYPE_GROUP     ? Hdf5Target::Kind::kGroup
                    : object.type == H5O_TYPE_DATASET ? Hdf5Target::Kind::kDataset
                                                      : Hdf5Target::Kind::kOther;
      at = next;
    } else if (info.type == H5L_TYPE_SOFT) {
      std::string unused, to;
      read_link_value(id_, next, info, unused, to);
      if (++links_followed > 16)
        return fail(ErrorKind::kBadData, "more than 16 soft links on the way to \"{}\", expected fewer", path);
      std::vector<std::string> front = path_parts(to);
      parts.insert(parts.begin(), front.begin(), front.end());
      if (!to.empty() && to.front() == '/') at.assign(1, '/');
    } else if (info.type == H5L_TYPE_EXTERNAL) {
      target.kind = Hdf5Target::Kind::kExternal;
      target.path = next;
      read_link_value(id_, next, info, target.external_file, target.external_path);
      for (const std::string& part : parts) target.external_path = child_path(target.external_path, part);
      return target;
    } else {
      target.kind = Hdf5Target::Kind::kOther;
      at = next;
    }
  }
  target.path = at;
  return target;
}

Result<Hdf5DatasetInfo> Hdf5File::inspect(const std::string& path, bool open_sources) const {
  const Library library;
  const Handle access = dataset_access();
  DUBSAR_ASSIGN(OpenDataset opened, open_with_info(id_, path, access.get(), open_sources));
  return std::move(opened.info);
}

Result<Hdf5Dataset> Hdf5File::open_dataset(const std::string& path, bool open_sources) const {
  const Library library;
  const Handle access = dataset_access();
  DUBSAR_ASSIGN(OpenDataset opened, open_with_info(id_, path, access.get(), open_sources));
  Hdf5Dataset dataset;
  dataset.info_ = std::move(opened.info);
  dataset.needs_plugin_ = std::any_of(dataset.info_.filters.begin(), dataset.info_.filters.end(),
                                      [](const Hdf5Filter& filter) { return hdf5_plugin_allowed(filter.id); });
  dataset.id_ = opened.id.release();
  return dataset;
}

}  // namespace dubsar
