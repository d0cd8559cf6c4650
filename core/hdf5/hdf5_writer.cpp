#include "core/hdf5/hdf5_writer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/system/parallel.h"
#include "core/hdf5/chunk_encoder.h"
#include "core/hdf5/library.h"

namespace dubsar {
using hdf5::file_type;
using hdf5::Handle;
using hdf5::Library;
using hdf5::reason;
using hdf5::select;

namespace {

tl::unexpected<Error> abandoned() {
  return fail(ErrorKind::kIo, "cannot write the HDF5 file: an earlier part of it could not be written");
}

Handle variable_string() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

Handle make_parents() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list.get(), 1);
  return list;
}

Handle without_times(hid_t property_class) {
  Handle list(H5Pcreate(property_class), H5Pclose);
  H5Pset_obj_track_times(list.get(), false);
  return list;
}

/// Entries of the slowest axis that are whole layers of chunks which we can compress ourselves.
bool are_layers(const Hdf5Storage& storage, ScalarType type, std::uint64_t first, std::uint64_t count) {
  if (storage.deflate == 0 || storage.dims.size() != 3 || storage.type != type || storage.order != kNativeOrder)
    return false;
  return first % storage.chunk[0] == 0 && (count % storage.chunk[0] == 0 || first + count == storage.dims[0]);
}

/// The numbers of a chunk out of a slab of `size` entries; 0 where the chunk reaches beyond it.
void cut_out(std::span<const std::byte> slab, const std::array<std::uint64_t, 3>& size,
             const std::array<std::uint64_t, 3>& origin, std::span<const std::uint64_t> chunk, std::uint64_t element,
             std::span<std::byte> out) {
  const auto reach = [&](std::size_t axis) { return std::min(chunk[axis], size[axis] - origin[axis]); };
  if (reach(0) < chunk[0] || reach(1) < chunk[1] || reach(2) < chunk[2])
    std::fill(out.begin(), out.end(), std::byte{0});
  for (std::uint64_t z = 0; z < reach(0); ++z)
    for (std::uint64_t y = 0; y < reach(1); ++y) {
      const std::uint64_t from = ((origin[0] + z) * size[1] + origin[1] + y) * size[2] + origin[2];
      std::copy_n(slab.data() + from * element, reach(2) * element,
                  out.data() + (z * chunk[1] + y) * chunk[2] * element);
    }
}

}  // namespace

Result<Hdf5Writer> Hdf5Writer::create(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path));
  Hdf5Writer writer(std::move(file));
  const Library library;
  writer.id_ = H5Fcreate(writer.file_.temporary_path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (writer.id_ < 0) return writer.give_up(path.string());
  return writer;
}

Hdf5Writer::Hdf5Writer(Hdf5Writer&& other) noexcept
    : file_(std::move(other.file_)), id_(std::exchange(other.id_, -1)), datasets_(std::move(other.datasets_)) {
  other.datasets_.clear();
}

Hdf5Writer::~Hdf5Writer() {
  if (id_ < 0) return;
  const Library library;
  flush_and_close();
}

// The library flushes again what it could not flush when a file that cannot be written is closed, trips over its own
// objects and ends the process: such a file stays open.
void Hdf5Writer::abandon() noexcept {
  datasets_.clear();
  id_ = -1;
}

bool Hdf5Writer::flush_and_close() noexcept {
  bool good = H5Fflush(id_, H5F_SCOPE_LOCAL) >= 0;
  for (const auto& [path, dataset] : datasets_) good = good && H5Dclose(dataset.id) >= 0;
  good = good && H5Fclose(id_) >= 0;
  abandon();
  return good;
}

tl::unexpected<Error> Hdf5Writer::give_up(const std::string& what) {
  const std::string why = reason();
  abandon();
  return fail(ErrorKind::kIo, "cannot write {} ({}); is the disk full?", what, why);
}

