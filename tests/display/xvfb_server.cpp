#include "tests/display/xvfb_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

#include "core/base/files/atomic_file.h"

namespace dubsar::testing {
namespace {
constexpr int kStartTimeoutMs = 20000;
}

XvfbServer::XvfbServer(int width, int height) {
  folder_ = std::filesystem::temp_directory_path() / ("dubsar_xvfb_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder_);
  std::array<int, 2> pipe_ends{};
  if (::pipe(pipe_ends.data()) != 0) {
    problem_ = "no pipe";
    return;
  }
  process_ = ::fork();
  if (process_ == 0) {
    ::close(pipe_ends[0]);
    const int nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, 1);
    ::dup2(nothing, 2);
    ::unsetenv("LD_PRELOAD");  // VirtualGL is for the client
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    const std::string descriptor = std::to_string(pipe_ends[1]);
    ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(), "-nolisten", "tcp",
             "-noreset", "-fbdir", folder_.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(pipe_ends[1]);
  std::string number;  // Xvfb writes it, with a newline, when it is ready
  while (number.empty() || number.back() != '\n') {
    pollfd waiting{pipe_ends[0], POLLIN, 0};
    std::array<char, 16> text{};
    const ssize_t size = ::poll(&waiting, 1, kStartTimeoutMs) == 1 ? ::read(pipe_ends[0], text.data(), text.size()) : 0;
    if (size <= 0) break;
    number.append(text.data(), static_cast<std::size_t>(size));
  }
  ::close(pipe_ends[0]);
  if (number.empty()) {
    problem_ = "Xvfb cannot be started; install xvfb";
    return;
  }
  number.pop_back();
  ::setenv("DISPLAY", (":" + number).c_str(), 1);
  ::unsetenv("WAYLAND_DISPLAY");
}

XvfbServer::~XvfbServer() {
  if (process_ > 0) {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  std::filesystem::remove_all(folder_);
}

Image XvfbServer::screen(int x, int y, int width, int height) const {
  const auto text = read_text_file(folder_ / "Xvfb_screen0", 64 << 20);
  if (!text || text->size() < 100) return {};
  const auto field = [&](std::size_t index) {  // big-endian words (XWDFile.h)
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>((*text)[4 * index + i]);
    return value;
  };
  const std::size_t start = field(0) + 12 * field(19), line = field(12), w = field(4), h = field(5);
  const bool blue_first = field(7) == 0;
  if (field(11) != 32 || x < 0 || y < 0 || x + width > static_cast<int>(w) || y + height > static_cast<int>(h) ||
      start + line * h > text->size())
    return {};
  Image image(width, height, 3);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at =
            start + line * static_cast<std::size_t>(y + row) + 4 * static_cast<std::size_t>(x + column);
        image.at(column, row)[c] = static_cast<std::uint8_t>((*text)[at + (blue_first ? 2 - c : 1 + c)]);
      }
  return image;
}

}  // namespace dubsar::testing
