#include "app/document/history_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/document/document_file.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr int kHistoryVersion = 1;
constexpr std::array<const char*, 2> kDirections{"undo", "redo"};

json steps_of(const std::vector<History::Step>& steps, json state, std::size_t& bytes) {
  json out = json::array();
  for (std::size_t i = steps.size(); i-- > 0 && out.size() < kMostKeptSteps;) {
    const std::string text = format_document(steps[i].other);
    bytes += text.size();
    if (bytes > kMostKeptBytes) break;
    json next = json::parse(text);
    out.push_back({{"words", steps[i].words}, {"changes", json::diff(state, next)}});
    state = std::move(next);
  }
  return out;
}

/// None: it is not one that format_history() writes.
std::optional<Document> changed(json& state, const json& changes) {
  for (const json& change : changes)
    if (const auto& op = change.at("op"); op != "add" && op != "remove" && op != "replace") return std::nullopt;
  state = state.patch(changes);
  auto out = parse_document(state.dump(), "step");
  return out ? std::optional(*std::move(out)) : std::nullopt;
}

}  // namespace

std::string format_history(const History& history) {
  const json now = json::parse(format_document(history.now()));
  std::size_t bytes = 0;
  json out{{"format", kHistoryFormat}, {"version", kHistoryVersion}, {"now", now}};
  out[kDirections[0]] = steps_of(history.past(), now, bytes);
  out[kDirections[1]] = steps_of(history.future(), now, bytes);
  return out.dump() + "\n";
}

Result<History> parse_history(std::string_view text, std::string_view source) {
  DUBSAR_ASSIGN(const json object, parse_json(text, source, kLargestDocument));
  DUBSAR_TRY(json_version(object, kHistoryFormat, kHistoryVersion, kHistoryVersion, source));
  const auto wrong = fail(ErrorKind::kBadData, "{}: found no document with its steps, expected a history", source);
  try {
    const json& now = object.at("now");
    DUBSAR_ASSIGN(Document document, parse_document(now.dump(), source));
    std::array<std::vector<History::Step>, 2> steps;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      json state = now;
      const json& rows = object.at(kDirections[i]);
      if (!rows.is_array() || rows.size() > kMostKeptSteps) return wrong;
      for (const json& row : rows) {
        auto other = changed(state, row.at("changes"));
        bytes += state.dump().size();
        if (!other || bytes > 2 * kMostKeptBytes) return wrong;
        steps[i].push_back({*std::move(other), row.at("words").get<std::string>(), 0});
      }
      std::reverse(steps[i].begin(), steps[i].end());
    }
    return History(std::move(steps[0]), std::move(document), std::move(steps[1]));
  } catch (const json::exception&) {
    return wrong;
  }
}

}  // namespace dubsar::app
