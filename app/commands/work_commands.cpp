// Commands for the work as files: a copy of it, work from a copy, and that of a surface which this one took the place
// of.

#include <filesystem>

#include "app/commands/command_table.h"
#include "app/document/join.h"
#include "app/document/mark_file.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// Whether places on one surface are places on the other.
bool same_places(const SourceFile& a, const SourceFile& b) {
  const auto same = [](const std::string& x, const std::string& y) { return !x.empty() && x == y; };
  return same(a.content, b.content) || same(a.scan, b.scan);
}

Result<void> take(Editor& editor, const Document& other, std::string_view why, const std::string& from,
                  bool places_hold) {
  Document next = add_marks(editor.document(), other);
  const std::string more = marks_more(editor.document(), next);
  if (more.empty()) {
    editor.place().say(tr("say.nothing_new", from));
    return {};
  }
  editor.change(std::move(next), why, Transition::kGlide);
  editor.place().say(places_hold ? tr("say.taken_over", more, from) : tr("say.taken_over_doubtful", more, from));
  return {};
}

Command save_copy() {
  Command out{"save_copy", kFileGroup, {}, "arg.json"};
  out.enabled = [](const Editor& editor) { return !editor.document().parts.empty(); };
  out.run = [](Editor& editor, const std::string& path) -> Result<void> {
    const Document& mine = editor.document();
    if (const auto there = load_work(path); there && !marks_more(mine, add_marks(mine, there->document)).empty())
      return fail(ErrorKind::kUsage, "cannot write {}: notes, measures or keyframes are there that are not here", path);
    DUBSAR_TRY(write_marks(path, format_document(mine)));
    editor.place().say(tr("say.written", path));
    return {};
  };
  return out;
}

Command open_work() {
  Command out{"open_work", kFileGroup, {}, "arg.json"};
  out.enabled = [](const Editor& editor) { return !editor.document().parts.empty(); };
  out.run = [why = out.name](Editor& editor, const std::string& path) -> Result<void> {
    DUBSAR_ASSIGN(const Work work, load_work(path));
    return take(editor, work.document, why, fs::path(path).filename().string(),
                same_places(work.document.source, editor.document().source));
  };
  return out;
}

Command take_over() {
  Command out{"take_over", kFileGroup, {}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    if (editor.others().empty()) {
      editor.place().say(tr("say.no_other_work"));
      return {};
    }
    Document all;
    bool places_hold = true;
    for (const OtherWork& other : editor.others()) {
      all = add_marks(all, other.work.document);
      places_hold = places_hold && other.same_scan;
    }
    const std::string first = fs::path(editor.others().front().file).filename().string();
    return take(editor, all, why, editor.others().size() == 1 ? first : tr("say.and_others", first), places_hold);
  };
  return out;
}

}  // namespace

std::vector<Command> work_commands() {
  std::vector<Command> out;
  out.push_back(save_copy());
  out.push_back(open_work());
  out.push_back(take_over());
  return out;
}

}  // namespace dubsar::app
