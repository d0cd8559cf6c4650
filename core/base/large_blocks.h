#pragma once
// Memory of a process that runs for days.

namespace dubsar {

/// From now on a block of 256 KiB or more goes back to the system when it is freed. Without this the C library raises
/// that size, up to 32 MiB, to that of each such block that is freed; later ones come from its heap, where small blocks
/// between them keep what is freed from going back. For the whole process; any thread, any number of times.
void return_large_blocks() noexcept;

}  // namespace dubsar
