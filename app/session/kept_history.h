#pragma once
// The steps of the work on a surface, kept where its work is kept by content, so that undo goes on in the next session.

#include <optional>

#include "app/document/history.h"
#include "app/session/file_session.h"

namespace dubsar::app {

/// The steps that led to the work that `session` found, and those that were undone; none where it was worked on without
/// them since, or nothing was kept. `now` takes the place of that work: the same with what this window made of it.
std::optional<History> kept_history(const FileSession& session, const Document& now);

/// Keeps them once their document is kept. What cannot be written is not missed: the work itself is there. What lies in
/// the place and is no history stays.
void keep_history(const FileSession& session, const History& history);

}  // namespace dubsar::app
