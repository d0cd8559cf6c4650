#include "app/viewer/wedge_finder.h"

#include <algorithm>
#include <utility>

#include "app/document/document_file.h"
#include "app/words/text.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar::app {
namespace {

const Part* part_to_read(const std::vector<Part>& parts, const std::string& name) {
  const auto named = [&](const std::string& wanted, bool seen) {
    const auto at = std::find_if(parts.begin(), parts.end(), [&](const Part& each) {
      return (wanted.empty() || each.name == wanted) && (!seen || each.visible);
    });
    return at == parts.end() ? nullptr : &*at;
  };
  if (!name.empty()) return named(name, false);
  const Part* const tablet = named("tablet", true);
  return tablet != nullptr ? tablet : named("", true);
}

}  // namespace

Result<void> WedgeFinder::begin(const TriMesh& mesh, const Document& document, const std::string& part) {
  const Part* const read = part_to_read(document.parts, part);
  if (read == nullptr && !part.empty()) return fail(ErrorKind::kUsage, "find_wedges: there is no part {}", part);
  auto written = std::make_shared<const TriMesh>(read == nullptr ? mesh : select_partitions(mesh, read->partitions));
  sought_ = std::make_shared<Sought>();
  sought_->part = read == nullptr ? std::string() : read->name;
  job_.begin(tr("wedge.looking"), [written, sought = sought_](Progress& progress) -> Result<void> {
    DUBSAR_ASSIGN(sought->found, find_wedges(*written, {}, progress));
    return {};
  });
  return {};
}

std::optional<std::string> WedgeFinder::ended(Editor& editor) {
  const auto done = job_.take();
  if (!done) return std::nullopt;
  if (!*done) return done->error().message;
  const std::shared_ptr<Sought> sought = std::exchange(sought_, nullptr);
  Document next = editor.document();
  take_found_wedges(next, sought->found.wedges, sought->part, sought->found.sides);
  give_ids(next);
  editor.ui().pointing.wedge = 0;
  editor.ui().pointing.wedges = true;
  editor.change(std::move(next), "find_wedges");
  return tr("wedge.found", sought->found.wedges.size());
}

}  // namespace dubsar::app
