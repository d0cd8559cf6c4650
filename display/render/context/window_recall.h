#pragma once
// Brings a window of an X server back that a window manager has hidden; the only source that includes xcb.

#include <cstdint>

namespace dubsar {

/// Asks the server and its window manager (EWMH 1.5, as a pager does) for `window`, an X id: mapped, on all desktops,
/// over the others, covering its monitor where `covers`, with the keyboard where `keyboard`; a desktop that is shown in
/// place of windows is not any longer. Does what the manager grants, and nothing where there is no X server. Uses a
/// connection of its own, so that what the server refuses is no error of anybody else's.
void recall_window(std::uint32_t window, bool covers, bool keyboard);

}  // namespace dubsar
