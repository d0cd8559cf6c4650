#pragma once
// A block of 20 x 30 x 8 with its lower corner at the origin, as OBJ, for tests that run the program.

namespace dubsar::test {

inline constexpr const char* kBlockObj =
    "v 0 0 0\nv 20 0 0\nv 20 30 0\nv 0 30 0\nv 0 0 8\nv 20 0 8\nv 20 30 8\nv 0 30 8\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

}  // namespace dubsar::test
