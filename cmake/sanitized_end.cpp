// How a program of a build with AddressSanitizer ends. libasan 12 looks for leaks before the libraries of others are
// torn down, and a process that has drawn with Mesa can then wait for ever in one of their destructors (libp11-kit's,
// which HDF5 and OpenCV bring along, in freelocale()). So after our own destructors leaks are looked for here, with the
// same exit code where there are some, and the process ends without those of shared libraries.

#include <sanitizer/lsan_interface.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace {

void end(int status, void*) {
  std::fflush(nullptr);
  __lsan_do_leak_check();  // ends the process where something leaked
  ::_exit(status);
}

// Registered before any object of the program is made, so that it runs after the last one is gone.
__attribute__((constructor(101))) void register_end() { ::on_exit(end, nullptr); }

}  // namespace
