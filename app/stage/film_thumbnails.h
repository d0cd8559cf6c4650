#pragma once
// Small pictures of a film's keyframes, made one by one while nothing else is to be done.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "app/document/keyframe.h"
#include "app/stage/stage.h"

namespace dubsar::app {

/// One thread: that of the GL context, which is current in every call and at the end.
class FilmThumbnails {
 public:
  static constexpr int kHeight = 120;

  FilmThumbnails();
  ~FilmThumbnails();
  FilmThumbnails(FilmThumbnails&&) = delete;

  /// Names of textures, one for each keyframe, 0 where there is none yet; makes one that is missing, if `may_draw`.
  /// Keyframes that look the same at another time share their picture; those that are gone lose it.
  std::vector<std::uint32_t> of(const std::vector<Keyframe>& keys, Stage& stage, bool may_draw,
                                const std::function<Shown(const Keyframe&)>& shown);

 private:
  struct Entry;
  std::vector<Entry> entries_;
};

}  // namespace dubsar::app
