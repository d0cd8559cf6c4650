#include "app/panels/gallery_page.h"

#include <imgui.h>

#include <algorithm>
#include <numbers>

#include "app/panels/panel_font.h"
#include "app/panels/tutorial_picture.h"
#include "app/stage/ground_color.h"
#include "app/stage/right_to_left.h"

namespace dubsar::app {
namespace {

constexpr float kNarrow = 1.5f;         // panels whose sides are little more than what buttons take
constexpr float kWordsEnd = 0.2f;       // of the height, at the lower edge
constexpr float kSentenceRoom = 0.88f;  // for a sentence, of the panel's width
constexpr double kLargestLetters = 0.075, kSmallerLetters = 0.8;
constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoBackground;

ImU32 ground_at(double dark) {
  const auto light = static_cast<float>(1.0 - dark) / 255.0f;
  return ImGui::GetColorU32(ImVec4(light * static_cast<float>(kGroundColor[0]),
                                   light * static_cast<float>(kGroundColor[1]),
                                   light * static_cast<float>(kGroundColor[2]), 1.0f));
}

/// The object's picture ends where words begin: they stand beside it, never on it.
void fill_band(float top, float bottom, float width, double dark) {
  ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(0.0f, top), ImVec2(width, bottom), ground_at(dark));
}

/// Lines one below the other, each in the middle of the panel; from the right of a room there where one reads so.
void draw_lines(const SetWords& set, float width, float room, float top, bool right_to_left) {
  ImFont* const font = ImGui::GetFont();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto size = static_cast<float>(set.size);
  const float right = 0.5f * (width + kSentenceRoom * room);
  for (std::size_t i = 0; i < set.lines.size(); ++i) {
    const float wide = font->CalcTextSizeA(size, 1e6f, 0.0f, set.lines[i].c_str()).x;
    const ImVec2 at(right_to_left ? right - wide : 0.5f * (width - wide), top + size * static_cast<float>(i));
    list.AddText(font, size, at, ImGui::GetColorU32(ImVec4(0.95f, 0.93f, 0.88f, 1.0f)), set.lines[i].c_str());
  }
}

/// Returns where it begins, from above: the lower edge of what is free.
float draw_sentence(const GalleryPicture& picture, float size_px, float width, float height) {
  const float bottom = height - 0.03f * height;
  if (picture.line.empty()) return bottom;
  const SetWords set = set_words(picture.line, size_px, width, picture.right_to_left);
  const float top = bottom - static_cast<float>(set.tall), pad = 0.4f * static_cast<float>(set.size);
  fill_band(top - pad, height, width, picture.dark);
  if (!picture.blank) draw_lines(set, width, width, top, picture.right_to_left);
  return top - pad;
}

/// A dot for each step of a tour, those that were seen and the present one full; from the right where one reads so.
void draw_steps(const GalleryPicture& picture, float width, float y, float radius) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 amber = ImGui::GetColorU32(ImVec4(0.85f, 0.64f, 0.25f, 1.0f));
  if (picture.steps == 0 || picture.blank) return;
  const float apart = 4.0f * radius, middle = 0.5f * static_cast<float>(picture.steps + 1);
  for (std::size_t i = 1; i <= picture.steps; ++i) {
    const float aside = apart * (static_cast<float>(i) - middle);
    const ImVec2 at(0.5f * width + (picture.right_to_left ? -aside : aside), y);
    if (i <= picture.step)
      list.AddCircleFilled(at, radius, amber, 24);
    else
      list.AddCircle(at, radius, amber, 24, 0.35f * radius);
  }
}

/// A title, and below it a tour's steps, in the middle of what buttons leave of the width; on upright panels above the
/// sentence, which begins at `sentence`.
/// Returns where words begin below the object.
float draw_title(const GalleryPicture& picture, float size_px, float width, float height, float sentence) {
  if (picture.title.empty() && picture.steps == 0) return sentence;
  const bool upright = upright_panel(width / height);
  float room = width;
  for (const DwellButtonPicture& button : picture.buttons)
    if (!upright && button.at.y + button.radius > 0.5 - gallery_room(width / height).words)
      room = std::min(
          room, 2.0f * (static_cast<float>(button.at.x) * width - 1.1f * static_cast<float>(button.radius) * height));
  const PushedTitleFont serif(picture.title);
  const SetWords set = set_words(picture.title, kTitleLarger * size_px, room, picture.right_to_left);
  const float dots = picture.steps > 0 ? 0.5f * size_px : 0.0f, pad = 0.3f * size_px;
  const auto tall = static_cast<float>(set.tall);
  const float top = upright ? sentence - dots - pad - tall : 0.03f * height, below = top + tall + pad;
  if (upright)
    fill_band(top - pad, sentence, width, picture.dark);
  else
    fill_band(0.0f, below + dots, width, picture.dark);
  if (!picture.blank) draw_lines(set, width, room, top, picture.right_to_left);
  draw_steps(picture, width, below + 0.1f * size_px, 0.16f * size_px);
  return upright ? top - pad : sentence;
}

