// dubsar animate FILM.json IN -o FOLDER|VIDEO: the pictures of a film, and a video of them.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <future>
#include <memory>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/document/document_file.h"
#include "app/publish/picture_series.h"
#include "app/publish/video.h"
#include "app/verbs/display_picture.h"
#include "app/verbs/told_session.h"
#include "app/verbs/view_files.h"
#include "app/viewer/film_painter.h"
#include "core/base/files/atomic_file.h"
#include "core/base/system/log.h"
#include "core/base/text/parse_number.h"
#include "display/sinks/quilt.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr double kMargin = 0.12;  // as in a window with its panels, where films are made
constexpr int kMostPictures = 1'000'000;
constexpr std::string_view kKeep = "_pictures";

struct AnimateRequest {
  std::string film, in, out, size = "1920x1080", style, pictures = "png";
  std::vector<std::string> told;
  double fps = 25.0;
  int samples = 3;
  bool again = false, keep = false;
  DisplayRequest display;
};

struct FilmFile {
  Document base;  ///< what a film that is a session says besides
  std::vector<Keyframe> keys;
};

Result<FilmFile> read_film(const AnimateRequest& options) {
  FilmFile out;
  DUBSAR_ASSIGN(const std::string text, read_text_file(options.film));
  DUBSAR_ASSIGN(out.keys, parse_film(text, options.film));
  if (auto session = parse_document(text, options.film)) out.base = *std::move(session);
  if (!options.style.empty()) {
    for (Keyframe& key : out.keys) key.style.clear();
    out.base.style.name = options.style;
  }
  DUBSAR_TRY(shading_preset(out.base.style.name));
  for (const Keyframe& key : out.keys) {
    if (!key.style.empty()) DUBSAR_TRY(shading_preset(key.style));
    if (key.shade && !key.shade->other.empty()) DUBSAR_TRY(shading_preset(key.shade->other));
  }
  return out;
}

Result<int> pictures_of(const std::vector<Keyframe>& keys, double fps) {
  const double count = std::floor(film_length_s(keys) * fps + 1e-6) + 1.0;
  if (count <= kMostPictures) return static_cast<int>(count);
  return fail(ErrorKind::kUsage, "the film has {:.0f} pictures, expected {} at most; give fewer a second", count,
              kMostPictures);
}

Result<StageOptions> stage_options(const AnimateRequest& options, const std::string& style) {
  DisplayOptions shown;
  const auto [width, height] = parse_size(options.size).value_or(std::array{0, 0});
  if (width < 16 || height < 16 || width > 16384 || height > 16384)
    return fail(ErrorKind::kUsage,
                "--size \"{}\" not understood, expected WIDTHxHEIGHT of 16 to 16384 pixels such as 1920x1080",
                options.size);
  shown.screen.width_px = width;
  shown.screen.height_px = height;
  StageOptions out;
  DUBSAR_ASSIGN(out.display, read_display_options(options.display, shown));
  out.catalog = shown.catalog;
  out.screen = shown.screen;
  out.viewer = shown.viewer;
  DUBSAR_ASSIGN(out.shading, shading_preset(style));
  out.style = style;
  out.room.margin = kMargin;
  out.samples = options.samples;
  return out;
}

/// Where the pictures go, and the video if there shall be one.
struct Places {
  fs::path folder, video, ffmpeg;
};

Result<Places> find_places(const AnimateRequest& options, const SinkTraits& traits) {
  Places out;
  out.folder = options.out;
  if (!fs::path(options.out).has_extension() || fs::is_directory(options.out)) return out;
  DUBSAR_TRY(check_video_name(options.out));
  out.video = traits.file_suffix.empty() ? fs::path(options.out) : name_with_suffix(options.out, traits.file_suffix);
  const std::array<FileUse, 3> uses{{{"FILM", options.film}, {"IN", options.in}, {"-o", out.video.string(), true}}};
  DUBSAR_TRY(check_file_uses(uses));
  DUBSAR_ASSIGN(out.ffmpeg, find_ffmpeg());
  out.folder = out.video.string() + std::string(kKeep);
  return out;
}

