#pragma once
// Measures what a gallery writes as it would be set, without a picture: whether it fits, whether all its letters are
// there.

#include <string>

struct ImGuiContext;

namespace dubsar::app {

/// Has its own state of Dear ImGui. One thread for all.
class TextRuler {
 public:
  /// Of a panel `width_mm` x `height_mm`, for readers that far away.
  TextRuler(double width_mm, double height_mm, double reading_distance_m);
  ~TextRuler();
  TextRuler(const TextRuler&) = delete;
  TextRuler& operator=(const TextRuler&) = delete;

  /// What is wrong with a title or a sentence, in words with the remedy; empty: nothing.
  std::string wrong(const std::string& text, bool title) const;

 private:
  ImGuiContext *before_, *own_;
  double width_px_, size_;
};

}  // namespace dubsar::app
