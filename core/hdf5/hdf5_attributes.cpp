// Attributes, and small datasets that serve as attributes.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>

#include "core/hdf5/hdf5_file.h"
#include "core/hdf5/library.h"

namespace dubsar {
using hdf5::Handle;
using hdf5::Library;
using hdf5::PluginsAllowed;

namespace {

constexpr hssize_t kMaxAttributeElements = 4096;
constexpr hssize_t kMaxSmallDataset = 65536;
constexpr std::size_t kMaxText = 1 << 16, kMaxTexts = 1 << 20;  // bytes of one text, and of all of an attribute

// Reads `count` strings of an attribute or dataset; `read` fills a buffer in the given memory type.
std::optional<std::vector<std::string>> read_strings(hid_t type, hid_t space,
                                                     const std::function<herr_t(hid_t, void*)>& read) {
  if (H5Tget_class(type) != H5T_STRING) return std::nullopt;
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  if (points < 1 || points > kMaxAttributeElements) return std::nullopt;
  const auto count = static_cast<std::size_t>(points);
  const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_cset(memory.get(), H5Tget_cset(type));
  std::vector<std::string> texts;
  if (H5Tis_variable_str(type) > 0) {
    const Handle length = hdf5::string_length_type();
    std::vector<std::uint32_t> lengths(count, 0);
    if (read(length.get(), lengths.data()) < 0 || *std::max_element(lengths.begin(), lengths.end()) > kMaxText ||
        std::accumulate(lengths.begin(), lengths.end(), std::uint64_t{0}) > kMaxTexts)
      return std::nullopt;
    H5Tset_size(memory.get(), H5T_VARIABLE);
    std::vector<char*> pointers(count, nullptr);
    const bool good = read(memory.get(), pointers.data()) >= 0;
    for (const char* text : pointers) texts.emplace_back(text != nullptr ? text : "");
    H5Dvlen_reclaim(memory.get(), space, H5P_DEFAULT, pointers.data());
    if (!good) return std::nullopt;
  } else {
    const std::size_t size = H5Tget_size(type);
    if (size == 0 || size > kMaxText || size * count > kMaxTexts) return std::nullopt;
    H5Tset_size(memory.get(), size);
    H5Tset_strpad(memory.get(), H5T_STR_NULLPAD);
    std::vector<char> buffer(size * count);
    if (read(memory.get(), buffer.data()) < 0) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) {
      std::string text(buffer.data() + i * size, size);
      if (const auto end = text.find('\0'); end != std::string::npos) text.resize(end);
      while (!text.empty() && text.back() == ' ') text.pop_back();
      texts.push_back(std::move(text));
    }
  }
  return texts;
}

Handle open_attribute(hid_t file, const std::string& object, const std::string& attribute) {
  const Handle access = hdf5::link_access();
  const Handle parent(H5Oopen(file, object.c_str(), access.get()), H5Oclose);
  if (!parent.ok() || H5Aexists(parent.get(), attribute.c_str()) <= 0) return {};
  return {H5Aopen(parent.get(), attribute.c_str(), H5P_DEFAULT), H5Aclose};
}

}  // namespace

