// The steps of a document through their file: the same documents backwards and forwards, within bounds, and no text
// however damaged is more than refused.

#include "app/document/history_file.h"

#include <gtest/gtest.h>

#include <random>

#include "app/document/document_file.h"

namespace dubsar::app {
namespace {

Document with_note(Document document, const std::string& text) {
  Note note;
  note.text = text;
  note.at_mm = {1.5, 2.25, static_cast<double>(document.notes.size())};
  document.notes.push_back(note);
  give_ids(document);
  return document;
}

History five_steps() {
  History out(Document{});
  for (int i = 0; i < 5; ++i) {
    Document next = i == 2 ? out.now() : with_note(out.now(), std::to_string(i));
    next.fog = 0.125 * i;
    if (i == 4) next.notes.erase(next.notes.begin());
    out.change(next, "step " + std::to_string(i));
  }
  out.undo();
  out.undo();
  return out;
}

TEST(HistoryFile, GivesTheSameDocumentsBackwardsAndForwards) {
  History before = five_steps();
  auto read = parse_history(format_history(before), "history");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->undo_depth(), 3U);
  ASSERT_EQ(read->redo_depth(), 2U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(read->undo_words(), before.undo_words());
    EXPECT_TRUE(read->undo() && before.undo());
    EXPECT_EQ(format_document(read->now()), format_document(before.now())) << i;
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(read->redo_words(), before.redo_words());
    EXPECT_TRUE(read->redo() && before.redo());
    EXPECT_EQ(format_document(read->now()), format_document(before.now())) << i;
  }
}

TEST(HistoryFile, KeepsTheNearestStepsWithinItsBounds) {
  History many(Document{});
  for (int i = 1; i <= 300; ++i) {
    Document next = many.now();
    next.fog = i / 300.0;
    many.change(next, "fog");
  }
  const auto read = parse_history(format_history(many), "history");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->undo_depth(), kMostKeptSteps);
  EXPECT_EQ(read->past().back().other.fog, 299 / 300.0);
  History large(with_note(Document{}, std::string(90'000, 'a')));
  for (int i = 1; i <= 200; ++i) {
    Document next = large.now();
    next.fog = i / 200.0;
    large.change(next, "fog");
  }
  const std::string text = format_history(large);
  EXPECT_LT(text.size(), 200'000U) << "a step is what it changes";
  const auto fewer = parse_history(text, "history");
  ASSERT_TRUE(fewer);
  EXPECT_LE(fewer->undo_depth(), kMostKeptBytes / 90'000);
  EXPECT_GE(fewer->undo_depth(), kMostKeptBytes / 95'000);
}

TEST(HistoryFile, EveryTruncationAndFlippedByteIsReadOrRefused) {
  const std::string text = format_history(five_steps());
  for (std::size_t size = 0; size + 1 < text.size(); size += 7)
    EXPECT_FALSE(parse_history(text.substr(0, size), "history")) << size;
  std::mt19937 random(37);
  for (int i = 0; i < 400; ++i) {
    std::string wrong = text;
    wrong[random() % wrong.size()] = static_cast<char>(random());
    static_cast<void>(parse_history(wrong, "history"));
  }
}

}  // namespace
}  // namespace dubsar::app