/// While one picture is drawn the one before it is written.
Result<void> make_pictures(const AnimateRequest& options, FilmPainter& painter, const std::vector<Keyframe>& keys,
                           const PictureSeries& series, const std::vector<int>& wanted, Progress& progress) {
  std::future<Result<void>> writing;
  const auto written = [&]() -> Result<void> {
    if (!writing.valid()) return {};
    Result<void> done = writing.get();
    if (done) progress.advance(1);
    return done;
  };
  progress.begin("animate", static_cast<std::int64_t>(wanted.size()), "picture");
  for (const int number : wanted) {
    if (progress.cancelled()) break;
    DUBSAR_ASSIGN(const DisplayPicture picture, painter.picture(keys.front().time_s + number / options.fps));
    DUBSAR_ASSIGN(Image image, seen_picture(options.display, picture));
    DUBSAR_TRY(written());
    writing = std::async(std::launch::async, [&series, number, image = std::move(image)]() -> Result<void> {
      DUBSAR_TRY(write_picture(series.path(number), image));
      return series.wrote(number);
    });
  }
  DUBSAR_TRY(written());
  progress.end();
  return {};
}

Result<VerbResult> run(const AnimateRequest& options, bool sized, Progress& progress) {
  DUBSAR_TRY(check_told(options.told));
  DUBSAR_ASSIGN(const FilmFile film, read_film(options));
  DUBSAR_ASSIGN(const int count, pictures_of(film.keys, options.fps));
  std::string style = film.keys.front().style.empty() ? film.base.style.name : film.keys.front().style;
  AnimateRequest asked = options;
  asked.display.sized = sized;
  DUBSAR_ASSIGN(const StageOptions stage, stage_options(asked, style));
  DUBSAR_ASSIGN(const auto sink, stage.catalog->make(stage.display));
  DUBSAR_TRY(sink->configure(stage.screen));
  DUBSAR_ASSIGN(const Places places, find_places(options, sink->traits()));

  DUBSAR_ASSIGN(const TriMesh mesh, load_mesh({options.in, {}, true, {0.0, true}, true}, progress));
  Document document = film_document(film.base, mesh);
  if (!options.told.empty()) {
    ViewOptions view;
    view.stage = stage;
    view.work.document = document;
    DUBSAR_ASSIGN(ToldSession told, tell_session(mesh, view, options.told, ToldPart::kDocument, progress));
    document = std::move(told.document);
  }
  for (const std::string& name : strange_parts(film.keys, document))
    log_warning("animate: the film moves a part {}, which {} does not have", name, options.in);
  std::optional<CompanionSurface> companion;
  if (!document.companion.path.empty()) {
    document.source.path = fs::absolute(options.in).string();
    ViewOptions view;
    view.stage = stage;
    DUBSAR_ASSIGN(OpenedSurface read, beside_reader(view, {.upright = true})(companion_file(document), progress, {}));
    companion.emplace(std::move(read));
  }
  DUBSAR_ASSIGN(FilmPainter painter, FilmPainter::create(mesh, stage, document, film.keys, std::move(companion)));

  const SinkTraits traits = painter.traits();
  Document looks = document;  // what the film's text does not say, without the session's marks
  looks.measures.clear();
  looks.notes.clear();
  looks.source = {};
  looks.keyframes = film.keys;
  SeriesFacts facts{
      fingerprint(format_document(looks)),
      fingerprint(mesh),
      stage.display.text() + options.display.see_from + options.display.viewer + options.display.screen_mm,
      options.style,
      DUBSAR_VERSION,
      options.pictures};
  facts.width = traits.output.width;
  facts.height = traits.output.height;
  facts.samples = options.samples;
  facts.pictures = count;
  facts.fps = options.fps;
  const std::string suffix = traits.file_suffix + "." + options.pictures;
  DUBSAR_ASSIGN(const PictureSeries series, PictureSeries::open(places.folder, suffix, facts, options.again));
  DUBSAR_ASSIGN(std::vector<int> missing, series.missing(progress));
  const std::size_t kept = static_cast<std::size_t>(count) - missing.size();
  if (kept > 0) log_info("animate: {} of {} pictures are there already", kept, count);
  DUBSAR_TRY(make_pictures(options, painter, film.keys, series, missing, progress));
  const auto stopped = [&]() -> Result<VerbResult> {
    int there = 0;
    for (int i = 0; i < count; ++i) there += fs::exists(series.path(i)) ? 1 : 0;
    return fail(ErrorKind::kCancelled, "stopped: {} of {} pictures are in {}; the same command makes the others", there,
                count, places.folder.string());
  };
  if (progress.cancelled()) return stopped();
  DUBSAR_TRY(series.settle());
  if (!places.video.empty()) {
    if (const auto made =
            make_video({places.ffmpeg, places.folder, series.pattern(), count, options.fps, places.video}, progress);
        !made)
      return made.error().kind == ErrorKind::kCancelled ? stopped() : tl::unexpected<Error>(made.error());
    if (!options.keep) series.remove();
  }
  const fs::path out = places.video.empty() ? places.folder : places.video;
  VerbResult result;
  result.json = {{"output", out.string()},
                 {"pictures", count},
                 {"made", missing.size()},
                 {"kept", kept},
                 {"width", facts.width},
                 {"height", facts.height},
                 {"fps", options.fps},
                 {"seconds", count / options.fps},
                 {"display", stage.display.text()}};
  result.text = fmt::format("{}: {} pictures of {}x{} pixels, {:.4g} s at {:g} a second\n", out.string(), count,
                            facts.width, facts.height, count / options.fps, options.fps);
  if (kept > 0) result.text += fmt::format("{} of them were there already\n", kept);
  return result;
}

}  // namespace

