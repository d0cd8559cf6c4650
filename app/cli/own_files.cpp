#include "app/cli/own_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/files/input_file.h"
#include "core/base/files/sealed_text.h"
#include "core/base/text/json_text.h"
#include "core/exa/container.h"
#include "core/hdf5/hdf5_file.h"
#include "core/image_io/tiff_file.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr std::int64_t kHead = 1 << 16, kJsonMost = 8 << 20;

/// What a file is, and whether dubsar wrote it as such.
struct Found {
  std::string what;
  FileFormat format = FileFormat::kOther;
  bool own = false;
};

std::string piece(const InputFile& file, std::int64_t at, std::int64_t most) {
  at = std::clamp<std::int64_t>(at, 0, file.size());
  return read_bytes(file, at, std::min(most, file.size() - at)).value_or(std::string());
}

bool has(std::string_view text, std::string_view words) { return text.find(words) != std::string_view::npos; }

Found tiff(const fs::path& path) {
  Found found{"a TIFF file", FileFormat::kPicture};
  auto file = TiffFile::open(path);
  const auto pages = file ? file->pages() : Result<std::vector<TiffPage>>(tl::unexpect, file.error());
  if (!pages) return found;
  const TiffPage& first = pages->front();
  found.own = first.texts.software.starts_with("dubsar");
  const bool gray = first.channels == 1 && !first.palette;
  found.what = gray && pages->size() > 1 ? fmt::format("a TIFF volume of {} slices", pages->size())
               : gray                    ? "a gray TIFF picture, as the slices of a scan are"
                                         : "a TIFF picture that dubsar did not write";
  return found;
}

bool is_phantom(const fs::path& path) {
  const auto file = Hdf5File::open(path);
  if (!file) return false;
  for (const char* object : {"/", "/truth/label"})
    if (file->string(object, "creator") == "dubsar phantom") return true;
  return false;
}

/// The text of a GLB's JSON says who wrote it.
bool is_own_glb(const InputFile& file) {
  std::array<unsigned char, 20> head{};
  if (!file.read_at(0, std::as_writable_bytes(std::span(head)))) return false;
  const std::int64_t bytes = head[12] | head[13] << 8 | head[14] << 16 | static_cast<std::int64_t>(head[15]) << 24;
  return has(piece(file, 20, std::min(bytes, kJsonMost)), R"("generator":"dubsar")");
}

constexpr std::int64_t kEditionMost = 256 << 20;

/// A drawing or table with our mark: ours as long as nobody changed it.
Found edition(const InputFile& file, std::string_view what) {
  const bool unchanged = is_sealed_text(piece(file, 0, kEditionMost));
  return {unchanged ? std::string(what) : fmt::format("{} that was changed since dubsar wrote it", what),
          FileFormat::kEdition, unchanged};
}

/// JSON that a verb wrote as its result says so; an empty object or list is no loss.
bool is_own_json(const InputFile& file) {
  const std::string text = piece(file, 0, kJsonMost);
  const auto json = parse_json(text, "");
  if (!json || file.size() > kJsonMost) return false;
  if ((json->is_object() || json->is_array()) && json->empty()) return true;
  if (!json->is_object() || !json->contains("made_by")) return false;
  if (json->contains("checksum") && !is_sealed_text(text)) return false;  // of wedges that somebody corrected
  const nlohmann::json& by = json->at("made_by");
  return by.is_string() && by.get<std::string>().starts_with("dubsar");
}

Found found_in(const InputFile& file) {
  const fs::path& path = file.path();
  const std::string head = piece(file, 0, kHead), tail = piece(file, file.size() - 64, 64);
  const auto begins = [&](std::string_view magic) { return head.starts_with(magic); };
  if (begins(kExaMagic)) return {"a surface file (EXA)", FileFormat::kExa, true};
  if (Hdf5File::has_signature(file)) return {"an HDF5 file", FileFormat::kPhantom, is_phantom(path)};
  if (begins("NRRD")) return {"a volume (NRRD)"};
  if (TiffFile::has_signature(path)) return tiff(path);
  constexpr auto kPicture = FileFormat::kPicture;
  constexpr auto kMesh = FileFormat::kMesh;
  if (begins("\x89PNG"))
    return {"a PNG picture that dubsar did not write", kPicture, has(head, std::string_view("Software\0dubsar", 15))};
  if (begins("\xff\xd8\xff"))
    return {"a JPEG picture that dubsar did not write", kPicture, has(head, "made by dubsar")};
  if (begins("ply")) return {"a PLY mesh that dubsar did not write", kMesh, has(head, "\ncomment made by dubsar")};
  if (begins("glTF")) return {"a GLB mesh that dubsar did not write", kMesh, is_own_glb(file)};
  if (begins("PK\x03\x04")) return {"an archive that dubsar did not write", kMesh, tail.ends_with("made by dubsar")};
  if (begins("dubsar STL, units ")) return {"an STL mesh", kMesh, true};
  if (begins("# made by dubsar")) return {"an OBJ mesh", kMesh, true};
  if (begins("id,side,column,line,order,kind,head_x,")) return edition(file, "a table of wedges");
  if (begins("<?xml") && has(head, "\n<!-- made by dubsar; one unit is one mm; sum_"))
    return edition(file, "a hand copy");
  if (begins("%PDF-") && has(head.substr(0, 64), "\n% made by dubsar, sum_")) return edition(file, "a hand copy");
  if (begins("%PDF-")) return {"a PDF file that dubsar did not write", FileFormat::kEdition, false};
  if (begins("999\nmade by dubsar")) return edition(file, "a hand copy");
  if (begins("{") && has(head.substr(0, head.find('\n')), R"("polled":)"))
    return {"a recording", FileFormat::kOther, true};
  const std::size_t text = head.find_first_not_of(" \t\r\n");
  if (text != std::string::npos && (head[text] == '{' || head[text] == '['))
    return {"JSON that dubsar did not write as a result", FileFormat::kJson, is_own_json(file)};
  if (begins("dubsar-recording ") || (begins("<!DOCTYPE html>") && has(head, R"(name="generator" content="dubsar)")))
    return {"a recording or report", FileFormat::kOther, true};
  return {"a file that dubsar did not write"};
}

}  // namespace

std::string what_would_be_lost(const fs::path& path, FileFormat format) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  const auto file = InputFile::open(path);
  if (!file) return "a file that cannot be read";
  if (file->size() == 0) return {};
  Found found = found_in(*file);
  if (found.own && found.format == format) return {};
  if (found.own && format == FileFormat::kPictureOrMesh &&
      (found.format == FileFormat::kPicture || found.format == FileFormat::kMesh))
    return {};
  if (found.own && format == FileFormat::kEdition && found.format == FileFormat::kJson) return {};
  if (format == FileFormat::kPhantom && found.format == FileFormat::kPhantom)
    return "an HDF5 file that no phantom made";
  if (format == FileFormat::kJson && found.what == "a file that dubsar did not write") return "no JSON";
  return found.what;
}

}  // namespace dubsar::app
