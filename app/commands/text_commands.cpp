// Commands for the text of a tablet: its lines, the record of the tablet, and transliterations in ATF.

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/document/document_file.h"
#include "app/document/text_lines.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/base/files/kept_file.h"
#include "core/edition/brackets.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr Text kTextGroup = "group.text", kRecordGroup = "group.tablet";
constexpr int kPatchPlaces = 9;  // of a line that are looked at: a patch of a tenth of it is seen

bool has_lines(const Editor& editor) {
  const auto& notes = editor.document().notes;
  return std::any_of(notes.begin(), notes.end(), is_text_line);
}

/// The number of a line among the notes.
Result<std::size_t> line_argument(std::string_view what, const std::string& text, const Document& document) {
  DUBSAR_ASSIGN(const std::size_t at, place_argument(what, text, document.notes.size()));
  if (!is_text_line(document.notes[at]))
    return fail(ErrorKind::kUsage, "{}: note {} is a pin; expected one that runs along a line of the text", what,
                at + 1);
  return at;
}

/// A new line below another, or half-way to the one above it.
Command beside(std::string name, double share) {
  Command out{std::move(name), kTextGroup, {}, "arg.number"};
  out.enabled = has_lines;
  out.run = [share, what = out.name](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const std::size_t at, line_argument(what, text, editor.document()));
    std::vector<SurfacePin> ends;
    for (const glm::dvec3& end : place_beside(editor.document(), at, share)) {
      DUBSAR_ASSIGN(SurfacePin pin, editor.place().pin(end));
      ends.push_back(std::move(pin));
    }
    add_text_line(editor, ends, {});
    ++editor.ui().pointing.notes;
    return {};
  };
  return out;
}

