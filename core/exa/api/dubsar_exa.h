#pragma once
// libdubsar-exa: reads EXA surface files. This header needs the standard library only (C++17); link dubsar-exa.
//
//   dubsar_exa::Surface surface;
//   std::string error;
//   if (!dubsar_exa::read("tablet.exa", {}, surface, error)) { std::cerr << error << '\n'; return 1; }
//
// Any thread may read; one call uses all cores. Nothing throws. A damaged or hostile file gives an error, and takes no
// more memory than its header proves that it needs.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#if defined(__GNUC__)
#define DUBSAR_EXA_API __attribute__((visibility("default")))
#else
#define DUBSAR_EXA_API
#endif

namespace dubsar_exa {

struct Info {
  int major = 0, minor = 0;            ///< of the format
  std::array<std::int64_t, 3> grid{};  ///< points along x, y, z
  std::int64_t vertices = 0, quads = 0, bytes = 0;
  std::array<double, 3> grid_step_mm{};
  std::string tool;        ///< program that wrote the file
  std::string provenance;  ///< JSON text; empty: none
};

struct Partition {
  int id = 0;
  std::string name, body;
  double area_mm2 = 0.0, volume_mm3 = 0.0;
  bool watertight = false;
};

/// Triangles run counter-clockwise seen from the air. An array of attributes is empty, or has one entry a vertex
/// (`triangle_partition`, `inferred`: a triangle).
struct Surface {
  std::vector<std::array<float, 3>> positions_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<float, 3>> normals;
  std::vector<float> k_min, k_max;               ///< curvatures per grid step, convex > 0
  std::vector<std::uint8_t> shape;               ///< 0 flat, else 1 + 9 i + s (docs/exa.md)
  std::vector<std::uint8_t> light;               ///< 0 dark .. 63 open
  std::vector<std::uint8_t> triangle_partition;  ///< ids of `partitions`
  std::vector<std::uint8_t> inferred;            ///< 1: closes a hole, there is no surface in the scan
  std::vector<Partition> partitions;
};

struct ReadOptions {
  int level = 0;           ///< 1..3: the coarser surface of every 2nd, 4th or 8th grid point, without attributes
  bool attributes = true;  ///< false: positions, triangles and what is stored; normals and curvatures stay empty
  bool fill_holes = true;  ///< with the patches that close what segmentation cut
  int partition = -1;      ///< only this one
  std::string body;        ///< only the partitions of this body
  /// Only bricks of 128 grid points that touch this box of grid points (x, y, z, ends included); open where they end,
  /// without attributes. Used when box_high is not all 0.
  std::array<std::int64_t, 3> box_low{}, box_high{};
};

/// False: `error` says in one sentence what was found and expected.
DUBSAR_EXA_API bool read_info(const std::string& path, Info& info, std::string& error);
DUBSAR_EXA_API bool read(const std::string& path, const ReadOptions& options, Surface& surface, std::string& error);
/// The same of a file that is in memory already, whole: fetched, or a part of an archive. No levels, no boxes.
DUBSAR_EXA_API bool read_bytes(const void* bytes, std::size_t size, const ReadOptions& options, Surface& surface,
                               std::string& error);
/// Checks every sum of a file without decoding it.
DUBSAR_EXA_API bool check_sums(const std::string& path, std::string& error);

}  // namespace dubsar_exa
