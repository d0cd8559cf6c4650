/* Plug-ins that must be refused: BROKEN says how. */
#include "display/sinks/catalog/plugin_abi.h"

#define WRONG_ABI 1
#define SMALL_TABLE 2
#define GAP 3
#define BUILT_IN_NAME 4
#define BAD_NAME 5
#define REFUSES 6
#define HUGE_VIEWS 7
#define NOT_FINITE 8

static void* create(const char* options, char* error, size_t error_size) {
  static int sink;
  (void)options;
  (void)error;
  (void)error_size;
  return &sink;
}
static void destroy(void* sink) { (void)sink; }
static int configure(void* sink, const dubsar_sink_screen* screen, dubsar_sink_traits* traits, char* error, size_t error_size) {
  (void)sink;
  (void)error;
  (void)error_size;
  traits->views = BROKEN == HUGE_VIEWS ? 1 << 30 : 1;
  traits->view_w = traits->output_w = screen->window_w;
  traits->view_h = traits->output_h = screen->window_h;
  return 0;
}
static int views(void* sink, const dubsar_sink_viewer* viewer, dubsar_sink_view* out, char* error, size_t error_size) {
  (void)sink;
  (void)viewer;
  (void)error;
  (void)error_size;
  for (int i = 0; i < 16; ++i) out->view_from_screen[i] = out->clip_from_view[i] = 1e308 * 10.0;
  return 0;
}
static int compose(void* sink, const dubsar_sink_frame* frame, char* error, size_t error_size) {
  (void)sink;
  (void)frame;
  (void)error;
  (void)error_size;
  return 0;
}

const dubsar_sink_table* dubsar_sink_plugin(const dubsar_sink_host* host);
const dubsar_sink_table* dubsar_sink_plugin(const dubsar_sink_host* host) {
  static const dubsar_sink_table table = {
      BROKEN == WRONG_ABI ? DUBSAR_SINK_ABI + 1u : DUBSAR_SINK_ABI,
      BROKEN == SMALL_TABLE ? 16u : sizeof(dubsar_sink_table),
      BROKEN == BUILT_IN_NAME ? "mono" : BROKEN == BAD_NAME ? "No Name" : "broken",
      "broken",
      create,
      destroy,
      configure,
      views,
      BROKEN == GAP ? 0 : compose};
  (void)host;
  return BROKEN == REFUSES ? 0 : &table;
}
