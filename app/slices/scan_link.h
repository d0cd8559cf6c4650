#pragma once
// Which scan a surface was made of, where that is, and whether it is really that one.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/mesh/tri_mesh.h"
#include "core/volume/formats/import_options.h"
#include "core/volume/plane_sampler.h"

namespace dubsar::app {

struct ScanLink {
  ImportOptions import{};
  glm::dvec3 voxel_mm{1.0};   ///< as the surface has it
  std::string fingerprint{};  ///< of the scan that the surface was made of; empty: not known
  Dims dims{};                ///< of that scan; 0: not known
  bool given = false;         ///< by the user, else found
};

/// What somebody asks for as a scan can be opened: as it was asked for, or, when nobody says how it is read and it does
/// not say it itself, as the provenance of a surface does. Errors of open_voxels().
Result<ImportOptions> readable_scan(ImportOptions asked, std::string_view provenance);

/// `surface` is the file of the mesh, whose provenance names its scan and says how that was read. `given` is what the
/// user says (readable_scan()), which goes before that; without it a file of the scan's name beside the surface. None:
/// there is no such file, or nothing that it could be known by.
std::optional<ScanLink> scan_of(const TriMesh& mesh, const std::filesystem::path& surface,
                                const std::optional<ImportOptions>& given = {});

/// How the file of a raw volume is laid out, as the provenance of a surface that was made of it says; none: it was no
/// raw volume, or one whose axes lie in another order than z, y, x.
std::optional<RawSpec> raw_volume_of(std::string_view provenance);

/// The fingerprint (file_fingerprint.h) of the scan that a surface was made of, as its provenance has it; empty: none.
std::string scan_fingerprint_of(std::string_view provenance);

struct OpenedScan {
  std::unique_ptr<PlaneSampler> sampler;
  glm::dvec3 voxel_mm{1.0};
  std::string note;  ///< for people; empty: nothing
};

/// Reads headers only. kBadData: not the scan of this surface, by its size in voxels or, for one that was found by its
/// name, by its fingerprint; for one that was given the note says so. Else the importer's errors.
Result<OpenedScan> open_scan(const ScanLink& link);

}  // namespace dubsar::app
