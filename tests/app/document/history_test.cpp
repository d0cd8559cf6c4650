#include "app/document/history.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {

Document zoomed(double zoom) {
  Document out;
  out.now.zoom = zoom;
  return out;
}

TEST(History, GoesBackAndForthThroughEveryState) {
  History history(zoomed(1));
  for (int i = 2; i <= 200; ++i) history.change(zoomed(i), "zoom");
  for (int i = 199; i >= 1; --i) {
    ASSERT_TRUE(history.undo());
    ASSERT_EQ(history.now(), zoomed(i));
  }
  EXPECT_FALSE(history.undo());
  for (int i = 2; i <= 200; ++i) {
    ASSERT_TRUE(history.redo());
    ASSERT_EQ(history.now(), zoomed(i));
  }
  EXPECT_FALSE(history.redo());
}

TEST(History, WhatSomebodyElseChangedIsNoStepAndStaysThroughUndoAndRedo) {
  const auto noted = [](double zoom, bool theirs) {
    Document out = zoomed(zoom);
    if (theirs) out.notes.emplace_back().text = "theirs";
    return out;
  };
  History history(noted(1, false));
  for (int i = 2; i <= 5; ++i) history.change(noted(i, false), "zoom");
  history.undo();
  history.change_all(noted(4, true), [](const Document& state) {
    Document with = state;
    with.notes.emplace_back().text = "theirs";
    return with;
  });
  EXPECT_EQ(history.undo_depth(), 3u);
  for (int i = 4; i >= 2; --i) {
    EXPECT_EQ(history.now(), noted(i, true));
    ASSERT_TRUE(history.undo());
  }
  EXPECT_EQ(history.now(), noted(1, true));
  while (history.redo()) {
  }
  EXPECT_EQ(history.now(), noted(5, true));
}

TEST(History, WhatBelongsTogetherIsOneStepAndUndoneAsOne) {
  History history(zoomed(1));
  for (int i = 2; i < 100; ++i) history.change(zoomed(i), "turn", 7);
  history.change(zoomed(100), "turn", 8);
  EXPECT_EQ(history.undo_depth(), 2u);
  history.undo();
  EXPECT_EQ(history.now(), zoomed(99));
  history.undo();
  EXPECT_EQ(history.now(), zoomed(1));
  history.redo();
  history.change(zoomed(5), "turn", 7);  // the drag that was undone and done again has ended
  EXPECT_EQ(history.undo_depth(), 2u);
}

TEST(History, NothingIsNoStepNeitherIsThereAndBackInOneDrag) {
  History history(zoomed(1));
  history.change(zoomed(1), "nothing");
  EXPECT_EQ(history.undo_depth(), 0u);
  history.change(zoomed(2), "turn", 3);
  history.change(zoomed(1), "turn", 3);
  EXPECT_EQ(history.undo_depth(), 0u);
}

TEST(History, AChangeAfterUndoForgetsWhatWasUndone) {
  History history(zoomed(1));
  history.change(zoomed(2), "a");
  history.change(zoomed(3), "b");
  history.undo();
  EXPECT_EQ(history.redo_words(), "b");
  history.change(zoomed(4), "c");
  EXPECT_FALSE(history.redo());
  EXPECT_EQ(history.undo_words(), "c");
}

TEST(History, ItsLengthIsBounded) {
  History history(zoomed(1));
  for (int i = 2; i < 5000; ++i) history.change(zoomed(i), "zoom");
  EXPECT_EQ(history.undo_depth(), 1000u);
}

}  // namespace
}  // namespace dubsar::app
