#include "core/mesh_io/glb/glb_data.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/system/budget.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
constexpr std::uint64_t kMost = std::uint64_t{1} << 40;  // larger offsets and counts cannot be meant
constexpr std::uint64_t kMostStride = 4096;

std::uint64_t component_bytes(int component) {
  switch (component) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

std::uint64_t parts_of(const std::string& type) {
  return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
}

}  // namespace

tl::unexpected<Error> broken_glb(std::string_view what) { return fail(ErrorKind::kBadData, "glb: {}", what); }

const Json* glb_member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<std::uint64_t> glb_number(const Json& object, const char* key, std::optional<std::uint64_t> otherwise) {
  const Json* value = glb_member(object, key);
  if (!value) return otherwise;
  // Some writers hold every number in floating point.
  if (value->is_number_float() && value->get<double>() >= 0 && value->get<double>() <= static_cast<double>(kMost) &&
      value->get<double>() == std::floor(value->get<double>()))
    return static_cast<std::uint64_t>(value->get<double>());
  if (!value->is_number_unsigned() || value->get<std::uint64_t>() > kMost) return std::nullopt;
  return value->get<std::uint64_t>();
}

const Json* glb_element(const Json& root, const char* key, std::optional<std::uint64_t> index) {
  const Json* array = glb_member(root, key);
  if (!array || !array->is_array() || !index || *index >= array->size()) return nullptr;
  return &(*array)[*index];
}

const Json* glb_extension(const Json& object, const char* name) {
  const Json* const all = glb_member(object, "extensions");
  return all ? glb_member(*all, name) : nullptr;
}

double GlbAccessor::raw(std::uint64_t item, std::uint64_t part) const {
  const auto read = [&]<class T>(T) {
    T value;
    std::memcpy(&value, bytes.data() + item * stride + part * sizeof(T), sizeof(T));
    return static_cast<double>(value);
  };
  switch (component) {
    case 5120:
      return std::max<double>(read(std::int8_t{}), normalized ? -127.0 : -128.0);
    case 5121:
      return read(std::uint8_t{});
    case 5122:
      return std::max<double>(read(std::int16_t{}), normalized ? -32767.0 : -32768.0);
    case 5123:
      return read(std::uint16_t{});
    case 5125:
      return read(std::uint32_t{});
    default:
      return read(float{});
  }
}

double GlbAccessor::scale() const noexcept {
  switch (component) {
    case 5120:
      return 1.0 / 127.0;
    case 5121:
      return 1.0 / 255.0;
    case 5122:
      return 1.0 / 32767.0;
    case 5123:
      return 1.0 / 65535.0;
    default:
      return 1.0;
  }
}

/// The bytes that byteOffset and byteLength of buffer 0 name.
Result<std::string_view> GlbData::raw_bytes(const Json& holder) {
  const auto number = glb_number(holder, "buffer", std::nullopt);
  const Json* const buffer = glb_element(root_, "buffers", number);
  if (const Json* const uri = buffer ? glb_member(*buffer, "uri") : nullptr; uri && uri->is_string()) {
    const std::string text = uri->get<std::string>();
    return broken_glb(fmt::format(
        "the numbers {} found, expected them in the binary chunk; export it as GLB, with all data inside",
        text.starts_with("data:") ? "as text (a data URI)" : "in another file (" + text.substr(0, 80) + ")"));
  }
  if (number != 0) return broken_glb("data outside the file, expected buffer 0");
  const auto offset = glb_number(holder, "byteOffset", 0), length = glb_number(holder, "byteLength", std::nullopt);
  if (!offset || !length) return broken_glb("a buffer view is broken");
  if (*offset > bin_.size() || *length > bin_.size() - *offset)
    return broken_glb("a buffer view lies outside the data");
  return bin_.substr(*offset, *length);
}

/// EXT_meshopt_compression.
Result<std::string_view> GlbData::unpacked(std::uint64_t index, const Json& packed) {
  if (const auto found = unpacked_.find(index); found != unpacked_.end()) return std::string_view(found->second);
  DUBSAR_ASSIGN(const std::string_view bytes, raw_bytes(packed));
  const auto count = glb_number(packed, "count", std::nullopt), stride = glb_number(packed, "byteStride", std::nullopt);
  const Json *const mode = glb_member(packed, "mode"), *const filter = glb_member(packed, "filter");
  if (!count || !stride || *stride == 0 || *stride > 256 || *count > kMost / kMostStride || !mode || !mode->is_string())
    return broken_glb("a compressed buffer view is broken");
  // No mode packs more than 16 items into a byte.
  if (*count > 16 * std::max<std::uint64_t>(bytes.size(), 1))
    return broken_glb("a compressed buffer view announces more than its bytes can hold");
  DUBSAR_TRY(check_memory("glb", *count * *stride));
  std::string out(*count * *stride, '\0');
  const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());  // as the library wants it
  const std::string name = mode->get<std::string>();
  int bad = -1;
  if (name == "ATTRIBUTES" && *stride % 4 == 0)
    bad = meshopt_decodeVertexBuffer(out.data(), *count, *stride, from, bytes.size());
  else if (name == "TRIANGLES" && *count % 3 == 0 && (*stride == 2 || *stride == 4))
    bad = meshopt_decodeIndexBuffer(out.data(), *count, *stride, from, bytes.size());
  else if (name == "INDICES" && (*stride == 2 || *stride == 4))
    bad = meshopt_decodeIndexSequence(out.data(), *count, *stride, from, bytes.size());
  if (bad != 0) return broken_glb("a compressed buffer view is damaged, or of a later kind of compression");
  const std::string how = filter && filter->is_string() ? filter->get<std::string>() : "NONE";
  if (how == "OCTAHEDRAL" && (*stride == 4 || *stride == 8))
    meshopt_decodeFilterOct(out.data(), *count, *stride);
  else if (how == "QUATERNION" && *stride == 8)
    meshopt_decodeFilterQuat(out.data(), *count, *stride);
  else if (how == "EXPONENTIAL" && *stride % 4 == 0)
    meshopt_decodeFilterExp(out.data(), *count, *stride);
  else if (how != "NONE")
    return broken_glb("a compressed buffer view has a filter that is not known");
  return std::string_view(unpacked_.emplace(index, std::move(out)).first->second);
}

