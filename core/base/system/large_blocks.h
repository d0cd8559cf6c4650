#pragma once
// What becomes of memory that is freed: of a process that runs for days, and of one that computes for a minute.

#include <cstdint>

namespace dubsar {

/// From now on memory that is freed stays with the process, for the next blocks: one that makes and drops arrays of
/// hundreds of MiB spends a tenth of its time on pages that the system takes away and clears for it again. For programs
/// that end soon; its most memory grows by what lies between blocks, some 10 %. For the whole process; any thread.
void keep_large_blocks() noexcept;

/// What was freed at the end of the heap and stays with the process: the next blocks come from there, before the system
/// is asked for more. Any thread; walks the C library's lists of free blocks.
std::uint64_t spare_heap_bytes() noexcept;

/// From now on all threads share two heaps, and large blocks go back to the system as below: of 16 threads with heaps
/// of their own each keeps some 6 MiB of what it has freed. For programs that are to stay small; before threads start.
void share_heaps() noexcept;

/// Gives what is free back to the system, between stages of a program that is to stay small. Milliseconds; any thread.
void return_free_memory() noexcept;

/// From now on a block of 1 MiB or more (a texture of 960x540 has 2) goes back to the system when it is freed. Without
/// this the C library raises that size, up to 32 MiB, to that of each such block that is freed; later ones come from
/// its heap, where small blocks between them keep what is freed from going back. Smaller blocks, which drivers without
/// a GPU take and free in each picture, are used again: their pages would be cleared each time (a quarter of a
/// picture's time was that). For the whole process; any thread, any number of times.
void return_large_blocks() noexcept;

}  // namespace dubsar
