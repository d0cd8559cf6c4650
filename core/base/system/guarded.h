#pragma once
// Work in a thread of its own ends with a sentence: nobody would catch what it throws, and the program would end.

#include <exception>
#include <new>
#include <string_view>
#include <type_traits>

#include "core/base/result.h"

namespace dubsar {

/// What `work` returns, a Result or nothing. What it throws is an error whose sentence begins with `what`: kTryAgain
/// where there was no memory, else kInternal.
template <class Work>
auto guarded(std::string_view what, Work&& work) {
  using Made = std::invoke_result_t<Work&>;
  using Out = std::conditional_t<std::is_void_v<Made>, Result<void>, Made>;
  try {
    if constexpr (std::is_void_v<Made>) {
      work();
      return Out();
    } else {
      return Out(work());
    }
  } catch (const std::bad_alloc&) {
    return Out(fail(ErrorKind::kTryAgain, "{}: there is not enough memory for it", what));
  } catch (const std::exception& mistake) {
    return Out(fail(ErrorKind::kInternal, "{}: stopped by a mistake of this program: {}", what, mistake.what()));
  } catch (...) {
    return Out(fail(ErrorKind::kInternal, "{}: stopped by a mistake of this program", what));
  }
}

}  // namespace dubsar
