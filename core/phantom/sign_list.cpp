#include "core/phantom/sign_list.h"

#include <cmath>
#include <initializer_list>
#include <string_view>

namespace dubsar::phantom {
namespace {

// One letter and three numbers a wedge, all in hundredths of the sign height: H horizontal (head left), V vertical
// (head on top), D oblique down to the right, U oblique up to the right, W Winkelhaken; x, y of the head, tail length.
struct Mark {
  char kind;
  int x, y, length;
};

Sign sign(int width, std::initializer_list<Mark> marks) {
  Sign result;
  result.width = 0.01f * static_cast<float>(width);
  for (const Mark& mark : marks) {
    Stroke s;
    s.x = 0.01f * static_cast<float>(mark.x);
    s.y = 0.01f * static_cast<float>(mark.y);
    s.length = 0.01f * static_cast<float>(mark.length);
    const float diagonal = std::sqrt(0.5f);
    switch (mark.kind) {
      case 'H':
        s.tail_x = 1, s.tail_y = 0, s.head = 0.15f;
        s.kind = StrokeKind::kHorizontal;
        break;
      case 'V':
        s.tail_x = 0, s.tail_y = -1, s.head = 0.16f;
        s.kind = StrokeKind::kVertical;
        break;
      case 'D':
        s.tail_x = diagonal, s.tail_y = -diagonal, s.head = 0.145f;
        s.kind = StrokeKind::kObliqueDown;
        break;
      case 'U':
        s.tail_x = diagonal, s.tail_y = diagonal, s.head = 0.145f;
        s.kind = StrokeKind::kObliqueUp;
        break;
      default:
        s.tail_x = -1, s.tail_y = 0, s.length = 0, s.head = 0.18f;
        s.kind = StrokeKind::kWinkelhaken;
        break;
    }
    result.strokes.push_back(s);
  }
  return result;
}

}  // namespace

const std::vector<Sign>& sign_list() {
  static const std::vector<Sign> signs{
      sign(38, {{'V', 18, 88, 78}}),                                                            // DISZ
      sign(95, {{'H', 12, 50, 75}}),                                                            // ASZ
      sign(100, {{'H', 12, 50, 80}, {'V', 52, 88, 76}}),                                        // MASZ
      sign(105, {{'H', 12, 50, 82}, {'V', 56, 88, 78}, {'D', 24, 82, 40}, {'U', 24, 16, 40}}),  // AN
      sign(78, {{'V', 16, 88, 36}, {'V', 16, 44, 34}, {'V', 50, 88, 76}}),                      // A
      sign(105, {{'H', 12, 80, 78}, {'H', 12, 20, 78}, {'V', 40, 88, 74}, {'V', 78, 88, 74}}),  // BA
      sign(115, {{'H', 12, 50, 44}, {'W', 62, 72, 0}, {'W', 62, 28, 0}, {'V', 98, 88, 76}}),    // NA
      sign(110, {{'H', 12, 78, 60}, {'H', 12, 50, 60}, {'H', 12, 22, 60}, {'V', 90, 88, 76}}),  // MA
      sign(120,
           {{'H', 12, 82, 50}, {'H', 12, 50, 50}, {'H', 12, 18, 50}, {'V', 70, 88, 76}, {'V', 102, 88, 76}}),      // DA
      sign(100, {{'D', 16, 84, 60}, {'U', 16, 18, 60}, {'V', 80, 88, 76}}),                                        // TI
      sign(125, {{'W', 20, 50, 0}, {'W', 46, 74, 0}, {'W', 46, 26, 0}, {'V', 76, 88, 76}, {'V', 106, 88, 76}}),    // KI
      sign(110, {{'H', 12, 66, 76}, {'H', 12, 34, 76}, {'V', 34, 90, 30}, {'V', 60, 90, 30}, {'V', 92, 90, 78}}),  // NI
      sign(70, {{'W', 22, 78, 0}, {'W', 22, 50, 0}, {'W', 22, 22, 0}, {'V', 52, 88, 76}}),  // numeral and LUGAL part
      sign(92, {{'V', 16, 88, 76}, {'V', 46, 88, 76}, {'V', 76, 88, 76}}),                  // three
      sign(92, {{'V', 16, 88, 34},
                {'V', 46, 88, 34},
                {'V', 76, 88, 34},
                {'V', 16, 44, 34},
                {'V', 46, 44, 34},
                {'V', 76, 44, 34}}),  // six
      sign(130, {{'H', 12, 82, 100},
                 {'H', 12, 18, 100},
                 {'V', 24, 82, 50},
                 {'V', 58, 82, 50},
                 {'V', 92, 82, 50},
                 {'H', 36, 50, 50}}),  // E
      sign(128,
           {{'H', 12, 70, 98}, {'H', 12, 40, 98}, {'D', 40, 88, 34}, {'D', 68, 88, 34}, {'V', 108, 90, 80}}),  // IM
      sign(120,
           {{'U', 16, 20, 50}, {'D', 18, 82, 50}, {'H', 40, 50, 60}, {'V', 100, 88, 34}, {'V', 100, 44, 34}}),  // SZI
      sign(138, {{'H', 12, 84, 108},
                 {'H', 12, 52, 40},
                 {'H', 12, 20, 108},
                 {'V', 62, 84, 60},
                 {'V', 92, 84, 60},
                 {'V', 122, 90, 78},
                 {'W', 40, 36, 0}}),  // KA
      sign(112,
           {{'D', 14, 84, 44}, {'D', 40, 84, 44}, {'H', 14, 32, 80}, {'H', 14, 12, 80}, {'V', 94, 90, 78}}),  // SZA
      sign(140, {{'V', 16, 88, 76},
                 {'H', 26, 78, 52},
                 {'H', 26, 50, 52},
                 {'H', 26, 22, 52},
                 {'V', 92, 88, 36},
                 {'V', 92, 44, 34},
                 {'V', 122, 88, 76}}),                                                                           // RA
      sign(108, {{'H', 12, 60, 78}, {'H', 12, 36, 78}, {'V', 52, 90, 80}, {'W', 84, 80, 0}, {'W', 84, 14, 0}}),  // LA
      sign(95, {{'H', 12, 74, 66}, {'H', 12, 26, 66}, {'U', 22, 34, 36}, {'V', 78, 88, 76}}),                    // TU
      sign(150, {{'H', 12, 80, 60},
                 {'H', 12, 50, 60},
                 {'H', 12, 20, 60},
                 {'V', 62, 90, 34},
                 {'V', 62, 44, 34},
                 {'W', 92, 66, 0},
                 {'W', 92, 34, 0},
                 {'V', 132, 88, 76}}),  // LUGAL
      sign(126, {{'W', 20, 74, 0}, {'W', 20, 28, 0}, {'H', 38, 50, 70}, {'V', 62, 88, 76}, {'V', 104, 88, 76}}),  // U2
      sign(104, {{'D', 16, 86, 60}, {'U', 16, 14, 60}, {'W', 58, 50, 0}, {'V', 86, 88, 76}}),                     // KU3
  };
  return signs;
}

std::vector<PlacedSign> write_line(float length, Random& random) {
  std::vector<PlacedSign> line;
  const auto& signs = sign_list();
  const auto tremble = [&](double amount) { return static_cast<float>(random.uniform(-amount, amount)); };
  float x = 0.05f;
  int left_in_word = 2 + random.index(3);
  for (;;) {
    int index = 2 + random.index(static_cast<int>(signs.size()) - 2);
    if (left_in_word == 0) {
      left_in_word = 2 + random.index(3);
      index = random.uniform() < 0.5 ? 0 : index;  // the Old Assyrian word divider is one vertical wedge
      if (index != 0) x += 0.2f;
    }
    --left_in_word;
    const Sign& chosen = signs[static_cast<std::size_t>(index)];
    const float stretch = static_cast<float>(random.uniform(0.92, 1.1));
    if (x + chosen.width * stretch > length) return line;
    PlacedSign placed{index, {}};
    for (Stroke stroke : chosen.strokes) {
      stroke.x = x + stroke.x * stretch + tremble(0.018);
      stroke.y += tremble(0.022);
      stroke.length *= 1.0f + tremble(0.1);
      stroke.head *= 1.0f + tremble(0.1);
      const float turn = tremble(0.09), c = std::cos(turn), s = std::sin(turn);
      const float tail_x = stroke.tail_x * c - stroke.tail_y * s;
      stroke.tail_y = stroke.tail_x * s + stroke.tail_y * c;
      stroke.tail_x = tail_x;
      placed.strokes.push_back(stroke);
    }
    line.push_back(std::move(placed));
    x += chosen.width * stretch + 0.10f;
  }
}

}  // namespace dubsar::phantom
