#include "app/panels/open_dialogue.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/document/file_kinds.h"
#include "app/panels/panel_kit.h"
#include "core/base/text/lower_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr float kDialogueWidth = 640.0f, kHeight = 460.0f, kOpeningWidth = 420.0f;

/// What is typed, between frames.
struct Entered {
  std::array<char, 1024> text{};
  std::size_t marked = 0;
  bool was_open = false, focus = false, scroll = false;
};
Entered& entered_now() {
  static Entered typed;
  return typed;
}

bool can_choose(const DialogueRow& row) { return !row.command.empty(); }

std::size_t next_row(const std::vector<DialogueRow>& rows, std::size_t from, int by) {
  std::size_t at = from;
  for (std::size_t tried = 0; tried < rows.size(); ++tried) {
    at = (at + rows.size() + static_cast<std::size_t>(by + static_cast<int>(rows.size()))) % rows.size();
    if (can_choose(rows[at])) return at;
  }
  return from;
}

void draw_rows(const std::vector<DialogueRow>& rows, Entered& typed, std::vector<std::string>& commands) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DialogueRow& row = rows[i];
    ImGui::PushID(static_cast<int>(i));
    if (row.heading) {
      ImGui::TextColored(ImColor(kDim), "%s", row.words.c_str());
      ImGui::PopID();
      continue;
    }
    const bool marked = i == typed.marked;
    if (can_choose(row)) {
      if (ImGui::Selectable("##row", marked)) commands.push_back(row.command);
      if (marked && std::exchange(typed.scroll, false)) ImGui::SetScrollHereY();
      ImGui::SameLine(16.0f);
    } else {
      ImGui::SetCursorPosX(16.0f);
    }
    ImGui::TextColored(ImColor(!can_choose(row) ? kDim : marked ? kAccent : kText), "%s", row.words.c_str());
    if (!row.detail.empty()) {
      const float right = ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(row.detail.c_str()).x - 4.0f;
      ImGui::SameLine(std::max(right, 16.0f + ImGui::CalcTextSize(row.words.c_str()).x + 16.0f));
      ImGui::TextColored(ImColor(kDim), "%s", row.detail.c_str());
    }
    ImGui::PopID();
  }
}

}  // namespace

std::vector<DialogueRow> dialogue_rows(const FilesState& files, std::string_view typed) {
  std::vector<DialogueRow> out;
  const std::string_view open = files.beside ? "set_beside" : "open";
  const std::string wanted = lower_text(typed);
  const auto fits = [&](const std::string& name) { return lower_text(name).find(wanted) != std::string::npos; };
  if (typed.find('/') != std::string_view::npos || typed == "..") {
    const bool surface = names_a_surface(fs::path(typed));
    out.push_back({std::string(typed), surface ? tr("files.open") : tr("files.folder"),
                   fmt::format("{} {}", surface ? open : "open_folder", typed), false, !surface});
    return out;
  }
  std::vector<DialogueRow> recent;
  for (std::size_t i = 0; i < files.recent.size(); ++i) {
    const RecentFile& file = files.recent[i];
    const fs::path path(file.path);
    if (!fits(path.filename().string())) continue;
    recent.push_back({path.filename().string(), file.there ? path.parent_path().string() : tr("files.gone"),
                      !file.there    ? std::string()
                      : files.beside ? fmt::format("{} {}", open, file.path)
                                     : fmt::format("open_recent {}", i + 1)});
  }
  if (!recent.empty()) out.push_back({tr("files.last"), {}, {}, true});
  out.insert(out.end(), recent.begin(), recent.end());
  if (!files.listing) return out;
  const FolderListing& listing = *files.listing;
  out.push_back({listing.folder, {}, {}, true});
  if (!listing.problem.empty()) out.push_back({listing.problem, {}, {}, true});
  if (typed.empty() && listing.folder != "/") out.push_back({"..", tr("files.above"), "open_folder ..", false, true});
  bool any = false;
  for (const FolderEntry& entry : listing.entries) {
    if (!fits(entry.name)) continue;
    any = true;
    const std::string path = (fs::path(listing.folder) / entry.name).string();
    out.push_back({entry.folder ? entry.name + "/" : entry.name, entry.folder ? "" : size_words(entry.bytes),
                   fmt::format("{} {}", entry.folder ? "open_folder" : open, path), false, entry.folder});
  }
  if (!any && listing.problem.empty())
    out.push_back({typed.empty() ? tr("files.none") : tr("files.no_name"), {}, {}, true});
  return out;
}