Command translation() {
  Command out{"line_translation", kTextGroup, {}, "arg.number_text"};
  out.enabled = has_lines;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const auto [number, rest] = first_word(text);
    DUBSAR_ASSIGN(const std::size_t at, line_argument("line_translation", number, editor.document()));
    Document next = editor.document();
    next.notes[at].translation = rest;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// "12 lines read, 3 of them pinned already; 9 wait".
std::string what_was_read(const AtfTaken& taken, const AtfFile& text) {
  std::string out = tr("atf.read", taken.lines, taken.pinned);
  if (taken.lines > taken.pinned) out += "; " + tr("atf.wait", taken.lines - taken.pinned);
  std::vector<AtfFault> faults = check_atf(text);
  std::erase_if(faults, [](const AtfFault& fault) { return fault.only_warning; });
  if (!faults.empty())
    out += "; " + tr("atf.faults", faults.size(), faults[0].line, faults[0].column, faults[0].message);
  return out;
}

Command read_atf_file() {
  Command out{"read_atf", kTextGroup, {}, "arg.atf"};
  out.run = [why = out.name](Editor& editor, const std::string& path) -> Result<void> {
    DUBSAR_ASSIGN(const std::string bytes, read_text_file(path, KeptFile::kLargest));
    DUBSAR_ASSIGN(const AtfFile text,
                  text_of_atf(read_atf(bytes), editor.document().edition.record, fs::path(path).filename().string()));
    Document next = editor.document();
    const AtfTaken taken = take_atf(next, text);
    editor.change(std::move(next), why, Transition::kGlide);
    editor.place().say(what_was_read(taken, text));
    return {};
  };
  return out;
}

/// The texts of a file, by their numbers; none of what is no ATF.
std::vector<std::string> texts_of(std::string_view bytes) {
  std::vector<std::string> out;
  for (const AtfLine& line : read_atf(bytes).lines)
    if (line.kind == AtfKind::kText) out.push_back(line.key);
  return out;
}

Result<void> write_text(const std::string& path, const std::string& text) {
  if (lower_suffix(path) != ".atf")
    return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .atf", path);
  KeptFile file{fs::path(path)};
  DUBSAR_ASSIGN(const std::optional<std::string> before, file.read());
  const auto other = [&](std::string_view what) {
    return fail(ErrorKind::kUsage, "cannot write {}: {} is there; give another name", path, what);
  };
  if (before && !before->empty()) {
    const std::vector<std::string> there = texts_of(*before), here = texts_of(text);
    if (there.empty()) return other("something else");
    if (there.size() > 1) return other(fmt::format("a file of {} texts", there.size()));
    if (there != here) return other("another text, " + there[0] + ",");
  }
  DUBSAR_ASSIGN(const Kept done, file.write(text));
  if (done == Kept::kStranger) return other("something else");
  return {};
}

Command write_atf_file() {
  Command out{"write_atf", kTextGroup, {}, "arg.atf"};
  out.run = [](Editor& editor, const std::string& path) -> Result<void> {
    const Document& document = editor.document();
    DUBSAR_TRY(write_text(path, write_atf(atf_of(document))));
    const auto unnumbered = std::count_if(document.notes.begin(), document.notes.end(), [](const Note& note) {
      return is_text_line(note) && (!spot_of(note) || note.text.empty());
    });
    editor.place().say(tr("say.written", path) + (unnumbered > 0 ? "; " + tr("atf.left_out", unnumbered) : ""));
    return {};
  };
  return out;
}

Command forget_atf() {
  Command out{"forget_atf", kTextGroup, {}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    if (editor.document().edition.atf.empty()) {
      editor.place().say(tr("atf.none"));
      return {};
    }
    Document next = editor.document();
    next.edition.atf.clear();
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// One member of the record; nothing after it takes it away.
Command say_of_tablet(std::string name, Text argument, std::string TabletRecord::*member,
                      Result<std::string> (*checked)(std::string_view) = nullptr) {
  Command out{std::move(name), kRecordGroup, {}, argument};
  out.optional = true;
  out.run = [member, checked, what = out.name](Editor& editor, const std::string& text) -> Result<void> {
    std::string value = text;
    if (checked != nullptr && !text.empty()) {
      auto written = checked(text);
      if (!written) return fail(ErrorKind::kUsage, "{}: {}", what, written.error().message);
      value = *std::move(written);
    }
    Document next = editor.document();
    next.edition.record.*member = value;
    editor.change(std::move(next), what);
    return {};
  };
  return out;
}

}  // namespace

void warn_of_patch(Editor& editor, const Note& line) {
  if (!is_text_line(line) || tells_damage(line.text) || line.text.empty()) return;
  const auto& way = line.line_mm;
  int inferred = 0;
  for (int k = 0; k < kPatchPlaces; ++k) {
    const double at = (k + 0.5) / kPatchPlaces * static_cast<double>(way.size() - 1);
    const auto first = std::min(static_cast<std::size_t>(at), way.size() - 2);
    const auto pin = editor.place().pin(glm::mix(way[first], way[first + 1], at - static_cast<double>(first)));
    if (pin && pin->inferred) ++inferred;
  }
  if (inferred == 0) return;
  editor.place().say(tr("atf.patch", 100 * inferred / kPatchPlaces, line.label));
}

void add_text_line(Editor& editor, const std::vector<SurfacePin>& ends, std::string text) {
  Document next = editor.document();
  Note note;
  note.part = ends.front().part;
  note.text = std::move(text);
  note.at_mm = ends.front().at_mm;
  note.normal = ends.front().normal;
  Measure way{MeasureKind::kDistance, {}, note.part, {}, {}};  // along the surface, where it leads there
  for (const SurfacePin& end : ends) way.points_mm.push_back(end.at_mm);
  const auto found = editor.place().figures(way);
  note.line_mm = found && found->path_mm.size() > 1 ? found->path_mm : way.points_mm;
  note.camera = next.now;
  note.created = editor.place().today();
  put_line(next, std::move(note), ends.front().side);
  give_ids(next);
  const Note line = next.notes.back();
  editor.change(std::move(next), "line of text");
  editor.ui().note = editor.document().notes.size();
  editor.ui().drawer = "notes";
  warn_of_patch(editor, line);
}

std::vector<Command> text_commands() {
  std::vector<Command> out;
  out.push_back(beside("next_line", 1.0));
  out.push_back(beside("insert_line", -0.5));
  out.push_back(translation());
  out.push_back(read_atf_file());
  out.push_back(write_atf_file());
  out.push_back(forget_atf());
  out.push_back(say_of_tablet("museum_number", "arg.museum_number", &TabletRecord::museum_number));
  out.push_back(say_of_tablet("p_number", "arg.p_number", &TabletRecord::p_number, catalogue_number));
  out.push_back(say_of_tablet("title", "arg.text", &TabletRecord::title));
  out.push_back(say_of_tablet("institution", "arg.name", &TabletRecord::institution));
  out.push_back(say_of_tablet("rights", "arg.text", &TabletRecord::rights));
  out.push_back(say_of_tablet("creator", "arg.name", &TabletRecord::creator));
  out.push_back(say_of_tablet("language", "arg.language", &TabletRecord::language, language_tag));
  out.push_back(say_of_tablet("translated", "arg.translated", &TabletRecord::translated, language_tag));
  return out;
}

}  // namespace dubsar::app
