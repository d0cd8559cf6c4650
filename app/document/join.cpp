#include "app/document/join.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/document/document_fields.h"
#include "app/document/document_file.h"
#include "app/words/text.h"
#include "core/base/files/file_fingerprint.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr double kPauseS = 1.0;  // between two films that become one

template <class Thing>
const Thing* find(const std::vector<Thing>* things, const std::string& id) {
  if (things == nullptr) return nullptr;
  const auto at = std::find_if(things->begin(), things->end(), [&](const Thing& thing) { return thing.id == id; });
  return at == things->end() ? nullptr : &*at;
}

json json_of(auto value) {
  stored::Writer writer;
  fields(writer, value);
  return writer.take();
}

/// Where a wedge stands among the others is no part of it: one that goes changes the numbers of all behind it.
json json_of(MarkedWedge value) {
  value.wedge.order = 0;
  stored::Writer writer;
  fields(writer, value);
  return writer.take();
}

/// As it is in files, where places have three digits.
bool same(const auto& a, const auto& b) { return a == b || json_of(a) == json_of(b); }

/// Two forms of what both changed, whichever side asks: the first keeps the id, the other one's is made of what it is.
template <class Thing>
std::pair<Thing, Thing> two_forms(Thing a, Thing b) {
  const auto text_of = [](const Thing& thing) {
    return json_of(thing).dump(-1, ' ', true, json::error_handler_t::replace);
  };
  if (text_of(b) < text_of(a)) std::swap(a, b);
  b.id = bytes_checksum(text_of(b));
  return {std::move(a), std::move(b)};
}

template <class Thing>
std::vector<Thing> join_things(const std::vector<Thing>* base, const std::vector<Thing>& mine,
                               const std::vector<Thing>& theirs) {
  std::vector<Thing> out, forms;
  for (const Thing& thing : mine) {
    const Thing* const other = find(&theirs, thing.id);
    const Thing* const before = find(base, thing.id);
    const bool mine_as_before = before != nullptr && same(thing, *before);
    if (other == nullptr) {
      if (!mine_as_before) out.push_back(thing);  // else they took it away
      continue;
    }
    out.push_back(mine_as_before ? *other : thing);
    if (mine_as_before || same(thing, *other) || (before != nullptr && same(*other, *before))) continue;
    auto [first, second] = two_forms(thing, *other);
    out.back() = std::move(first);
    forms.push_back(std::move(second));
  }
  for (const Thing& thing : theirs) {
    const Thing* const before = find(base, thing.id);
    const bool taken_away = before != nullptr && same(thing, *before);
    if (find(&mine, thing.id) == nullptr && !taken_away) out.push_back(thing);
  }
  for (Thing& form : forms)
    if (find(&out, form.id) == nullptr) out.push_back(std::move(form));
  return out;
}

/// What is said of the tablet, without its wedges.
TabletEdition said_of(TabletEdition edition) {
  edition.wedges.clear();
  return edition;
}

bool same_look(const Keyframe& a, Keyframe b) {
  b.time_s = a.time_s;
  return same(a, b);
}

bool has_look(const std::vector<Keyframe>& keys, const Keyframe& key) {
  return std::any_of(keys.begin(), keys.end(), [&](const Keyframe& each) { return same_look(each, key); });
}

bool same_film(const std::vector<Keyframe>& a, const std::vector<Keyframe>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Keyframe& x, const Keyframe& y) { return same(x, y); });
}

std::vector<Keyframe> join_films(const std::vector<Keyframe>& base, std::vector<Keyframe> mine,
                                 const std::vector<Keyframe>& theirs) {
  if (same_film(mine, base)) return theirs;
  if (same_film(theirs, base)) return mine;
  double shift_s = 0.0;
  bool first = true;
  const std::vector<Keyframe> before = mine;
  for (const Keyframe& key : theirs) {
    if (has_look(base, key) || has_look(before, key)) continue;
    if (std::exchange(first, false)) shift_s = mine.empty() ? 0.0 : mine.back().time_s + kPauseS - key.time_s;
    mine.push_back(key);
    mine.back().time_s += shift_s;
  }
  return mine;
}

/// What of the document is a list of things, or this window's own.
bool is_joined_otherwise(const std::string& member) {
  return member == "notes" || member == "measures" || member == "wedges" || member == "keyframes" || member == "now" ||
         member == "source";
}

template <class Thing>
std::size_t more(const std::vector<Thing>& before, const std::vector<Thing>& after) {
  return static_cast<std::size_t>(std::count_if(after.begin(), after.end(), [&](const Thing& thing) {
    const Thing* const known = find(&before, thing.id);
    return known == nullptr || !same(*known, thing);
  }));
}

}  // namespace

Document join_marks(const Document* base, const Document& mine, const Document& theirs) {
  Document out = mine;
  out.notes = join_things(base != nullptr ? &base->notes : nullptr, mine.notes, theirs.notes);
  out.measures = join_things(base != nullptr ? &base->measures : nullptr, mine.measures, theirs.measures);
  if (base == nullptr && said_of(out.edition) == TabletEdition{}) out.edition = theirs.edition;
  out.edition.wedges =
      join_things(base != nullptr ? &base->edition.wedges : nullptr, mine.edition.wedges, theirs.edition.wedges);
  number_wedges(out);
  out.keyframes =
      join_films(base != nullptr ? base->keyframes : std::vector<Keyframe>(), mine.keyframes, theirs.keyframes);
  return out;
}

Document join(const Document* base, const Document& mine, const Document& theirs) {
  Document out = mine;
  if (base != nullptr) {
    const json was = json_of(*base), other = json_of(theirs);
    json now = json_of(mine);
    for (auto& [member, value] : now.items())
      if (!is_joined_otherwise(member) && value == was.at(member)) value = other.at(member);
    std::string complaint;  // none: each member is one of a document
    stored::Reader reader(now, "", complaint);
    fields(reader, out);
    out.source = mine.source;
    out.now = mine.now;
  }
  const Document marks = join_marks(base, mine, theirs);
  out.notes = marks.notes;
  out.measures = marks.measures;
  out.edition.wedges = marks.edition.wedges;
  out.keyframes = marks.keyframes;
  return out;
}

Document add_marks(const Document& mine, const Document& theirs) { return join_marks(nullptr, mine, theirs); }

std::string marks_more(const Document& before, const Document& after) {
  const std::size_t notes = more(before.notes, after.notes), measures = more(before.measures, after.measures);
  const auto keyframes = std::count_if(after.keyframes.begin(), after.keyframes.end(),
                                       [&](const Keyframe& key) { return !has_look(before.keyframes, key); });
  std::string out;
  const auto add = [&](const std::string& words) { out += (out.empty() ? "" : ", ") + words; };
  if (notes > 0) add(tr("marks.notes", notes));
  if (measures > 0) add(tr("marks.measures", measures));
  if (keyframes > 0) add(tr("marks.keyframes", keyframes));
  if (const std::size_t wedges = more(before.edition.wedges, after.edition.wedges); wedges > 0)
    add(tr("marks.wedges", wedges));
  if (said_of(before.edition) == TabletEdition{} && said_of(after.edition) != TabletEdition{}) add(tr("marks.edition"));
  return out;
}

}  // namespace dubsar::app
