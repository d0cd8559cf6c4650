#include "core/mesh_io/glb/glb_photo.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <span>

#include "core/base/system/log.h"
#include "core/image_io/jpeg_file.h"
#include "core/image_io/png_file.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
constexpr int kClamp = 33071, kMirror = 33648;

double number_of(const Json& object, const char* key, double otherwise) {
  const Json* const value = glb_member(object, key);
  return value && value->is_number() ? value->get<double>() : otherwise;
}

/// Numbers of an array; those that are missing stay.
template <class Vector>
void read_vector(const Json* array, Vector& out) {
  if (!array || !array->is_array()) return;
  for (int i = 0; i < static_cast<int>(Vector::length()) && static_cast<std::size_t>(i) < array->size(); ++i)
    if ((*array)[static_cast<std::size_t>(i)].is_number()) out[i] = (*array)[static_cast<std::size_t>(i)].get<double>();
}

double linear_of(std::uint8_t srgb) {
  const double c = srgb / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

int wrapped(std::int64_t at, int size, int how) {
  if (how == kClamp) return static_cast<int>(std::clamp<std::int64_t>(at, 0, size - 1));
  const std::int64_t period = how == kMirror ? 2 * std::int64_t{size} : size;
  const std::int64_t inside = (at % period + period) % period;
  return static_cast<int>(inside < size ? inside : period - 1 - inside);
}

}  // namespace

std::uint8_t srgb_of_linear(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return static_cast<std::uint8_t>(
      std::lround(255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055)));
}

glm::dvec2 GlbPaint::place(const glm::dvec2& uv) const {
  const glm::dvec2 scaled = uv * scale;
  const double c = std::cos(turn), s = std::sin(turn);
  return offset + glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
}

std::array<std::uint8_t, 3> GlbPaint::color(const glm::dvec2& uv, double side, const glm::dvec4& own) const {
  static const std::array<double, 256> kLinear = [] {
    std::array<double, 256> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = linear_of(static_cast<std::uint8_t>(i));
    return out;
  }();
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  if (photo != nullptr) {
    const glm::dvec2 at = place(uv) * glm::dvec2(photo->width, photo->height) - 0.5;
    const double reach = std::max(1.0, 0.5 * side);
    if (std::isfinite(at.x + at.y) && std::abs(at.x) < 1e9 && std::abs(at.y) < 1e9)
      for (auto y = static_cast<std::int64_t>(std::ceil(at.y - reach)); static_cast<double>(y) <= at.y + reach; ++y)
        for (auto x = static_cast<std::int64_t>(std::ceil(at.x - reach)); static_cast<double>(x) <= at.x + reach; ++x) {
          const double weight = (1.0 - std::abs(static_cast<double>(x) - at.x) / reach) *
                                (1.0 - std::abs(static_cast<double>(y) - at.y) / reach);
          if (!(weight > 0)) continue;
          const std::uint8_t* const p =
              photo->at(wrapped(x, photo->width, wrap[0]), wrapped(y, photo->height, wrap[1]));
          sum += weight * glm::dvec3(kLinear[p[0]], kLinear[p[1]], kLinear[p[2]]);
          weights += weight;
        }
  }
  const glm::dvec3 base = weights > 0 ? sum / weights : glm::dvec3(1.0);
  std::array<std::uint8_t, 3> out{};
  for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)] = srgb_of_linear(base[c] * factor[c] * own[c]);
  return out;
}

const Image* GlbPhotos::photo(std::uint64_t texture) {
  const Json* const json = glb_element(data_.root(), "textures", texture);
  if (!json) return nullptr;
  auto number = glb_number(*json, "source", std::nullopt);
  for (const char* const name : {"EXT_texture_webp", "KHR_texture_basisu"})  // told as what cannot be read
    if (const Json* const other = glb_extension(*json, name); other && !number)
      number = glb_number(*other, "source", std::nullopt);
  const Json* const image = glb_element(data_.root(), "images", number);
  if (!image) return nullptr;
  const auto [found, made] = photos_.try_emplace(*number);
  if (!made) return found->second ? &*found->second : nullptr;
  const auto bytes = glb_member(*image, "bufferView")
                         ? data_.view(glb_number(*image, "bufferView", std::nullopt))
                         : Result<std::string_view>(broken_glb("it lies in another file or is written as text"));
  Result<Image> read = tl::unexpected<Error>(
      bytes ? Error{ErrorKind::kBadData, "its kind cannot be read, expected JPEG or PNG"} : bytes.error());
  if (bytes) {
    const auto span = std::as_bytes(std::span(*bytes));
    if (bytes->starts_with("\xFF\xD8")) read = decode_jpeg(span, "glb");
    if (bytes->starts_with("\x89PNG")) read = decode_png(span, "glb");
  }
  if (!read) {
    log_warning("glb: a photograph of the surface is left out: {}", read.error().message);
    return nullptr;
  }
  found->second = *std::move(read);
  return &*found->second;
}

GlbPaint GlbPhotos::paint(std::optional<std::uint64_t> material) {
  GlbPaint out;
  const Json* const json = glb_element(data_.root(), "materials", material);
  if (!json) return out;
  const Json* texture = nullptr;
  const Json* const usual = glb_member(*json, "pbrMetallicRoughness");
  const Json* const older = glb_extension(*json, "KHR_materials_pbrSpecularGlossiness");
  if (usual) {
    read_vector(glb_member(*usual, "baseColorFactor"), out.factor);
    texture = glb_member(*usual, "baseColorTexture");
  }
  if (older && !texture) {
    read_vector(glb_member(*older, "diffuseFactor"), out.factor);
    texture = glb_member(*older, "diffuseTexture");
  }
  if (!texture && (texture = glb_member(*json, "emissiveTexture")) != nullptr) out.factor = glm::dvec4(1.0);
  const auto index = texture ? glb_number(*texture, "index", std::nullopt) : std::nullopt;
  if (!index) return out;
  out.photo = photo(*index);
  if (!out.photo) return out;
  out.coordinates = static_cast<int>(std::min<std::uint64_t>(glb_number(*texture, "texCoord", 0).value_or(0), 15));
  if (const Json* const moved = glb_extension(*texture, "KHR_texture_transform")) {
    read_vector(glb_member(*moved, "offset"), out.offset);
    read_vector(glb_member(*moved, "scale"), out.scale);
    out.turn = number_of(*moved, "rotation", 0.0);
    out.coordinates = static_cast<int>(std::min<std::uint64_t>(
        glb_number(*moved, "texCoord", static_cast<std::uint64_t>(out.coordinates)).value_or(0), 15));
  }
  const Json* const row = glb_element(data_.root(), "textures", *index);
  if (const Json* const sampler =
          glb_element(data_.root(), "samplers", row ? glb_number(*row, "sampler", std::nullopt) : std::nullopt)) {
    out.wrap[0] = static_cast<int>(glb_number(*sampler, "wrapS", 10497).value_or(10497) & 0xffff);
    out.wrap[1] = static_cast<int>(glb_number(*sampler, "wrapT", 10497).value_or(10497) & 0xffff);
  }
  return out;
}

}  // namespace dubsar