std::string title_words(const std::string& shown, const std::optional<JobState>& opening) {
  if (!opening) return shown;
  const std::string reading = opening_words({opening->name, opening->share, {}});
  return shown.empty() ? reading : shown + ", " + reading;
}

std::string opening_words(const JobState& opening) {
  std::string out = opening.share > 0
                        ? tr("files.reading_share", opening.name, fmt::format("{:.0f}", 100.0 * opening.share))
                        : tr("files.reading", opening.name);
  if (opening.remaining_s) out += ", " + tr("files.to_go", duration_words(*opening.remaining_s));
  return out;
}

void draw_open_dialogue(bool open, const FilesState& files, float width, float height,
                        std::vector<std::string>& commands) {
  Entered& typed = entered_now();
  const bool fresh = open && !typed.was_open;
  typed.was_open = open;
  if (!open) return;
  const std::string folder = files.listing ? files.listing->folder : std::string();
  static std::string last_folder;
  if (fresh || folder != last_folder) typed = {{}, 0, true, true, true};
  last_folder = folder;
  ImGui::SetNextWindowPos(ImVec2(0.5f * width, kTopLine + kGap), ImGuiCond_Always, ImVec2(0.5f, 0.0f));
  ImGui::SetNextWindowSize(
      ImVec2(std::min(kDialogueWidth, width - 24.0f), std::min(kHeight, height - kTopLine - kStrip - 16.0f)));
  ImGui::Begin("open", nullptr, (kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus));
  ImGui::TextColored(ImColor(kAccent), "%s", (files.beside ? tr("files.beside") : tr("files.title")).c_str());
  next_in_row(ImGui::CalcTextSize(tr("files.kinds").c_str()).x);
  say_fitted(kDim, tr("files.kinds"), ImGui::GetContentRegionAvail().x);
  ImGui::SetNextItemWidth(-1.0f);
  if (std::exchange(typed.focus, false)) ImGui::SetKeyboardFocusHere();
  const bool entered = ImGui::InputTextWithHint("##typed", tr("files.field").c_str(), typed.text.data(),
                                                typed.text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  const bool edited = ImGui::IsItemEdited();
  const std::vector<DialogueRow> rows = dialogue_rows(files, typed.text.data());
  if (edited) typed.marked = 0;
  if (!rows.empty()) {
    typed.marked = std::min(typed.marked, rows.size() - 1);
    if (!can_choose(rows[typed.marked])) typed.marked = next_row(rows, typed.marked, 1);
    for (const auto& [key, by] : {std::pair{ImGuiKey_DownArrow, 1}, std::pair{ImGuiKey_UpArrow, -1}})
      if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(key))) {
        typed.marked = next_row(rows, typed.marked, by);
        typed.scroll = true;
      }
  }
  ImGui::BeginChild("rows");
  draw_rows(rows, typed, commands);
  ImGui::EndChild();
  if (entered && !rows.empty() && can_choose(rows[typed.marked])) commands.push_back(rows[typed.marked].command);
  if (entered) typed.focus = true;
  ImGui::End();
}

void draw_opening(const FilesState& files, float width, float height, std::vector<std::string>& commands) {
  if (!files.opening) return;
  ImGui::SetNextWindowPos(ImVec2(0.5f * width, height - kStrip - kGap), ImGuiCond_Always, ImVec2(0.5f, 1.0f));
  ImGui::SetNextWindowSize(ImVec2(std::min(kOpeningWidth, width - 24.0f), 0.0f));
  ImGui::Begin("opening", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(opening_words(*files.opening).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, kAccent);
  ImGui::ProgressBar(static_cast<float>(files.opening->share), ImVec2(-button_width(tr("files.stop")), 6.0f), "");
  ImGui::PopStyleColor();
  ImGui::SameLine();
  if (ImGui::Button(tr("files.stop").c_str())) commands.emplace_back("stop_opening");
  ImGui::End();
}

}  // namespace dubsar::app