/// On narrow panels the object's picture ends where buttons begin, however near it is drawn.
void end_picture_at_buttons(const GalleryPicture& picture, float width, float height) {
  const float aspect = width / height;
  const float taken = static_cast<float>(2.0 * (dwell_button_radius(aspect) + kDwellButtonMargin)) * height;
  if (upright_panel(aspect))
    fill_band(0.0f, taken, width, picture.dark);
  else if (aspect < kNarrow)
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(width - taken, 0.0f), ImVec2(width, height - kWordsEnd * height),
                                              ground_at(picture.dark));
}

/// Beside the object; on upright panels between it and the words.
void draw_tutorial_disc(const GalleryPicture& picture, float width, float height, float sentence) {
  const double aspect = width / height;
  const GalleryRoom free = gallery_room(aspect);
  float radius = 0.2f * height, x = 0.0f, y = 0.55f * height;
  if (upright_panel(aspect)) {
    const float from = (1.0f - static_cast<float>(free.words)) * height;
    radius = std::min(0.2f * width, 0.46f * (sentence - from));
    x = 0.5f * width;
    y = from + 1.08f * radius;
  } else {
    const float side = width > kNarrow * height ? 0.4f * width : static_cast<float>(free.sides) * width;
    radius = std::min(radius, 0.4f * side);
    x = 1.25f * radius;
  }
  draw_tutorial(tutorial_pose(*picture.tutorial, picture.tutorial_s), x, y, radius);
}

void draw_menu(const std::vector<std::string>& rows, float size_px, float width, float height) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImFont* const font = ImGui::GetFont();
  float wide = 0.0f;
  size_px = std::min(size_px, 0.9f * height / (1.5f * static_cast<float>(rows.size() + 2)));
  for (const std::string& row : rows) {  // an operator stands near: all of a row is seen
    const float at_size = font->CalcTextSizeA(size_px, 1e6f, 0.0f, row.c_str()).x;
    size_px = std::min(size_px, size_px * std::max(0.5f, 0.9f * width / std::max(at_size, 1.0f)));
  }
  for (const std::string& row : rows) wide = std::max(wide, font->CalcTextSizeA(size_px, 1e6f, 0.0f, row.c_str()).x);
  const float step = 1.5f * size_px, tall = step * static_cast<float>(rows.size());
  ImVec2 at(0.5f * (width - wide), 0.5f * (height - tall));
  list.AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(width, height), ground_at(0.0));
  for (const std::string& row : rows) {
    list.AddText(font, size_px, at, ImGui::GetColorU32(ImVec4(0.95f, 0.93f, 0.88f, 1.0f)), row.c_str());
    at.y += step;
  }
}

