#pragma once
// The states of a document, forwards and backwards. What belongs together, such as a drag or a throw, is one step.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/document/document.h"

namespace dubsar::app {

class History {
 public:
  struct Step {
    Document other;  ///< on the far side of the step
    std::string words;
    std::uint64_t merge = 0;
  };
  explicit History(Document first) : now_(std::move(first)) {}
  /// Goes on with steps to undo and to redo, the last of each is the next one.
  History(std::vector<Step> past, Document now, std::vector<Step> future)
      : past_(std::move(past)), future_(std::move(future)), now_(std::move(now)) {}

  const Document& now() const noexcept { return now_; }
  /// One step, named by `words`; none when nothing differs. Changes in a row with the same `merge` other than 0 are one
  /// step. What was undone before can no longer be redone. At most 1000 steps are kept, the newest.
  void change(Document next, std::string words, std::uint64_t merge = 0);
  /// Somebody else changed the document meanwhile: no step, so that undo and redo leave that alone. `next` is how it is
  /// now; `with_it` gives each other state what was changed.
  void change_all(Document next, const std::function<Document(const Document&)>& with_it);
  /// False when there is nothing to undo or redo.
  bool undo();
  bool redo();
  const std::vector<Step>& past() const noexcept { return past_; }
  const std::vector<Step>& future() const noexcept { return future_; }
  std::size_t undo_depth() const noexcept { return past_.size(); }
  std::size_t redo_depth() const noexcept { return future_.size(); }
  /// What the next undo or redo is about; empty: there is none.
  std::string undo_words() const { return past_.empty() ? std::string() : past_.back().words; }
  std::string redo_words() const { return future_.empty() ? std::string() : future_.back().words; }

 private:
  std::vector<Step> past_, future_;
  Document now_;
};

}  // namespace dubsar::app
