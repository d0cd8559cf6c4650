#pragma once
// Pictures of a film in a folder: numbered names, a list of what they were made from, and which of them are there. A
// series that was interrupted, in whatever way, goes on where it was.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image_io/picture_file.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// All that the pictures depend on. Two series of the same facts have the same bytes.
struct SeriesFacts {
  std::string film;     ///< fingerprint of its keyframes and of the looks that they change
  std::string surface;  ///< of the mesh
  std::string display, style, program, format;
  int width = 0, height = 0, samples = 0, pictures = 0;
  double fps = 0.0;
  bool operator==(const SeriesFacts&) const = default;
};

/// 16 hexadecimal digits (FNV-1a of 64 bits).
std::string fingerprint(std::string_view bytes);
std::string fingerprint(const TriMesh& mesh);

class PictureSeries {
 public:
  /// Makes the folder where there is none, and writes `facts` into it (film_pictures.json). With `again` all pictures
  /// are made anew, also in place of those of other facts; else those are kUsage, which says what differs. Only
  /// pictures that film_pictures.made lists and that are as they were written are ever removed or written over; what a
  /// killed run left half written is removed, but nothing of one that lives. kCannotCreate: `folder` is something else,
  /// or somebody's file has the name of a picture.
  static Result<PictureSeries> open(const std::filesystem::path& folder, const std::string& suffix,
                                    const SeriesFacts& facts, bool again);

  /// "picture_00001.png" for number 0; at least five digits, more where the series needs them.
  std::filesystem::path path(int number) const;
  /// "picture_%05d.png", as printf() and ffmpeg count.
  std::string pattern() const;
  int count() const noexcept { return facts_.pictures; }
  /// Numbers of pictures that are not there, are damaged, or have another size, rising. Reads them all: about 50 a
  /// second for 1920 x 1080. kCancelled; kCannotCreate: a picture of another size that was not written here.
  Result<std::vector<int>> missing(Progress& progress) const;
  /// A picture was written: it is the program's own from now on. Any thread, one at a time. kIo.
  Result<void> wrote(int number) const;
  /// All are there: film_pictures.made in the order of the pictures, the same after any number of stops.
  Result<void> settle() const;
  /// Removes the pictures that are as they were written and the lists, and the folder when nothing else is in it.
  void remove() const;

 private:
  std::filesystem::path folder_;
  std::string suffix_;
  SeriesFacts facts_;
};

}  // namespace dubsar::app
