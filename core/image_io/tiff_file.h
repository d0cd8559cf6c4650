#pragma once
// TIFF: gray pages of any size into memory, and 8-bit pictures to a file. tiff_file.cpp is the only source that
// includes tiffio.h.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/budget.h"
#include "core/image_io/image.h"

namespace dubsar {

struct TiffResolution {
  double x_per_unit = 0.0, y_per_unit = 0.0;  ///< pixels per unit; 0: not stated
  double unit_mm = 0.0;                       ///< length of that unit; 0: not stated
};

/// Tags 270, 285 and 305; empty: not stated.
struct TiffTexts {
  std::string description, name, software;
};

/// Where the pixels of a page lie.
struct TiffData {
  std::int64_t depth = 1;    ///< pictures in this page, one behind the other (ImageDepth, tag 32997)
  std::int64_t offset = -1;  ///< of uncompressed pixels whose strips lie one behind the other; -1: they do not
};

/// Facts about one page.
struct TiffPage {
  enum class Sample { kUnsigned, kSigned, kFloat, kOther };
  std::uint64_t offset = 0;  ///< of its directory, for TiffFile::select()
  std::int64_t width = 0, height = 0;
  int bits = 0;      ///< per sample
  int channels = 1;  ///< samples per pixel
  Sample sample = Sample::kUnsigned;
  bool palette = false;     ///< colours by table
  bool reduced = false;     ///< a thumbnail or a coarser level of another page
  std::string compression;  ///< "none", "LZW", ...
  TiffResolution resolution;
  TiffTexts texts;
  int orientation = 0;  ///< tag 274, 1 to 8: where the first row and column of the pixels lie; 0: not stated, as 1
  TiffData data;
  bool white_is_zero = false;  ///< as stored; read_gray() turns it
  bool big_endian = false;     ///< byte order of the file
};

/// A TIFF or BigTIFF file, read without memory mapping. One thread per object; open the file several times to read
/// pages in parallel. Damaged files end in kBadData; no single allocation by the library exceeds 1 GiB.
class TiffFile {
 public:
  static Result<TiffFile> open(const std::filesystem::path& path);
  /// "II*", "MM*" and their BigTIFF forms.
  static bool has_signature(const std::filesystem::path& path);

  /// All pages in order. kBadData beyond 65535 pages.
  Result<std::vector<TiffPage>> pages();
  /// Moves to the page whose directory lies at `offset`; 0 is the first page.
  Result<TiffPage> select(std::uint64_t offset);
  /// The selected page, which has one channel of whole bytes: height rows of width samples in the machine's byte order,
  /// 0 black (unsigned white-is-zero pages are inverted). `out` has exactly that size.
  Result<void> read_gray(std::span<std::byte> out);
  /// The selected page as a picture (read_tiff_picture()).
  Result<Image> read_picture(const Budget& budget);

 private:
  struct Closer {
    void operator()(void* tiff) const noexcept;
  };
  TiffFile() = default;
  Result<TiffPage> describe();
  tl::unexpected<Error> damaged(const std::string& what) const;

  std::filesystem::path path_;
  std::unique_ptr<std::string> library_says_;  ///< last message of libtiff; outlives tiff_
  std::unique_ptr<void, Closer> tiff_;
};

/// What a picture says about itself; empty: not said.
struct TiffTags {
  std::string description, copyright;
  std::string xmp;  ///< a whole XMP packet (tag 700)
};

/// Writes an RGB or RGBA picture, LZW-compressed, with the sRGB profile and its resolution in dots per inch (0: none).
/// The file appears whole or not at all. The same picture gives the same bytes. kCannotCreate, kPermission, kIo.
Result<void> write_tiff(const std::filesystem::path& path, const Image& image, double dpi, const TiffTags& tags = {});

/// One of several pictures of a file, with the name that programs with layers show.
struct TiffLayer {
  Image image;
  std::string name;
};

/// The same with `count` pages, each named, which `layer(k)` makes when its turn comes, so that one at a time is in
/// memory. The tags stand in the first page, which is the picture for programs that know only one. Errors of `layer`
/// besides.
Result<void> write_tiff_layers(const std::filesystem::path& path, int count,
                               const std::function<Result<TiffLayer>(int)>& layer, double dpi,
                               const TiffTags& tags = {});

/// The first page of any TIFF that libtiff can show (grey, palette, CMYK, YCbCr, 1 to 16 bits, strips or tiles) as
/// 8-bit RGB, or RGBA where it has transparency; 8-bit RGB and RGBA to the last bit. Sizes are checked against `budget`
/// before memory is taken. kNoInput, kPermission, kBadData, kTryAgain.
Result<Image> read_tiff_picture(const std::filesystem::path& path, const Budget& budget = {});

}  // namespace dubsar
