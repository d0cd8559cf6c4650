// dubsar: all its verbs.

#include <cstdlib>
#include <string>

#include "app/cli/program.h"
#include "app/verbs/work_of_surface.h"

int main(int argc, char** argv) {
  using namespace dubsar::app;
  // The loader of OpenXR prints what our own sentences say; who wants to read it sets another value.
  ::setenv("XR_LOADER_DEBUG", "none", 0);
  Arguments program = begin_program();
  program.footer(std::string("Examples:\n"
                             "  dubsar phantom scan.h5 --preset demo\n"
                             "  dubsar process scan.h5\n"
                             "  dubsar view scan.exa\n"
                             "  dubsar fatcross scan.exa\n\n") +
                 kExitCodes);
  return run_program(
      program,
      {add_phantom_verb(program), add_process_verb(program), add_info_verb(program), add_exa_verb(program),
       add_wedges_verb(program, kept_work), add_handcopy_verb(program, kept_work), add_seal_verb(program),
       add_compare_verb(program), add_export_verb(program), add_fatcross_verb(program), add_render_verb(program),
       add_animate_verb(program), add_report_verb(program), add_show_verb(program), add_view_verb(program),
       add_doctor_verb(program), add_displays_verb(program), add_devices_verb(program), add_kiosk_verb(program)},
      argc, argv);
}
