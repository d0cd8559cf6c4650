#pragma once
// A GL 4.5 core context. Whoever draws takes one of these and leaves windows and platforms to its maker.

#include <string>

#include "core/base/result.h"

namespace dubsar {

class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes the context current in the calling thread; all GL of one context happens in one thread.
  virtual Result<void> make_current() = 0;
};

/// Vendor, renderer and version of the current context in one line, e.g. for `dubsar doctor`.
std::string describe_gl();

/// Sends the driver's debug messages of the current context to log(): high severity as warnings, others as debug.
void log_gl_messages();

/// True when the current context has at least GL 4.5.
bool has_gl45();

}  // namespace dubsar
