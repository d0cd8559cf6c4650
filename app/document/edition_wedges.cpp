#include "app/document/edition_wedges.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "app/document/document.h"
#include "core/script/correction/wedge_edits.h"

namespace dubsar::app {
namespace {

constexpr double kSameWedge = 0.5;  // widths between heads

bool of_person(const MarkedWedge& marked) { return marked.deleted || marked.wedge.by != WedgeBy::kMachine; }

bool same_place(const ScriptWedge& a, const ScriptWedge& b) {
  const double near = kSameWedge * std::max(a.width_mm, b.width_mm);
  return glm::distance(a.head_mm, b.head_mm) < near || glm::distance(a.tip_mm, b.tip_mm) < 0.5 * near;
}

}  // namespace

std::vector<std::size_t> places_of_wedges(const Document& document) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < document.edition.wedges.size(); ++k)
    if (!document.edition.wedges[k].deleted) out.push_back(k);
  return out;
}

std::vector<ScriptWedge> wedges_of(const Document& document) {
  std::vector<ScriptWedge> out;
  for (const MarkedWedge& marked : document.edition.wedges)
    if (!marked.deleted) out.push_back(marked.wedge);
  return out;
}

void number_wedges(Document& document) {
  std::vector<ScriptWedge> shown = wedges_of(document);
  number_in_order(shown);
  std::size_t next = 0;
  for (MarkedWedge& marked : document.edition.wedges) {
    if (!marked.deleted) marked.wedge = std::move(shown[next++]);
    if (marked.deleted) marked.wedge.order = 0;
  }
}

std::size_t insert_wedge(Document& document, MarkedWedge wedge, const TextSides& sides) {
  auto& all = document.edition.wedges;
  auto nearest = all.end();
  double least = 0.0;
  for (auto at = all.begin(); at != all.end(); ++at) {
    if (at->deleted || at->part != wedge.part || at->wedge.side != wedge.wedge.side) continue;
    const double away = glm::distance(at->wedge.head_mm, wedge.wedge.head_mm);
    if (nearest != all.end() && away >= least) continue;
    nearest = at;
    least = away;
  }
  auto place = all.end();
  wedge.wedge.order = 0;
  if (nearest != all.end()) {
    const ScriptWedge& beside = nearest->wedge;
    wedge.wedge.line = beside.line;
    wedge.wedge.column = beside.column;
    const glm::dvec3 right = sides.right_of(beside.side);
    const double along = glm::dot(wedge.wedge.head_mm, right);
    const auto behind = [&](const MarkedWedge& each) {
      return !each.deleted && each.part == wedge.part && each.wedge.side == beside.side &&
             each.wedge.line == beside.line && glm::dot(each.wedge.head_mm, right) > along;
    };
    place = std::find_if(all.begin(), all.end(), behind);
    if (place == all.end()) {  // the last of its line
      const int line = beside.line;
      const TextSide side = beside.side;
      for (auto at = all.begin(); at != all.end(); ++at)
        if (!at->deleted && at->part == wedge.part && at->wedge.side == side && at->wedge.line == line) place = at + 1;
    }
  }
  const auto at = all.insert(place, std::move(wedge));
  const auto number = static_cast<std::size_t>(
      std::count_if(all.begin(), at, [](const MarkedWedge& each) { return !each.deleted; }) + 1);
  number_wedges(document);
  return number;
}

void take_found_wedges(Document& document, const std::vector<ScriptWedge>& found, const std::string& part,
                       const TextSides& sides) {
  std::vector<MarkedWedge> kept, others;
  for (MarkedWedge& marked : document.edition.wedges) {
    if (marked.part != part)
      others.push_back(std::move(marked));
    else if (of_person(marked))
      kept.push_back(std::move(marked));
  }
  document.edition.wedges.clear();
  for (const ScriptWedge& wedge : found) {
    const bool known =
        std::any_of(kept.begin(), kept.end(), [&](const MarkedWedge& each) { return same_place(each.wedge, wedge); });
    if (!known) document.edition.wedges.push_back({wedge, part});
  }
  for (MarkedWedge& marked : kept) {
    if (marked.deleted)
      document.edition.wedges.push_back(std::move(marked));
    else
      insert_wedge(document, std::move(marked), sides);
  }
  document.edition.wedges.insert(document.edition.wedges.end(), std::make_move_iterator(others.begin()),
                                 std::make_move_iterator(others.end()));
  number_wedges(document);
}

}  // namespace dubsar::app
