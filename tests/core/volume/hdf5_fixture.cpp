#include "tests/core/volume/hdf5_fixture.h"

#include <hdf5.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace dubsar::testing_tools {
namespace {

hid_t good(hid_t id) {
  if (id < 0) throw std::runtime_error("hdf5 fixture: a call failed");
  return id;
}

hid_t number_type(ScalarType type, ByteOrder order) {
  const bool big = order == ByteOrder::kBig;
  switch (type) {
    case ScalarType::kU8:
      return H5T_STD_U8LE;
    case ScalarType::kI8:
      return H5T_STD_I8LE;
    case ScalarType::kU16:
      return big ? H5T_STD_U16BE : H5T_STD_U16LE;
    case ScalarType::kI16:
      return big ? H5T_STD_I16BE : H5T_STD_I16LE;
    case ScalarType::kU32:
      return big ? H5T_STD_U32BE : H5T_STD_U32LE;
    case ScalarType::kI32:
      return big ? H5T_STD_I32BE : H5T_STD_I32LE;
    case ScalarType::kU64:
      return big ? H5T_STD_U64BE : H5T_STD_U64LE;
    case ScalarType::kI64:
      return big ? H5T_STD_I64BE : H5T_STD_I64LE;
    case ScalarType::kF32:
      return big ? H5T_IEEE_F32BE : H5T_IEEE_F32LE;
    default:
      return big ? H5T_IEEE_F64BE : H5T_IEEE_F64LE;
  }
}

hid_t space_of(const Shape& shape) {
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  return good(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr));
}

hid_t parents() {
  const hid_t list = good(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(list, 1);
  return list;
}

// Bytes as they are; for LZF as literal runs of up to 32 bytes behind a length byte.
template <bool kLiterals>
std::size_t store(unsigned int flags, std::size_t, const unsigned int*, std::size_t size, std::size_t* room,
                  void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) != 0 || !kLiterals) return size;
  auto* packed = static_cast<unsigned char*>(std::malloc(size + size / 32 + 1));
  const auto* from = static_cast<const unsigned char*>(*buffer);
  std::size_t out = 0;
  for (std::size_t at = 0; at < size; at += 32) {
    const std::size_t run = size - at < 32 ? size - at : 32;
    packed[out++] = static_cast<unsigned char>(run - 1);
    std::memcpy(packed + out, from + at, run);
    out += run;
  }
  std::free(*buffer);
  *buffer = packed;
  *room = size + size / 32 + 1;
  return out;
}

void set_packing(hid_t creation, const Packing& packing, std::vector<int>& filters) {
  if (packing.compact) H5Pset_layout(creation, H5D_COMPACT);
  if (packing.chunk.empty()) return;
  const std::vector<hsize_t> chunk(packing.chunk.begin(), packing.chunk.end());
  good(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()));
  if (packing.shuffle) H5Pset_shuffle(creation);
  if (packing.nbit) H5Pset_nbit(creation);
  if (packing.deflate > 0) H5Pset_deflate(creation, static_cast<unsigned int>(packing.deflate));
  if (packing.foreign_filter != 0) {
    const H5Z_class2_t filter{H5Z_CLASS_T_VERS,
                              packing.foreign_filter,
                              1,
                              1,
                              packing.foreign_filter == 32000 ? "lzf" : "foreign",
                              nullptr,
                              nullptr,
                              packing.foreign_filter == 32000 ? &store<true> : &store<false>};
    good(H5Zregister(&filter));
    good(H5Pset_filter(creation, packing.foreign_filter, H5Z_FLAG_MANDATORY, 0, nullptr));
    filters.push_back(packing.foreign_filter);
  }
  if (packing.fletcher32) H5Pset_fletcher32(creation);
}

}  // namespace

Hdf5Fixture::Hdf5Fixture(const std::filesystem::path& path, std::uint64_t user_block) {
  const hid_t creation = good(H5Pcreate(H5P_FILE_CREATE));
  if (user_block > 0) H5Pset_userblock(creation, user_block);
  id_ = good(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT));
  H5Pclose(creation);
}

Hdf5Fixture::~Hdf5Fixture() {
  H5Fclose(id_);
  for (const int id : filters_) H5Zunregister(id);
}

