#include "app/verbs/work_of_surface.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "app/cli/config_folder.h"
#include "app/document/text_lines.h"
#include "app/session/file_session.h"
#include "app/slices/scan_link.h"
#include "core/base/files/file_fingerprint.h"
#include "core/edition/line_number.h"

namespace dubsar::app {

Result<SourceFile> source_of(const std::string& file, const TriMesh& mesh) {
  std::error_code error;
  SourceFile out{std::filesystem::absolute(file, error).string(), 0};
  out.bytes = static_cast<std::int64_t>(std::filesystem::file_size(file, error));
  DUBSAR_ASSIGN(out.content, file_checksum(file));
  out.scan = scan_fingerprint_of(mesh.provenance);
  return out;
}

Result<Document> kept_work(const std::string& file, const TriMesh& mesh) {
  DUBSAR_ASSIGN(SourceFile source, source_of(file, mesh));
  Document out;
  out.source = source;
  const FileSession session(std::move(source), session_folder());
  return session.found() ? *session.found() : out;
}

std::vector<std::string> text_rows(const Document& document) {
  std::vector<std::string> out;
  std::string heading;
  for (const TextPassage& line : passages_of(document)) {
    std::string side = line.spot.surface;
    if (side == "bottom") side = "lower edge";
    if (side == "top") side = "upper edge";
    if (side == "left" || side == "right") side += " edge";
    if (line.spot.object != "tablet") side = line.spot.object + ", " + side;
    if (line.spot.column > 0) side += ", column " + roman_number(line.spot.column);
    if (side != heading) {
      if (!out.empty()) out.emplace_back();
      out.push_back(side);
      heading = side;
    }
    out.push_back(fmt::format("{}  {}", line.spot.number, line.text));
  }
  return out;
}

}  // namespace dubsar::app