std::optional<std::vector<double>> Hdf5File::numbers(const std::string& object, const std::string& attribute) const {
  const Library library;
  const Handle id = open_attribute(id_, object, attribute);
  if (!id.ok()) return std::nullopt;
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  const Handle space(H5Aget_space(id.get()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || count < 1 || count > kMaxAttributeElements) return std::nullopt;
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Aread(id.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) return std::nullopt;
  return values;
}

bool Hdf5File::is_float(const std::string& object, const std::string& attribute) const {
  const Library library;
  const Handle id = open_attribute(id_, object, attribute);
  if (!id.ok()) return false;
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  return H5Tget_class(type.get()) == H5T_FLOAT;
}

// REFERENCE_LIST of the scale: pairs of a reference to a dataset and the number of its axis (HDF5 dimension scales
// specification).
std::vector<Hdf5File::ScaledAxis> Hdf5File::scaled_axes(const std::string& scale) const {
  const Library library;
  const Handle id = open_attribute(id_, scale, "REFERENCE_LIST");
  if (!id.ok()) return {};
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  const Handle space(H5Aget_space(id.get()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (H5Tget_class(type.get()) != H5T_COMPOUND || H5Tget_nmembers(type.get()) != 2 || count < 1 ||
      count > kMaxAttributeElements)
    return {};
  struct Entry {
    hobj_ref_t object;
    int axis;
  };
  const Handle memory(H5Tcreate(H5T_COMPOUND, sizeof(Entry)), H5Tclose);
  for (unsigned int member = 0; member < 2; ++member) {
    const bool reference = H5Tget_member_class(type.get(), member) == H5T_REFERENCE;
    if (!reference && H5Tget_member_class(type.get(), member) != H5T_INTEGER) return {};
    const Handle kind(H5Tget_member_type(type.get(), member), H5Tclose);
    if (reference && H5Tequal(kind.get(), H5T_STD_REF_OBJ) <= 0) return {};
    char* const name = H5Tget_member_name(type.get(), member);
    if (name == nullptr) return {};
    H5Tinsert(memory.get(), name, reference ? offsetof(Entry, object) : offsetof(Entry, axis),
              reference ? H5T_STD_REF_OBJ : H5T_NATIVE_INT);
    H5free_memory(name);
  }
  std::vector<Entry> entries(static_cast<std::size_t>(count));
  if (H5Aread(id.get(), memory.get(), entries.data()) < 0) return {};
  std::vector<ScaledAxis> axes;
  for (const Entry& entry : entries) {
    const Handle object(H5Rdereference2(id_, H5P_DEFAULT, H5R_OBJECT, &entry.object), H5Oclose);
    H5O_info_t info;
    if (object.ok() && H5Oget_info2(object.get(), &info, H5O_INFO_BASIC) >= 0) axes.push_back({info.addr, entry.axis});
  }
  return axes;
}

std::optional<std::vector<std::string>> Hdf5File::strings(const std::string& object,
                                                          const std::string& attribute) const {
  const Library library;
  const Handle id = open_attribute(id_, object, attribute);
  if (!id.ok()) return std::nullopt;
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  const Handle space(H5Aget_space(id.get()), H5Sclose);
  return read_strings(type.get(), space.get(), [&](hid_t memory, void* out) { return H5Aread(id.get(), memory, out); });
}

std::optional<std::string> Hdf5File::string(const std::string& object, const std::string& attribute) const {
  auto texts = strings(object, attribute);
  if (!texts) return std::nullopt;
  return std::move(texts->front());
}

std::optional<std::vector<double>> Hdf5File::number_dataset(const std::string& path) const {
  const Library library;
  const auto target = resolve(path);
  if (!target || target->kind != Hdf5Target::Kind::kDataset) return std::nullopt;
  const auto opened = open_dataset(target->path);
  if (!opened || !opened->info().scalar || opened->info().layout == Hdf5Layout::kVirtual ||
      !opened->info().external.empty())
    return std::nullopt;
  std::uint64_t count = 1;
  for (const std::uint64_t n : opened->info().dims)
    if (n > static_cast<std::uint64_t>(kMaxSmallDataset) || (count *= n) > static_cast<std::uint64_t>(kMaxSmallDataset))
      return std::nullopt;
  const PluginsAllowed plugins(opened->needs_plugin_);
  std::vector<double> values(count);
  if (values.empty() || H5Dread(opened->id_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return std::nullopt;
  return values;
}

std::optional<std::string> Hdf5File::string_dataset(const std::string& path) const {
  const Library library;
  const auto target = resolve(path);
  if (!target || target->kind != Hdf5Target::Kind::kDataset) return std::nullopt;
  const auto opened = open_dataset(target->path);
  if (!opened || opened->info().type_text != "string" || opened->info().layout == Hdf5Layout::kVirtual ||
      !opened->info().external.empty())
    return std::nullopt;
  const Handle type(H5Dget_type(opened->id_), H5Tclose);
  const Handle space(H5Dget_space(opened->id_), H5Sclose);
  auto texts = read_strings(type.get(), space.get(), [&](hid_t memory, void* out) {
    return H5Dread(opened->id_, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
  });
  if (!texts) return std::nullopt;
  return std::move(texts->front());
}

}  // namespace dubsar
