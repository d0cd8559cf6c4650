#pragma once
// The photographs in a binary glTF file, and the colours that materials give to places of a surface.

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>

#include "core/image_io/image.h"
#include "core/mesh_io/glb/glb_data.h"

namespace dubsar {

/// How a material colours a surface.
struct GlbPaint {
  const Image* photo = nullptr;  ///< null: the factor alone
  glm::dvec4 factor{1.0};        ///< linear light
  int coordinates = 0;           ///< which TEXCOORD_ of the primitive
  glm::dvec2 offset{0.0}, scale{1.0};
  double turn = 0.0;                      ///< radians, counter-clockwise in the coordinates (KHR_texture_transform)
  std::array<int, 2> wrap{10497, 10497};  ///< beyond 0..1, as glTF names it

  bool any() const noexcept { return photo != nullptr || factor != glm::dvec4(1.0); }
  /// Coordinates of the file to shares of the picture, before wrapping.
  glm::dvec2 place(const glm::dvec2& uv) const;
  /// sRGB bytes of a place: mean over `side` pixels each way, at least the four around it. `own`: the vertex's colour,
  /// linear.
  std::array<std::uint8_t, 3> color(const glm::dvec2& uv, double side, const glm::dvec4& own) const;
};

/// Of one file; decodes each photograph once.
class GlbPhotos {
 public:
  explicit GlbPhotos(GlbData& data) : data_(data) {}
  /// The paint of a material: its base colour, the diffuse colour of older files, or its glow where it has nothing
  /// else. A photograph of a kind that cannot be read (WebP, Basis), or that is damaged, is left out, which is said
  /// once.
  GlbPaint paint(std::optional<std::uint64_t> material);

 private:
  const Image* photo(std::uint64_t texture);
  GlbData& data_;
  std::map<std::uint64_t, std::optional<Image>> photos_;  ///< by the number of the image
};

/// sRGB byte of linear light 0..1.
std::uint8_t srgb_of_linear(double linear);

}  // namespace dubsar
