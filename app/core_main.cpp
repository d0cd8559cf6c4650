// dubsar of a core build, for machines without graphics and devices: the verbs that make and check surfaces.

#include <string>

#include "app/cli/program.h"

int main(int argc, char** argv) {
  using namespace dubsar::app;
  Arguments program = begin_program();
  program.footer(std::string("Built without graphics and devices: pictures and reports are made elsewhere.\n\n"
                             "Examples:\n"
                             "  dubsar info scan.h5 --memory 6G\n"
                             "  dubsar process scans/ -o surfaces/ --resume\n"
                             "  dubsar exa verify surfaces/tablet.exa\n\n") +
                 kExitCodes);
  return run_program(
      program,
      {add_phantom_verb(program), add_process_verb(program), add_info_verb(program), add_exa_verb(program),
       add_wedges_verb(program), add_handcopy_verb(program), add_seal_verb(program), add_compare_verb(program)},
      argc, argv);
}