Result<void> Hdf5Writer::create_dataset(const std::string& path, const Hdf5Storage& storage) {
  DUBSAR_CHECK(!storage.dims.empty() && !datasets_.contains(path));
  DUBSAR_CHECK(storage.chunk.empty() ? storage.deflate == 0 && !storage.shuffle
                                     : storage.chunk.size() == storage.dims.size());
  if (id_ < 0) return abandoned();
  const Library library;
  const std::vector<hsize_t> dims(storage.dims.begin(), storage.dims.end());
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Handle creation = without_times(H5P_DATASET_CREATE);
  if (!storage.chunk.empty()) {
    const std::vector<hsize_t> chunk(storage.chunk.begin(), storage.chunk.end());
    H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data());
    if (storage.shuffle) H5Pset_shuffle(creation.get());
    if (storage.deflate > 0) H5Pset_deflate(creation.get(), static_cast<unsigned int>(storage.deflate));
  }
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);  // every number is written by the caller
  const Handle parents = make_parents();
  const hid_t id = H5Dcreate2(id_, path.c_str(), file_type(storage.type, storage.order), space.get(), parents.get(),
                              creation.get(), H5P_DEFAULT);
  if (id < 0) return give_up(fmt::format("dataset \"{}\"", path));
  datasets_[path] = {id, storage};
  return {};
}

Result<void> Hdf5Writer::write_slab_bytes(const std::string& path, std::uint64_t first, ScalarType type,
                                          std::span<const std::byte> bytes) {
  if (id_ < 0) return abandoned();
  const auto found = datasets_.find(path);
  DUBSAR_CHECK(found != datasets_.end());
  const hid_t id = found->second.id;
  const Library library;
  const Handle space(H5Dget_space(id), H5Sclose);
  std::vector<hsize_t> count(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), count.data(), nullptr);
  std::uint64_t entry = static_cast<std::uint64_t>(scalar_bytes(type));
  for (std::size_t axis = 1; axis < count.size(); ++axis) entry *= count[axis];
  DUBSAR_CHECK(bytes.size() % entry == 0 && first + bytes.size() / entry <= count[0]);
  count[0] = bytes.size() / entry;
  if (count[0] == 0) return {};
  if (are_layers(found->second.storage, type, first, count[0])) return write_layers(found->second, path, first, bytes);
  std::vector<std::uint64_t> start(count.size(), 0), size(count.begin(), count.end());
  start[0] = first;
  const auto selection = select(id, start, size);
  if (!selection || H5Dwrite(id, file_type(type, kNativeOrder), selection->memory.get(), selection->file.get(),
                             H5P_DEFAULT, bytes.data()) < 0)
    return give_up(fmt::format("dataset \"{}\"", path));
  return {};
}

Result<void> Hdf5Writer::write_encoded_chunk(const std::string& path, std::span<const std::uint64_t> origin,
                                             std::span<const std::byte> stored) {
  if (id_ < 0) return abandoned();
  const auto found = datasets_.find(path);
  DUBSAR_CHECK(found != datasets_.end() && origin.size() == found->second.storage.chunk.size());
  const Library library;
  const std::vector<hsize_t> at(origin.begin(), origin.end());
  if (H5Dwrite_chunk(found->second.id, H5P_DEFAULT, 0, at.data(), stored.size(), stored.data()) < 0)
    return give_up(fmt::format("dataset \"{}\"", path));
  return {};
}