Verb add_animate_verb(Arguments program) {
  auto options = std::make_shared<AnimateRequest>();
  options->display.display = "mono";
  Arguments command = program.command("animate", "the pictures of a film, or a video, from keyframes of a session");
  command.reads("FILM", options->film, "keyframes: what `write_film` wrote in a session, or a whole session's file")
      .required();
  command.reads("IN", options->in, "EXA, PLY, OBJ, STL or GLB file").required();
  command
      .value("-o,--output", options->out,
             "folder for numbered pictures, or a video where ffmpeg is installed: .mp4, .mov, .webm, or .mkv, which "
             "changes no pixel. Unless given: beside FILM, NAME_pictures")
      .called("FOLDER|VIDEO");
  command.value("--fps", options->fps, "pictures a second").range(1.0, 240.0);
  command.value("--size", options->size, "WIDTHxHEIGHT in pixels (1920x1080, or the panel's own)");
  command.value("--pictures", options->pictures, "kind of the pictures").one_of({"png", "tif", "jpg"});
  command.value("--style", options->style, "one shading for all of it, in place of those of the keyframes");
  add_do_option(command, options->told);
  command.value("--samples", options->samples, "samples per pixel side").range(1, 8);
  command.flag("--again", options->again, "make all pictures anew, also where there are others that it made");
  command.flag("--keep", options->keep, "keep the pictures beside the video, in VIDEO_pictures");
  add_display_options(command, options->display, false);
  command.footer(
      "Stopped or killed, the same command goes on where it was; damaged pictures are made again.\n"
      "Examples:\n"
      "  dubsar animate film.json tablet.exa -o pictures\n"
      "  dubsar animate film.json tablet.exa -o tablet.mp4 --fps 30 --size 3840x2160\n"
      "  dubsar animate film.json tablet.exa -o quilts --display quilt:looking-glass-portrait");
  return {command,
          [options, command](const CommonOptions&, Progress& progress) {
            return run(*options, command.given("--size"), progress);
          },
          [options] {
            if (options->out.empty()) options->out = output_beside(options->film, std::string(kKeep));
          },
          [options] {
            std::vector<PlannedStage> plan{{"animate", 1.0, true}};
            if (is_video_name(options->out)) plan.push_back({"video", 0.05, true});
            return plan;
          }};
}

}  // namespace dubsar::app
