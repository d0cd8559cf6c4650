#include "app/panels/panel_font.h"

#include <array>

// The file goes into the program as it is; the assembler reads it, which takes
// no time for a compiler.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    ".globl dubsar_panel_font\n"
    "dubsar_panel_font:\n"
    ".incbin \"" DUBSAR_PANEL_FONT
    "\"\n"
    ".globl dubsar_panel_font_end\n"
    "dubsar_panel_font_end:\n"
    ".byte 0\n"
    ".previous\n");

extern "C" {
extern const unsigned char dubsar_panel_font[];
extern const unsigned char dubsar_panel_font_end[];
}

namespace dubsar::app {

std::span<const unsigned char> panel_font() { return {dubsar_panel_font, dubsar_panel_font_end}; }

const std::uint16_t* panel_letters() {
  static constexpr std::array<std::uint16_t, 13> kLetters{0x20,   0x17f,  0x1e00, 0x1eff, 0x2b0,  0x2ff, 0x2070,
                                                          0x209f, 0x2010, 0x203a, 0x2190, 0x21ff, 0};
  return kLetters.data();
}

}  // namespace dubsar::app
