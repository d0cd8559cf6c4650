#pragma once
// Which language the window speaks: what was asked for, else what it spoke last, else what the environment says.

#include <string>

#include "core/base/result.h"

namespace dubsar::app {

/// `asked`: a code, a file of texts, or empty. Without a window (`live` false) nothing but that counts, so that the
/// same options make the same pictures everywhere. Errors of use_language() for what was asked.
Result<void> choose_language(const std::string& asked, bool live);

/// At the end of a session: the next window speaks the language that this one was told meanwhile.
void keep_language();

}  // namespace dubsar::app
