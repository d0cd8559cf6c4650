#include "core/mesh_io/no_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/mesh_io/text_encoding.h"

namespace dubsar {
namespace {

constexpr std::size_t kNoMeshLooked =
    4096;  // bytes; "asset" of a glTF file may stand anywhere, but is written first or last

struct NoMeshMark {
  std::string_view begin, what, remedy;
};
constexpr std::string_view kNoMeshConvert = "export it as PLY, STL, OBJ or GLB", kNoMeshUnpack = "unpack it";
constexpr std::array kNoMeshMarks{
    NoMeshMark{"\x89HDF", "this is an HDF5 volume", "use dubsar process"},
    NoMeshMark{"PK\x03\x04", "a ZIP archive found", kNoMeshUnpack},
    NoMeshMark{"\x1F\x8B", "a file packed by gzip found", kNoMeshUnpack},
    NoMeshMark{"7z\xBC\xAF", "a 7z archive found", kNoMeshUnpack},
    NoMeshMark{"Rar!", "a RAR archive found", kNoMeshUnpack},
    NoMeshMark{"version https://git-lfs", "a pointer of Git LFS found", "fetch the file itself, by git lfs pull"},
    NoMeshMark{"\x89PNG", "a picture found", "name the mesh that it belongs to"},
    NoMeshMark{"\xFF\xD8\xFF", "a picture found", "name the mesh that it belongs to"},
    NoMeshMark{"%PDF", "a PDF document found", kNoMeshConvert},
    NoMeshMark{"ISO-10303-21", "a STEP file found", kNoMeshConvert},
    NoMeshMark{"Kaydara FBX Binary", "an FBX file found", kNoMeshConvert},
    NoMeshMark{"BLENDER", "a file of Blender found", kNoMeshConvert},
};

}  // namespace

std::optional<std::string> what_is_no_mesh(std::string_view bytes) {
  if (is_web_page(bytes)) return "a web page or another XML document found, expected a mesh; fetch the file itself";
  for (const NoMeshMark& mark : kNoMeshMarks)
    if (bytes.starts_with(mark.begin)) return fmt::format("{}, expected a mesh; {}", mark.what, mark.remedy);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || bytes[first] != '{' || !is_plain_text(bytes.substr(0, 16))) return {};
  const std::string_view end = bytes.size() > kNoMeshLooked ? bytes.substr(bytes.size() - kNoMeshLooked) : bytes;
  if (bytes.substr(0, kNoMeshLooked).find("\"asset\"") != std::string_view::npos ||
      end.find("\"asset\"") != std::string_view::npos)
    return "glTF as text (.gltf) found, expected its binary kind; export it as GLB, with all data inside";
  return "JSON found, expected a mesh; fetch the file itself";
}

bool is_plain_text(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) { return (c >= 32 && c < 127) || (c >= 9 && c <= 13); });
}

}  // namespace dubsar
