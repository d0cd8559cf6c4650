#pragma once
// A program of verbs: exit codes, and what is common to all verbs.

#include <vector>

#include "app/cli/verb.h"

namespace dubsar::app {

inline constexpr const char* kExitCodes =
    "Exit codes: 0 done, 64 usage, 65 bad data, 66 no input, 69 device missing, 70 internal, 73 cannot create, "
    "74 I/O or disk full, 75 try again, 77 permission, 78 bad profile, 130 cancelled.";

/// The program without verbs yet.
Arguments begin_program();

/// Parses the command line and runs the verb that it names. Returns the exit code.
int run_program(Arguments program, const std::vector<Verb>& verbs, int argc, char** argv);

}  // namespace dubsar::app
