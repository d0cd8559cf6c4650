#include "app/session/kept_history.h"

#include <utility>

#include "app/document/history_file.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

/// Of another window or session meanwhile, whose view is its own.
bool same_work(Document a, const Document& b) {
  a.now = b.now;
  a.source = b.source;
  return a == b;
}

}  // namespace

std::optional<History> kept_history(const FileSession& session, const Document& now) {
  if (!session.found() || session.history_file().empty()) return std::nullopt;
  const auto text = KeptFile(session.history_file()).read();
  if (!text || !*text) return std::nullopt;
  auto read = parse_history(**text, session.history_file().string());
  if (!read) {
    log_warning("{}", read.error().message);
    return std::nullopt;
  }
  if (!same_work(read->now(), *session.found())) return std::nullopt;
  std::array<std::vector<History::Step>, 2> steps{read->past(), read->future()};
  for (auto& each : steps)
    for (History::Step& step : each) step.other.source = now.source;  // it may have been renamed
  return History(std::move(steps[0]), now, std::move(steps[1]));
}

void keep_history(const FileSession& session, const History& history) {
  const std::filesystem::path place = session.history_file();
  if (place.empty() || !session.has_work() || !session.has_kept(history.now())) return;
  KeptFile file(place);
  const auto before = file.read();
  if (!before || (*before && !parse_history(**before, place.string()))) return;
  if (!*before && history.undo_depth() + history.redo_depth() == 0) return;
  std::error_code ignored;
  std::filesystem::create_directories(place.parent_path(), ignored);
  if (const auto done = file.write(format_history(history)); !done) log_warning("{}", done.error().message);
}

}  // namespace dubsar::app
