#include "app/publish/video.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/base/system/child_process.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kSaid = 2000;  // characters of what ffmpeg said last

struct Coding {
  std::string_view suffix, container;
  std::vector<std::string> options;
};

/// Even sizes, and colours by the matrix of HD with sRGB's own curve said, so that players show what the pictures show.
const std::string kFilter =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,"
    "format=yuv420p";
const std::vector<std::string> kColours{"-colorspace", "bt709",        "-color_primaries", "bt709",
                                        "-color_trc",  "iec61966-2-1", "-color_range",     "tv"};

const std::vector<Coding>& codings() {
  static const std::vector<std::string> h264{"-c:v",    "libx264", "-crf",      "16",
                                             "-preset", "medium",  "-movflags", "+faststart"};
  static const std::vector<Coding> all{
      {".mp4", "mp4", h264},
      {".mov", "mov", h264},
      {".webm", "webm", {"-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0", "-row-mt", "1"}},
      {".mkv", "matroska", {"-c:v", "ffv1", "-level", "3", "-g", "1"}},
  };
  return all;
}

const Coding* coding_of(const fs::path& path) {
  const std::string suffix = lower_suffix(path);
  const auto at = std::find_if(codings().begin(), codings().end(), [&](const Coding& c) { return c.suffix == suffix; });
  return at == codings().end() ? nullptr : &*at;
}

std::vector<std::string> arguments_of(const VideoRequest& request, const Coding& coding, const fs::path& out) {
  std::vector<std::string> words{request.ffmpeg.string(),
                                 "-hide_banner",
                                 "-nostdin",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-progress",
                                 "pipe:1",
                                 "-framerate",
                                 fmt::format("{}", request.fps),
                                 "-start_number",
                                 "1",
                                 "-i",
                                 (request.folder / request.pattern).string()};
  const bool exact = coding.container == "matroska";
  if (!exact) {
    words.insert(words.end(), {"-vf", kFilter});
    words.insert(words.end(), kColours.begin(), kColours.end());
  }
  words.insert(words.end(), coding.options.begin(), coding.options.end());
  words.insert(words.end(), {"-f", std::string(coding.container), out.string()});
  return words;
}

/// The number in the last "frame=N" of what ffmpeg told so far.
int frames_told(std::string_view text) {
  const std::size_t at = text.rfind("frame=");
  int out = 0;
  if (at != std::string_view::npos) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(' ', at + 6)));
    std::from_chars(text.data(), text.data() + text.size(), out);
  }
  return out;
}

std::string last_line(const std::string& text) {
  std::string last;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

bool is_video_name(const fs::path& path) { return coding_of(path) != nullptr; }

Result<void> check_video_name(const fs::path& path) {
  if (is_video_name(path)) return {};
  return fail(ErrorKind::kUsage, "cannot write {}: expected a folder, or a name that ends in .mp4, .mov, .webm or .mkv",
              path.string());
}

Result<fs::path> find_ffmpeg() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / "ffmpeg";
    std::error_code error;
    if (fs::is_regular_file(program, error) && ::access(program.c_str(), X_OK) == 0) return program;
  }
  return fail(ErrorKind::kUnavailable,
              "ffmpeg is not installed, which makes videos; install it (apt install ffmpeg), or give a folder for the "
              "pictures alone");
}

Result<void> make_video(const VideoRequest& request, Progress& progress) {
  DUBSAR_TRY(check_video_name(request.out));
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(request.out));
  DUBSAR_ASSIGN(ChildProcess child,
                ChildProcess::start(arguments_of(request, *coding_of(request.out), file.temporary_path())));
  progress.begin("video", request.pictures, "picture");
  std::array<std::string, 2> said;
  for (int told = 0; child.read(said);) {
    if (progress.cancelled()) return cancelled_error();
    const int now = std::min(frames_told(said[0]), request.pictures);
    if (now > told) progress.advance(now - std::exchange(told, now));
    for (std::string& text : said)
      if (text.size() > kSaid) text.erase(0, text.size() - kSaid);
  }
  const int code = child.wait();
  if (progress.cancelled()) return cancelled_error();
  if (code != 0)
    return fail(ErrorKind::kIo, "ffmpeg could not make {} (exit code {}): {}", request.out.string(), code,
                said[1].empty() ? "it gave no reason" : last_line(said[1]));
  DUBSAR_TRY(file.commit());
  progress.end();
  return {};
}

}  // namespace dubsar::app
