#pragma once
// What `dubsar view` was asked for, as its options say it.

#include <string>
#include <vector>

#include "app/cli/arguments.h"
#include "app/cli/input_options.h"
#include "devices/looking_glass/bridge_client.h"

namespace dubsar::app {

struct ViewRequest {
  struct What {
    std::vector<std::string> in;
    std::string scan, kiosk, unit, view = "front", style = "relief";
    InputOptionTexts scan_reading;
    std::vector<std::string> partitions;
  } what;
  struct Panel {
    std::string display = "mono", size, monitor, language;
    std::vector<std::string> plugins;  ///< files
    std::vector<std::string> also;     ///< displays
    int samples = 0, bridge_port = kBridgePort, ui_scale = 0;
    bool offscreen = false, fullscreen = false, windowed = false;
  } panel;
  struct People {
    std::vector<std::string> inputs;
    std::string script, steps, mapping;
  } people;
  struct Made {
    std::string frames, record, tour;
    int every = 1;
  } made;
  struct Pace {
    double fps = 0.0, seconds = 0.0, display_delay_ms = 0.0;
  } time;
};

/// The verb's options, which fill `options`; that outlives the command.
Arguments add_view_arguments(Arguments program, ViewRequest& options);

}  // namespace dubsar::app
