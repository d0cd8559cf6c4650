// The options of dubsar view.

#include "app/cli/mesh_input.h"
#include "app/verbs/view_request.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "input/input_source.h"

namespace dubsar::app {

Arguments add_view_arguments(Arguments program, ViewRequest& options) {
  Arguments command = program.command("view", "turn a surface on a display with hands, head and mouse");
  command.reads("IN", options.what.in, "EXA, PLY, OBJ, STL or GLB files; none: the window asks")
      .called("FILE...")
      .words(0, 100);
  command
      .reads("--kiosk", options.what.kiosk,
             "a gallery's profile (docs/kiosk.md): its objects, until an operator ends it")
      .called("PROFILE.json");
  command
      .reads("--scan", options.what.scan,
             "the scan that the surface was made of, for slices; else one of its name beside it")
      .called("SCAN.h5");
  add_scan_options(command, options.what.scan_reading);
  std::string sinks, sources;
  for (const SinkBackend& sink : output_sinks()) sinks += (sinks.empty() ? "" : ", ") + std::string(sink.name);
  for (const std::string_view source : input_source_names())
    sources += (sources.empty() ? "" : ", ") + std::string(source);
  command.value("--display", options.panel.display, "NAME[:options]: " + sinks);
  command
      .value("--also", options.panel.also,
             "another panel that shows the same: NAME[:options][,monitor=NAME][,size=WxH]")
      .called("DISPLAY")
      .one_word_each_time();
  command.value("--plugin", options.panel.plugins, "a display from a shared library; loading it runs its code")
      .called("FILE.so")
      .one_word_each_time();
  command.value("--input", options.people.inputs, "NAME[:options],...: " + sources);
  command.reads("--script", options.people.script, "simulated people: as --input scripted:FILE").called("FILE");
  command
      .reads("--steps", options.people.steps,
             "commands with the seconds when they are said, one a line (docs/guide.md)")
      .called("FILE");
  command.reads("--mapping", options.people.mapping, "which gesture does what (docs/input.md)").called("FILE");
  command.flag("--offscreen", options.panel.offscreen, "without a window, in simulated time");
  command.value("--frames", options.made.frames, "folder for pictures of the frames").called("DIR");
  command.value("--every", options.made.every, "write only each N-th frame").range(1, 100000);
  command.writes("--record", options.made.record, FileFormat::kOther, "write the input for --input replay:FILE")
      .called("FILE");
  command
      .writes("--tour", options.made.tour, FileFormat::kOther,
              "write the tour of a gallery that this tablet has by itself, and end")
      .called("FILE");
  command.value("--size", options.panel.size,
                "WIDTHxHEIGHT of the window (1280x720; offscreen 960x540, or the panel's own)");
  command.value("--monitor", options.panel.monitor,
                "part of the name of the monitor to use (dubsar displays lists them)");
  command.flag("--fullscreen", options.panel.fullscreen,
               "cover the monitor; displays that need exact pixels do so by themselves");
  command.flag("--windowed", options.panel.windowed, "never cover the monitor");
  command
      .value("--fps", options.time.fps,
             "simulated time: N frames a second however long they take (offscreen 30; a window: real time)")
      .range(1.0, 240.0);
  command.value("--seconds", options.time.seconds, "end after this time at the latest (60; a window: never)")
      .range(0.1, 3600.0);
  command.value("--bridge-port", options.panel.bridge_port, "of Looking Glass Bridge, for panel auto").range(0, 65535);
  command
      .value("--display-delay-ms", options.time.display_delay_ms,
             "time from cameras to light, for the prediction of heads")
      .range(0.0, 100.0);
  command.value("--view", options.what.view, "the home view: front, back, left ... or orbit:AZIMUTH,ELEVATION[,ROLL]");
  command.value("--style", options.what.style, "shading, as of render");
  command.value("--unit", options.what.unit, kUnitHelp);
  command.value("--partition", options.what.partitions, "only these parts: names or ids, e.g. tablet")
      .separated_by(',');
  command.value("--ui-scale", options.panel.ui_scale, "size of letters and panels in percent (as the desktop says)")
      .range(50, 400);
  command.value("--language", options.panel.language,
                "of the window: de, en or FILE.json (as last, else the desktop's)");
  command.value("--samples", options.panel.samples, "samples per pixel side (2; offscreen 1)").range(1, 8);
  command.footer(
      "In the window: F1 shows what mouse, keys and hands do and how the sources are; F2 goes to the next display, F11 "
      "covers\n"
      "the monitor, Escape ends.\n"
      "Examples:\n"
      "  dubsar view tablet.exa\n"
      "  dubsar view obverse.exa reverse.exa\n"
      "  dubsar view tablet.exa --display anaglyph --partition tablet\n"
      "  dubsar view tablet.exa --display lenticular:auto --input mouse,keyboard,leapc\n"
      "  dubsar view tablet.exa --offscreen --display quilt:looking-glass-portrait --script visitor.json --frames "
      "pictures\n"
      "  dubsar view tablet.exa --offscreen --display lenticular:spatiallabs-15.6 --script scholar.json --frames "
      "pictures --every 15");
  return command;
}

}  // namespace dubsar::app