Result<std::string_view> GlbData::view(std::optional<std::uint64_t> index) {
  const Json* const json = glb_element(root_, "bufferViews", index);
  if (!json) return broken_glb("an accessor has no buffer view");
  for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (const Json* const packed = glb_extension(*json, name)) return unpacked(*index, *packed);
  return raw_bytes(*json);
}

Result<void> GlbData::fill_sparse(GlbAccessor& accessor, std::uint64_t item_bytes, const Json& sparse) {
  const auto count = glb_number(sparse, "count", std::nullopt);
  const Json *const places = glb_member(sparse, "indices"), *const values = glb_member(sparse, "values");
  if (!count || !places || !values || *count > accessor.count) return broken_glb("a sparse accessor is broken");
  DUBSAR_TRY(check_memory("glb", accessor.count * item_bytes));
  std::string all(accessor.count * item_bytes, '\0');
  for (std::uint64_t i = 0; !accessor.bytes.empty() && i < accessor.count; ++i)
    std::memcpy(all.data() + i * item_bytes, accessor.bytes.data() + i * accessor.stride, item_bytes);
  DUBSAR_ASSIGN(const std::string_view place_bytes, view(glb_number(*places, "bufferView", std::nullopt)));
  DUBSAR_ASSIGN(const std::string_view value_bytes, view(glb_number(*values, "bufferView", std::nullopt)));
  const auto place_offset = glb_number(*places, "byteOffset", 0), value_offset = glb_number(*values, "byteOffset", 0),
             component = glb_number(*places, "componentType", std::nullopt);
  if (!place_offset || !value_offset || (component != 5121 && component != 5123 && component != 5125))
    return broken_glb("a sparse accessor is broken");
  GlbAccessor at;
  at.component = static_cast<int>(*component);
  at.stride = component_bytes(at.component);
  if (*place_offset > place_bytes.size() || *count * at.stride > place_bytes.size() - *place_offset ||
      *value_offset > value_bytes.size() || *count * item_bytes > value_bytes.size() - *value_offset)
    return broken_glb("a sparse accessor lies outside its buffer view");
  at.bytes = place_bytes.substr(*place_offset);
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto place = static_cast<std::uint64_t>(at.raw(i, 0));
    if (place >= accessor.count) return broken_glb("a sparse accessor names an item that does not exist");
    std::memcpy(all.data() + place * item_bytes, value_bytes.data() + *value_offset + i * item_bytes, item_bytes);
  }
  accessor.bytes = filled_.emplace_back(std::move(all));
  accessor.stride = item_bytes;
  return {};
}

bool GlbData::has_bytes(const Json* index) const {
  const Json* const json =
      index && index->is_number_unsigned() ? glb_element(root_, "accessors", index->get<std::uint64_t>()) : nullptr;
  return json && (glb_member(*json, "bufferView") || glb_member(*json, "sparse"));
}

Result<GlbAccessor> GlbData::accessor(const Json* index) {
  if (!index || !index->is_number_unsigned()) return broken_glb("a primitive has no usable accessor number");
  const Json* const json = glb_element(root_, "accessors", index->get<std::uint64_t>());
  if (!json) return broken_glb("an accessor is missing");
  GlbAccessor out;
  const auto component = glb_number(*json, "componentType", std::nullopt),
             count = glb_number(*json, "count", std::nullopt);
  const Json* const type = glb_member(*json, "type");
  if (!component || !count || !type || !type->is_string()) return broken_glb("an accessor is broken");
  out.component = *component <= 5126 ? static_cast<int>(*component) : 0;
  out.count = *count;
  out.parts = parts_of(type->get<std::string>());
  const Json* const normalized = glb_member(*json, "normalized");
  out.normalized = normalized && normalized->is_boolean() && normalized->get<bool>() && !out.floats();
  const std::uint64_t item_bytes = component_bytes(out.component) * out.parts;
  if (item_bytes == 0) return broken_glb("an accessor has a type that is not supported");
  if (out.count == 0 || out.count > kMost / kMostStride) return broken_glb("an accessor lies outside its buffer view");
  const Json* const sparse = glb_member(*json, "sparse");
  const Json* const view_number = glb_member(*json, "bufferView");
  if (!view_number && !sparse) return broken_glb("an accessor has no buffer view");
  if (view_number) {
    const auto number = glb_number(*json, "bufferView", std::nullopt);
    DUBSAR_ASSIGN(const std::string_view bytes, view(number));
    const auto offset = glb_number(*json, "byteOffset", 0),
               stride = glb_number(*glb_element(root_, "bufferViews", number), "byteStride", item_bytes);
    if (!offset || !stride || *stride < item_bytes || *stride > kMostStride)
      return broken_glb("a buffer view is broken");
    if (*offset + (out.count - 1) * *stride + item_bytes > bytes.size())
      return broken_glb("an accessor lies outside its buffer view");
    out.stride = *stride;
    out.bytes = bytes.substr(*offset);
  } else if (out.count > std::max<std::uint64_t>(bin_.size(), 1)) {
    return broken_glb("a sparse accessor announces more items than the file has bytes");
  }
  if (sparse) DUBSAR_TRY(fill_sparse(out, item_bytes, *sparse));
  return out;
}

}  // namespace dubsar