void Hdf5Fixture::group(const std::string& path) {
  const hid_t links = parents();
  H5Gclose(good(H5Gcreate2(id_, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT)));
  H5Pclose(links);
}

void Hdf5Fixture::array(const std::string& path, ScalarType type, ByteOrder order, const Shape& shape,
                        const std::vector<double>& values, const Packing& packing) {
  const hid_t links = parents(), space = space_of(shape), creation = good(H5Pcreate(H5P_DATASET_CREATE));
  set_packing(creation, packing, filters_);
  const hid_t id = good(H5Dcreate2(id_, path.c_str(), number_type(type, order), space, links, creation, H5P_DEFAULT));
  if (!values.empty()) good(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  H5Dclose(id);
  H5Pclose(creation);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::twelve_bits(const std::string& path, const Shape& shape, const std::vector<double>& values) {
  const hid_t links = parents(), space = space_of(shape), type = good(H5Tcopy(H5T_STD_U16LE));
  H5Tset_precision(type, 12);
  const hid_t id = good(H5Dcreate2(id_, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT));
  good(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  H5Dclose(id);
  H5Tclose(type);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::unwritten(const std::string& path, const Shape& shape, const Shape& chunk) {
  Packing packing;
  packing.chunk = chunk;
  array(path, ScalarType::kF32, ByteOrder::kLittle, shape, {}, packing);
}

void Hdf5Fixture::half_written(const std::string& path, const Shape& shape, const Shape& chunk, std::uint64_t written) {
  unwritten(path, shape, chunk);
  const hid_t id = good(H5Dopen2(id_, path.c_str(), H5P_DEFAULT)), file_space = H5Dget_space(id);
  std::vector<hsize_t> start(shape.size(), 0), count(shape.begin(), shape.end());
  count[0] = written;
  std::size_t total = 1;
  for (const hsize_t n : count) total *= n;
  const std::vector<float> values(total, 1.0F);
  const hid_t memory = good(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr));
  H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  good(H5Dwrite(id, H5T_NATIVE_FLOAT, memory, file_space, H5P_DEFAULT, values.data()));
  H5Sclose(memory);
  H5Sclose(file_space);
  H5Dclose(id);
}

void Hdf5Fixture::compound(const std::string& path, const Shape& shape) {
  const hid_t links = parents(), space = space_of(shape), type = good(H5Tcreate(H5T_COMPOUND, 8));
  H5Tinsert(type, "re", 0, H5T_NATIVE_FLOAT);
  H5Tinsert(type, "im", 4, H5T_NATIVE_FLOAT);
  H5Dclose(good(H5Dcreate2(id_, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT)));
  H5Tclose(type);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::strings(const std::string& path, const Shape& shape) {
  const hid_t links = parents(), space = space_of(shape), type = good(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, 8);
  H5Dclose(good(H5Dcreate2(id_, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT)));
  H5Tclose(type);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::text(const std::string& path, const std::string& text) {
  const hid_t links = parents(), space = good(H5Screate(H5S_SCALAR)), type = good(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, text.size());
  const hid_t id = good(H5Dcreate2(id_, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT));
  good(H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
  H5Dclose(id);
  H5Tclose(type);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::external_storage(const std::string& path, const Shape& shape, const std::string& file,
                                   std::int64_t offset) {
  const hid_t links = parents(), space = space_of(shape), creation = good(H5Pcreate(H5P_DATASET_CREATE));
  good(H5Pset_external(creation, file.c_str(), offset, H5F_UNLIMITED));
  H5Dclose(good(H5Dcreate2(id_, path.c_str(), H5T_STD_U8LE, space, links, creation, H5P_DEFAULT)));
  H5Pclose(creation);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::virtual_dataset(const std::string& path, const Shape& shape, const std::string& file,
                                  const std::string& source) {
  const hid_t links = parents(), space = space_of(shape), creation = good(H5Pcreate(H5P_DATASET_CREATE));
  good(H5Pset_virtual(creation, space, file.c_str(), source.c_str(), space));
  H5Dclose(good(H5Dcreate2(id_, path.c_str(), H5T_IEEE_F32LE, space, links, creation, H5P_DEFAULT)));
  H5Pclose(creation);
  H5Sclose(space);
  H5Pclose(links);
}

void Hdf5Fixture::external_link(const std::string& path, const std::string& file, const std::string& target) {
  const hid_t links = parents();
  good(H5Lcreate_external(file.c_str(), target.c_str(), id_, path.c_str(), links, H5P_DEFAULT));
  H5Pclose(links);
}

void Hdf5Fixture::soft_link(const std::string& path, const std::string& target) {
  const hid_t links = parents();
  good(H5Lcreate_soft(target.c_str(), id_, path.c_str(), links, H5P_DEFAULT));
  H5Pclose(links);
}

void Hdf5Fixture::hard_link(const std::string& path, const std::string& target) {
  const hid_t links = parents();
  good(H5Lcreate_hard(id_, target.c_str(), id_, path.c_str(), links, H5P_DEFAULT));
  H5Pclose(links);
}

void Hdf5Fixture::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const hid_t parent = good(H5Oopen(id_, object.c_str(), H5P_DEFAULT)), space = good(H5Screate(H5S_SCALAR)),
              type = good(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, text.size());
  const hid_t id = good(H5Acreate2(parent, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
  good(H5Awrite(id, type, text.data()));
  H5Aclose(id);
  H5Tclose(type);
  H5Sclose(space);
  H5Oclose(parent);
}

void Hdf5Fixture::attribute(const std::string& object, const std::string& name, const std::vector<double>& values) {
  const hid_t parent = good(H5Oopen(id_, object.c_str(), H5P_DEFAULT)), space = space_of({values.size()});
  const hid_t id = good(H5Acreate2(parent, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT));
  good(H5Awrite(id, H5T_NATIVE_DOUBLE, values.data()));
  H5Aclose(id);
  H5Sclose(space);
  H5Oclose(parent);
}

void Hdf5Fixture::attribute(const std::string& object, const std::string& name, const std::vector<std::string>& texts) {
  const hid_t parent = good(H5Oopen(id_, object.c_str(), H5P_DEFAULT)), space = space_of({texts.size()}),
              type = good(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, H5T_VARIABLE);
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.empty() ? nullptr : text.c_str());
  const hid_t id = good(H5Acreate2(parent, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
  good(H5Awrite(id, type, pointers.data()));
  H5Aclose(id);
  H5Tclose(type);
  H5Sclose(space);
  H5Oclose(parent);
}

void Hdf5Fixture::integers(const std::string& object, const std::string& name, const std::vector<int>& values) {
  const hid_t parent = good(H5Oopen(id_, object.c_str(), H5P_DEFAULT)), space = space_of({values.size()});
  const hid_t id = good(H5Acreate2(parent, name.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT));
  good(H5Awrite(id, H5T_NATIVE_INT, values.data()));
  H5Aclose(id);
  H5Sclose(space);
  H5Oclose(parent);
}

void Hdf5Fixture::characters(const std::string& object, const std::string& name, const std::string& text) {
  const hsize_t count = text.size();
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &count, nullptr);
  const hid_t parent = H5Oopen(id_, object.c_str(), H5P_DEFAULT);
  const hid_t attribute = H5Acreate2(parent, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, text.data());
  H5Aclose(attribute);
  H5Oclose(parent);
  H5Sclose(space);
  H5Tclose(type);
}

void Hdf5Fixture::dimension_scale(const std::string& scale, const std::string& dataset, int axis) {
  attribute(scale, "CLASS", std::string("DIMENSION_SCALE"));
  struct Entry {
    hobj_ref_t object;
    int axis;
  } entry{};
  H5Rcreate(&entry.object, id_, dataset.c_str(), H5R_OBJECT, -1);
  entry.axis = axis;
  const hsize_t one = 1;
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Entry)), space = H5Screate_simple(1, &one, nullptr);
  H5Tinsert(type, "dataset", offsetof(Entry, object), H5T_STD_REF_OBJ);
  H5Tinsert(type, "dimension", offsetof(Entry, axis), H5T_NATIVE_INT);
  const hid_t parent = H5Oopen(id_, scale.c_str(), H5P_DEFAULT);
  const hid_t list = H5Acreate2(parent, "REFERENCE_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(list, type, &entry);
  H5Aclose(list);
  H5Oclose(parent);
  H5Sclose(space);
  H5Tclose(type);
}

}  // namespace dubsar::testing_tools
