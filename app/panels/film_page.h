#pragma once
// The film editor's measures, for who draws it and who tries it.

namespace dubsar::app {

/// In pixels of the layout. A row is a keyframe: its picture, and what can be done with it. What is dragged by its
/// picture goes to the row where it is let go.
inline constexpr float kFilmRow = 66.0f, kFilmPicture = 60.0f;

/// Keyframes that are seen at once; others are scrolled to.
inline constexpr int kFilmRows = 6;

}  // namespace dubsar::app
