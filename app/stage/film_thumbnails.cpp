#include "app/stage/film_thumbnails.h"

#include <algorithm>

#include "display/render/context/gl_objects.h"

namespace dubsar::app {

struct FilmThumbnails::Entry {
  Keyframe of;  // at time 0
  GlTexture texture;
};

namespace {

GlTexture texture_of(const Image& image) {
  GlTexture out = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(out, 1, GL_RGBA8, image.width, image.height);
  glTextureParameteri(out, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(out, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(out, 0, 0, 0, image.width, image.height, image.channels == 4 ? GL_RGBA : GL_RGB, GL_UNSIGNED_BYTE,
                      image.pixels.data());
  return out;
}

Keyframe look_of(Keyframe key) {
  key.time_s = 0.0;
  return key;
}

}  // namespace

FilmThumbnails::FilmThumbnails() = default;
FilmThumbnails::~FilmThumbnails() = default;

std::vector<std::uint32_t> FilmThumbnails::of(const std::vector<Keyframe>& keys, Stage& stage, bool may_draw,
                                              const std::function<Shown(const Keyframe&)>& shown) {
  std::vector<std::uint32_t> out;
  std::vector<Entry> kept;
  for (const Keyframe& key : keys) {
    const Keyframe look = look_of(key);
    const auto same = [&](const Entry& entry) { return entry.of == look; };
    auto at = std::find_if(kept.begin(), kept.end(), same);
    if (at == kept.end()) {
      const auto before = std::find_if(entries_.begin(), entries_.end(), same);
      if (before != entries_.end()) {
        at = kept.insert(kept.end(), std::move(*before));
        entries_.erase(before);
      } else if (may_draw) {
        may_draw = false;
        if (const auto image = stage.thumbnail(shown(look), kHeight))
          at = kept.insert(kept.end(), Entry{look, texture_of(*image)});
      }
    }
    out.push_back(at == kept.end() ? 0 : static_cast<GLuint>(at->texture));
  }
  entries_ = std::move(kept);
  return out;
}

}  // namespace dubsar::app
