#pragma once
// An editor with two parts in a place without a window, for tests of commands.

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/commands/key_table.h"
#include "app/commands/sides.h"
#include "app/words/language.h"

namespace dubsar::app {

class FakePlace final : public Workplace {
 public:
  Result<void> switch_display(int step) override {
    display += step;
    return {};
  }
  Result<void> toggle_fullscreen() override {
    fullscreen = !fullscreen;
    return {};
  }
  Result<void> swap_eyes() override {
    swapped = !swapped;
    return {};
  }
  void recentre_heads() override { ++recentred; }
  void retry_sources() override { ++retries; }
  bool toggle_source(std::size_t index) override {
    toggled.push_back(index);
    return index < 3;
  }
  Result<void> open_file(const std::string& path) override {
    if (path == "missing.exa") return fail(ErrorKind::kNoInput, "missing.exa: there is no such file");
    opened.push_back(path);
    return {};
  }
  Result<void> open_recent(std::size_t number) override {
    opened.push_back(fmt::format("recent {}", number));
    return {};
  }
  Result<void> switch_file(int step) override {
    opened.push_back(fmt::format("step {}", step));
    return {};
  }
  std::string next_file() const override { return next; }
  bool stop_opening() override { return std::exchange(opening, false); }
  std::string present_folder() const override { return "/"; }
  std::string today() const override { return "2026-11-27"; }
  void say(std::string words) override { said = std::move(words); }
  void end() override { ended = true; }
  // A surface that is level at z = 5 of the scan, which does not show it beyond y = 40.
  Result<SurfacePin> pin(const glm::dvec3& at) override {
    return SurfacePin{{at.x, at.y, 5.0}, {0, 0, 1}, "tablet", at.x < 0 ? "reverse" : "obverse", at.y > 40.0};
  }
  Result<MeasureFigures> figures(const Measure& measure) override {
    MeasureFigures out;
    if (measure.points_mm.size() > 1) out.straight_mm = glm::distance(measure.points_mm[0], measure.points_mm[1]);
    if (measure.kind == MeasureKind::kDepth && measure.points_mm[0].x > 90)
      return fail(ErrorKind::kUsage, "depth: no surface");
    return out;
  }
  Reach reach(const glm::dvec3& direction) override { return {direction, -20, 10}; }
  Reach reach_to_viewer() override { return {{0, 1, 0}, -4, 6}; }
  Result<SurfacePin> pin_seen() override { return SurfacePin{{1, 2, 5}, {0, 0, 1}, "tablet", "obverse"}; }
  glm::dmat3 seen_axes() override { return {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}; }
  Result<void> write_slice(const std::string& path, std::size_t which) override {
    pictures.push_back(fmt::format("{} slice {}", path, which));
    return {};
  }
  Result<void> picture(const std::string& path, int factor) override {
    pictures.push_back(fmt::format("{} x{}", path, factor));
    return {};
  }
  Result<void> find_wedges(const std::string& part) override {
    if (part == "lid") return fail(ErrorKind::kUsage, "find_wedges: there is no part lid");
    sought.push_back(part);
    return {};
  }
  Result<void> publish(const std::string& kind, const std::string& path) override {
    published.push_back(kind + " " + path);
    return {};
  }
  bool stop_publishing() override { return !std::exchange(published, {}).empty(); }
  bool stop_wedges() override { return !std::exchange(sought, {}).empty(); }
  Result<void> play_film(std::optional<double> from_s) override {
    played_from_s.push_back(from_s);
    return {};
  }
  std::vector<std::string> pictures, sought, published;
  std::string next;  ///< open file
  std::vector<std::optional<double>> played_from_s;
  int display = 0, retries = 0, recentred = 0;
  bool fullscreen = false, swapped = false, ended = false;
  std::vector<std::string> opened;
  bool opening = false;
  std::vector<std::size_t> toggled;
  std::string said;
};

inline const std::vector<std::string> kStyles{"relief", "phong", "sky-sun"};

inline Document two_parts() {
  Document out;
  out.parts = {{"tablet", 1}, {"envelope", 6}};
  return out;
}

struct Bench {
  CommandTable commands = CommandTable::standard(kStyles);
  FakePlace place;
  Editor editor{two_parts(), place};
  void run(std::string_view text) {
    const auto done = commands.run(text, editor);
    EXPECT_TRUE(done) << done.error().message;
  }
  std::string refusal(std::string_view text) {
    const auto done = commands.run(text, editor);
    return done ? "accepted" : done.error().message;
  }
  const Document& now() const { return editor.document(); }
  ~Bench() { EXPECT_TRUE(use_language("en")); }
};

/// A way to say each command that needs to be told something that its table does not offer. A new command of that kind
/// belongs here, or tests that go through all of them fail.
inline std::vector<std::string> ways_to_say(const CommandTable& commands) {
  const std::vector<std::string> told{"point 3,4,5",
                                      "measure_distance 1,2,3 4,6,3 a long one",
                                      "measure_angle 1,0,0 0,0,0 0,1,0",
                                      "measure_depth 7,7,5",
                                      "measure_profile 0,0,0 9,0,0 rim",
                                      "name_measure 1 wedge \u0161",
                                      "delete_measure 1",
                                      "write_measures /nowhere/measures.json",
                                      "add_note 1,2,3 a-na \u1e2ba-x",
                                      "add_line -1,2,3 -9,2,3 um-ma",
                                      "next_line 2",
                                      "insert_line 2",
                                      "line_translation 2 thus (says)",
                                      "read_atf /nowhere/tablet.atf",
                                      "write_atf /nowhere/tablet.atf",
                                      "open_note 1",
                                      "note_text 1 other words",
                                      "note_label 1 o. 17",
                                      "go_to_note 1",
                                      "delete_note 1",
                                      "write_notes /nowhere/notes.json",
                                      "write_annotations /nowhere/notes.jsonld",
                                      "go_to_keyframe 1",
                                      "delete_keyframe 1",
                                      "replace_keyframe 2",
                                      "move_keyframe 1 2",
                                      "keyframe_seconds 1 0.75",
                                      "play 2",
                                      "write_film /nowhere/film.json",
                                      "save_copy /nowhere/work.json",
                                      "open_work /nowhere/work.json",
                                      "slice_at 1,2,3",
                                      "slice_centre 3,2,1",
                                      "write_slice /nowhere/slice.png z",
                                      "add_wedge 1,0,5 1,2,5 5,1,5",
                                      "wedge 1",
                                      "move_wedge 1 2,1,5 7,1,5",
                                      "wedge_kind 1 vertical",
                                      "wedge_line 1 4",
                                      "wedge_order 1 1",
                                      "write_wedges /nowhere/wedges.csv",
                                      "delete_wedge 1"};
  std::vector<std::string> out;
  for (const Command& command : commands.all()) {
    const std::size_t before = out.size();
    if (command.argument.empty() || command.optional) out.push_back(command.name);
    for (const std::string& value : command.values) out.push_back(command.name + " " + value);
    for (const std::string& text : told)
      if (split_command(text).first == command.name) out.push_back(text);
    EXPECT_GT(out.size(), before) << command.name << " is never said";
  }
  return out;
}

}  // namespace dubsar::app