/// A button is a disc with a picture that needs no words, and a ring that fills while a hand rests on it.
void draw_dwell_button(const DwellButtonPicture& button, float width, float height) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = static_cast<float>(button.radius) * height;
  const ImVec2 at((0.5f + static_cast<float>(button.at.x)) * width, (0.5f - static_cast<float>(button.at.y)) * height);
  const ImU32 ground = ImGui::GetColorU32(ImVec4(0.09f, 0.09f, 0.1f, 0.82f));
  const ImU32 pale = ImGui::GetColorU32(ImVec4(0.95f, 0.93f, 0.88f, 1.0f));
  const ImU32 amber = ImGui::GetColorU32(ImVec4(0.85f, 0.64f, 0.25f, 1.0f));
  const ImU32 clay = ImGui::GetColorU32(ImVec4(0.66f, 0.52f, 0.38f, 1.0f));
  const auto place = [&](float x, float y) { return ImVec2(at.x + r * x, at.y + r * y); };
  const float stroke = 0.07f * r;
  list.AddCircleFilled(at, r, ground, 48);
  list.AddCircle(at, r, pale, 48, 0.5f * stroke);
  const bool open = button.button == DwellButton::kOpen;
  switch (button.button) {
    case DwellButton::kOpen:  // the envelope goes up from the tablet, or comes back
    case DwellButton::kClose:
      list.AddRectFilled(place(-0.22f, 0.05f), place(0.22f, 0.6f), clay, 0.1f * r);
      list.AddRect(place(-0.32f, open ? -0.62f : -0.1f), place(0.32f, open ? -0.05f : 0.68f), pale, 0.15f * r, 0,
                   stroke);
      list.AddTriangleFilled(place(-0.72f, open ? 0.1f : -0.1f), place(-0.4f, open ? 0.1f : -0.1f),
                             place(-0.56f, open ? -0.25f : 0.25f), pale);
      break;
    case DwellButton::kTour:
      list.AddTriangleFilled(place(-0.3f, -0.45f), place(-0.3f, 0.45f), place(0.5f, 0.0f), pale);
      break;
    case DwellButton::kNext:
      list.AddTriangleFilled(place(-0.4f, -0.4f), place(-0.4f, 0.4f), place(0.2f, 0.0f), pale);
      list.AddRectFilled(place(0.25f, -0.4f), place(0.4f, 0.4f), pale);
      break;
    case DwellButton::kLeave:
      list.AddLine(place(-0.35f, -0.35f), place(0.35f, 0.35f), pale, 2.0f * stroke);
      list.AddLine(place(-0.35f, 0.35f), place(0.35f, -0.35f), pale, 2.0f * stroke);
      break;
  }
  if (button.filled <= 0.0) return;
  constexpr float kTop = -0.5f * std::numbers::pi_v<float>;
  list.PathArcTo(at, 1.08f * r, kTop, kTop + 2.0f * std::numbers::pi_v<float> * static_cast<float>(button.filled), 48);
  list.PathStroke(amber, 0, 0.16f * r);
}

}  // namespace

double letters_size(double letter_mm, double height, double per_mm) noexcept {
  return std::min(letter_mm * per_mm / panel_capital(), kLargestLetters * height);
}

SetWords set_words(const std::string& words, double size, double width, bool right_to_left) {
  ImFont* const font = ImGui::GetFont();
  const float room = kSentenceRoom * static_cast<float>(width);
  const auto long_at = [&](float at, const std::string& line) {
    return font->CalcTextSizeA(at, 1e6f, 0.0f, line.c_str()).x;
  };
  const float whole = long_at(static_cast<float>(size), as_seen(words, right_to_left));
  const double fits = 1.9 * room / std::max(whole, 1.0f);  // on two lines that are not quite full
  const auto set = static_cast<float>(size * std::clamp(fits, kSmallerLetters, 1.0));
  if (has_right_to_left(words)) {
    SetWords out{static_cast<double>(set)};
    out.lines =
        lines_as_seen(words, right_to_left, [&](const std::string& line) { return long_at(set, line) <= room; });
    for (const std::string& line : out.lines) out.wide = std::max(out.wide, static_cast<double>(long_at(set, line)));
    out.tall = static_cast<double>(set) * static_cast<double>(out.lines.size());
    return out;
  }
  SetWords out{static_cast<double>(set)};
  const char* const end = words.c_str() + words.size();
  for (const char* begin = words.c_str(); begin < end;) {
    const char* stop = std::max(font->CalcWordWrapPositionA(set / font->FontSize, begin, end, room), begin + 1);
    out.lines.emplace_back(begin, stop);
    out.wide = std::max(out.wide, static_cast<double>(long_at(set, out.lines.back())));
    begin = stop;
    while (begin < end && (*begin == ' ' || *begin == '\n')) ++begin;
  }
  out.tall = static_cast<double>(set) * static_cast<double>(out.lines.size());
  return out;
}

void draw_gallery(const GalleryPicture& picture, float width, float height, float px_per_mm) {
  ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
  ImGui::SetNextWindowSize(ImVec2(width, height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
  ImGui::Begin("gallery", nullptr, kBare);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (picture.dark > 0.0)
    list.AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(width, height),
                       ImGui::GetColorU32(ImVec4(0.0f, 0.0f, 0.0f, static_cast<float>(picture.dark))));
  const auto size = static_cast<float>(letters_size(picture.letter_mm, height, px_per_mm));
  const float sentence = draw_sentence(picture, size, width, height);
  const float words = draw_title(picture, size, width, height, sentence);
  if (picture.tutorial && !picture.blank) draw_tutorial_disc(picture, width, height, words);
  if (!picture.buttons.empty()) end_picture_at_buttons(picture, width, height);
  if (!picture.blank)
    for (const DwellButtonPicture& button : picture.buttons) draw_dwell_button(button, width, height);
  if (!picture.menu.empty()) draw_menu(picture.menu, std::max(size * 0.6f, 14.0f), width, height);
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace dubsar::app
