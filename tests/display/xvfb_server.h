#pragma once
// An X server without a screen for tests of windows.

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "core/image_io/image.h"

namespace dubsar::testing {

/// Starts Xvfb on a display of its own (one screen) and puts it into DISPLAY; ended by the destructor. Never
/// uses a display that is there already: tests must not open windows on somebody's desk.
class XvfbServer {
 public:
  explicit XvfbServer(int width = 1920, int height = 1200);
  ~XvfbServer();
  XvfbServer(const XvfbServer&) = delete;
  XvfbServer& operator=(const XvfbServer&) = delete;
  /// Empty: it runs; else why not.
  const std::string& problem() const { return problem_; }
  /// What is on the screen, RGB, from the server's own frame buffer file (XWD); an image of no size when it cannot be
  /// read.
  Image screen(int x, int y, int width, int height) const;

 private:
  std::filesystem::path folder_;
  pid_t process_ = -1;
  std::string problem_;
};

}  // namespace dubsar::testing
