// Commands for the work as files: a copy of it, work from a copy, and that of a surface which this one took the place
// of.

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/document/join.h"
#include "app/document/mark_file.h"
#include "core/base/files/kept_file.h"

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

/// Which of the others, counted from 0.
Result<std::size_t> other_of(const Editor& editor, const std::string& command, const std::string& number) {
  const double most = static_cast<double>(editor.others().size());
  DUBSAR_ASSIGN(const double which, number_argument(command, number, 1.0, std::max(most, 1.0)));
  return static_cast<std::size_t>(which) - 1;
}

Command take_over() {
  Command out{"take_over", kFileGroup, {}, "arg.set_aside"};
  out.values = {"1", "2", "3"};
  out.optional = true;
  out.run = [why = out.name](Editor& editor, const std::string& number) -> Result<void> {
    if (editor.others().empty()) {
      editor.place().say(tr("say.no_other_work"));
      return {};
    }
    if (!number.empty()) {
      DUBSAR_ASSIGN(const std::size_t which, other_of(editor, why, number));
      const OtherWork& other = editor.others()[which];
      return take(editor, other.work.document, why, fs::path(other.file).filename().string(), other.same_scan);
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

/// What is not as it was when it was found stays.
Result<void> delete_file(const std::string& path, const Saves& saves) {
  KeptFile file(path);
  DUBSAR_ASSIGN(const std::optional<std::string> text, file.read());
  if (!text) return {};
  const auto there = parse_work(*text, path);
  Result<Kept> done = Kept::kStranger;
  if (there && saves.contains(there->saves)) done = file.remove();
  if (!done) return tl::unexpected<Error>(done.error());
  if (*done == Kept::kDone) return {};
  return fail(ErrorKind::kUsage, "delete_work: {} was changed since it was found; it stays", path);
}

/// Of work that was set aside, once it was said twice.
Command delete_work() {
  Command out{"delete_work", kFileGroup, {}, "arg.delete_work"};
  out.values = {"1", "2", "3", "none"};
  out.run = [name = out.name](Editor& editor, const std::string& number) -> Result<void> {
    std::size_t& asked = editor.ui().choosing.deleting;
    if (number == "none") {
      asked = 0;
      return {};
    }
    if (editor.others().empty()) {
      editor.place().say(tr("say.no_other_work"));
      return {};
    }
    DUBSAR_ASSIGN(const std::size_t which, other_of(editor, name, number));
    std::vector<OtherWork> others = editor.others();
    const OtherWork& other = others[which];
    if (set_aside_day(other.file).empty())
      return fail(ErrorKind::kUsage, "delete_work: {} was not set aside, it is another surface's work", other.file);
    if (std::exchange(asked, which + 1) != which + 1) {
      editor.place().say(tr("say.delete_work", fs::path(other.file).filename().string()));
      return {};
    }
    asked = 0;
    DUBSAR_TRY(delete_file(other.file, other.work.saves));
    for (const std::string& copy : other.copies)
      if (!set_aside_day(copy).empty()) DUBSAR_TRY(delete_file(copy, other.work.saves));
    editor.place().say(tr("say.deleted_work", fs::path(other.file).filename().string()));
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
    editor.set_others(std::move(others));
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> work_commands() {
  std::vector<Command> out;
  out.push_back(save_copy());
  out.push_back(open_work());
  out.push_back(take_over());
  out.push_back(delete_work());
  return out;
}

}  // namespace dubsar::app
