#include "app/viewer/kept_work.h"

#include <utility>

#include "app/document/join.h"
#include "app/session/kept_history.h"
#include "app/words/text.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

/// By which a file is known again in this window; empty: not at all.
std::string file_key(const Document& document) {
  const SourceFile& source = document.source;
  return source.content.empty() ? std::string() : source.path + "\n" + source.content;
}

}  // namespace

Result<void> KeptWork::leave_session(Editor& editor) {
  if (!session_) return {};
  DUBSAR_ASSIGN(Document kept, session_->leave(editor.document()));
  if (kept != editor.document()) editor.join(std::move(kept));
  keep_history(*session_, editor.history());
  return {};
}

Result<void> KeptWork::leave_all(Editor* editor) {
  Result<void> out;
  if (editor != nullptr) out = leave_session(*editor);
  for (auto& [key, left] : left_)
    if (left.session)
      if (const auto done = left.session->leave(left.history.now()); !done && out)
        out = tl::unexpected<Error>(done.error());
  return out;
}

void KeptWork::leave(Editor& editor) {
  constexpr std::size_t kMostLeft = 8;  // each has up to a thousand states of its document
  if (const auto done = leave_session(editor); !done) {
    log_warning("{}", done.error().message);
    untold_ = tr("say.in_memory", done.error().message);
  }
  const std::string key = file_key(editor.document());
  if (key.empty()) return;
  left_.insert_or_assign(key, Left{std::move(session_), editor.opened(), editor.history()});
  for (auto at = left_.begin(); left_.size() > kMostLeft && at != left_.end();) {
    const Left& left = at->second;
    const bool can_go = at->first != key && (!left.session || left.session->has_kept(left.history.now()));
    at = can_go ? left_.erase(at) : std::next(at);
  }
}

bool KeptWork::keep(Editor& editor, TimestampNs now) {
  if (!session_) return false;
  auto kept = session_->keep(now, editor.document());
  const std::string wrong = kept ? std::string() : kept.error().message;
  if (!wrong.empty() && wrong != untold_) {
    log_warning("{}", wrong);
    say_(tr("say.copy_elsewhere", wrong));
  }
  if (!kept)
    untold_ = wrong;
  else if (session_->has_kept(editor.document()))
    untold_.clear();
  const bool joined = kept && *kept;
  if (joined) {
    Document both = **std::move(kept);
    both.now = editor.document().now;
    editor.join(std::move(both));
  }
  tell({});
  return joined;
}

std::vector<std::string> KeptWork::log_told() {
  std::vector<std::string> out = session_ ? session_->take_told() : std::vector<std::string>();
  for (const std::string& sentence : out) log_warning("{}", sentence);
  return out;
}

void KeptWork::tell(std::string otherwise) {
  const std::vector<std::string> told = log_told();
  std::string words = told.empty() ? std::move(otherwise) : told.front();
  if (!words.empty()) say_(std::move(words));
}

bool KeptWork::may_end(Editor* editor) {
  const auto done = leave_all(editor);
  if (done || std::exchange(asked_, true)) return true;
  log_warning("{}", done.error().message);
  say_(tr("say.end_without", done.error().message));
  return false;
}

std::unique_ptr<Editor> KeptWork::begin(Document found, std::unique_ptr<FileSession> session, const MakeEditor& make) {
  session_ = std::move(session);
  auto before = session_ ? kept_history(*session_, found) : std::nullopt;
  auto editor = make(before ? *std::move(before) : History(found), found);
  if (session_) session_->begin(editor->document());
  const std::string key = file_key(editor->document());
  if (const auto left = left_.find(key); left != left_.end() && !key.empty()) {
    editor = make(std::move(left->second.history), std::move(left->second.opened));
    if (left->second.session) session_ = std::move(left->second.session);
    left_.erase(left);
    if (session_)
      if (auto joined = session_->look(editor->document())) editor->join(*std::move(joined));
  }
  if (session_) editor->set_others(session_->others());
  return editor;
}

void KeptWork::say_what_was_found(const Editor& editor, std::string first) {
  Document all;
  for (const OtherWork& other : editor.others()) all = add_marks(all, other.work.document);
  if (const std::string more = marks_more(editor.document(), add_marks(editor.document(), all)); !more.empty())
    first = tr("say.found", more);
  if (!untold_.empty()) first = untold_;
  tell(std::move(first));
}

}  // namespace dubsar::app