Result<void> Hdf5Writer::write_layers(const Dataset& dataset, const std::string& path, std::uint64_t first,
                                      std::span<const std::byte> bytes) {
  constexpr std::uint64_t kAtOnce = 64;  // chunks that are in memory at a time
  const Hdf5Storage& storage = dataset.storage;
  const auto element = static_cast<std::uint64_t>(scalar_bytes(storage.type));
  const std::vector<std::uint64_t>& chunk = storage.chunk;
  const std::array<std::uint64_t, 3> size{bytes.size() / (element * storage.dims[1] * storage.dims[2]), storage.dims[1],
                                          storage.dims[2]};
  std::array<std::uint64_t, 3> chunks{};
  for (std::size_t axis = 0; axis < 3; ++axis) chunks[axis] = (size[axis] + chunk[axis] - 1) / chunk[axis];
  const std::uint64_t all = chunks[0] * chunks[1] * chunks[2];
  const auto origin_of = [&](std::uint64_t c) {
    return std::array<std::uint64_t, 3>{c / (chunks[1] * chunks[2]) * chunk[0], c / chunks[2] % chunks[1] * chunk[1],
                                        c % chunks[2] * chunk[2]};
  };
  std::vector<std::vector<std::byte>> stored(std::min(all, kAtOnce));
  for (std::uint64_t from = 0; from < all; from += kAtOnce) {
    const std::uint64_t count = std::min(kAtOnce, all - from);
    parallel_for(static_cast<std::int64_t>(count), 1, [&](std::int64_t i) {
      thread_local std::vector<std::byte> numbers;
      numbers.resize(chunk[0] * chunk[1] * chunk[2] * element);
      cut_out(bytes, size, origin_of(from + static_cast<std::uint64_t>(i)), chunk, element, numbers);
      stored[static_cast<std::size_t>(i)] = encode_chunk(numbers, {element, storage.shuffle, storage.deflate});
    });
    for (std::uint64_t i = 0; i < count; ++i) {
      std::array<std::uint64_t, 3> origin = origin_of(from + i);
      origin[0] += first;
      DUBSAR_TRY(write_encoded_chunk(path, origin, stored[i]));
    }
  }
  return {};
}

Result<void> Hdf5Writer::write_table(const std::string& path, std::span<const std::string> columns,
                                     std::span<const double> values) {
  DUBSAR_CHECK(!columns.empty() && values.size() % columns.size() == 0);
  Hdf5Storage storage;
  storage.type = ScalarType::kF64;
  storage.dims = {values.size() / columns.size(), columns.size()};
  DUBSAR_TRY(write(path, storage, values));
  return set_attribute(path, "columns", columns);
}

Result<void> Hdf5Writer::write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                                         std::int64_t count, const void* values) {
  if (id_ < 0) return abandoned();
  const Handle parent(H5Oopen(id_, object.c_str(), H5P_DEFAULT), H5Oclose);
  const auto length = static_cast<hsize_t>(count);
  const Handle space(count < 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &length, nullptr), H5Sclose);
  const Handle id(H5Acreate2(parent.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!parent.ok() || !id.ok() || H5Awrite(id.get(), type, values) < 0)
    return give_up(fmt::format("attribute \"{}\" of \"{}\"", name, object));
  return {};
}

Result<void> Hdf5Writer::set_attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Library library;
  const char* value = text.c_str();
  return write_attribute(object, name, variable_string().get(), -1, &value);
}

Result<void> Hdf5Writer::set_attribute(const std::string& object, const std::string& name, double value) {
  const Library library;
  return write_attribute(object, name, H5T_NATIVE_DOUBLE, -1, &value);
}

Result<void> Hdf5Writer::set_attribute(const std::string& object, const std::string& name, std::int64_t value) {
  const Library library;
  return write_attribute(object, name, H5T_NATIVE_INT64, -1, &value);
}

Result<void> Hdf5Writer::set_attribute(const std::string& object, const std::string& name,
                                       std::span<const double> values) {
  const Library library;
  return write_attribute(object, name, H5T_NATIVE_DOUBLE, static_cast<std::int64_t>(values.size()), values.data());
}

Result<void> Hdf5Writer::set_attribute(const std::string& object, const std::string& name,
                                       std::span<const std::string> texts) {
  const Library library;
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  return write_attribute(object, name, variable_string().get(), static_cast<std::int64_t>(texts.size()),
                         pointers.data());
}

Result<void> Hdf5Writer::commit() {
  if (id_ < 0) return abandoned();
  {
    const Library library;
    if (!flush_and_close()) return give_up(file_.temporary_path().string());
  }
  return file_.commit();
}

}  // namespace dubsar
