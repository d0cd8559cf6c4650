/* A display that lives outside of dubsar: one view, mirrored, for beam splitters, pyramids and teleprompters.
 * `dubsar render tablet.exa -o out.png --plugin libmirrored.so --display mirrored[:upside_down]` */
#include <epoxy/gl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plugin_abi.h"

typedef struct {
  int upside_down;
  dubsar_sink_screen screen;
} mirrored;

static const dubsar_sink_host* host;

static void* create(const char* options, char* error, size_t error_size) {
  const int upside_down = strcmp(options, "upside_down") == 0;
  if (options[0] != '\0' && !upside_down) {
    snprintf(error, error_size, "option \"%s\" is not known, expected upside_down or none", options);
    return NULL;
  }
  mirrored* sink = calloc(1, sizeof(mirrored));
  if (sink == NULL) {
    snprintf(error, error_size, "out of memory");
    return NULL;
  }
  sink->upside_down = upside_down;
  return sink;
}

static void destroy(void* sink) { free(sink); }

static int configure(void* self, const dubsar_sink_screen* screen, dubsar_sink_traits* traits, char* error, size_t error_size) {
  mirrored* sink = self;
  (void)error;
  (void)error_size;
  sink->screen = *screen;
  traits->flags = DUBSAR_SINK_TRACKED;
  traits->views = 1;
  traits->view_w = traits->output_w = screen->window_w;
  traits->view_h = traits->output_h = screen->window_h;
  return 0;
}

static int views(void* self, const dubsar_sink_viewer* viewer, dubsar_sink_view* out, char* error, size_t error_size) {
  const mirrored* sink = self;
  double eye[3];
  (void)error;
  (void)error_size;
  for (int axis = 0; axis < 3; ++axis) eye[axis] = 0.5 * (viewer->left_mm[axis] + viewer->right_mm[axis]);
  if (sink->upside_down) eye[1] = -eye[1];
  else eye[0] = -eye[0]; /* the mirror turns the viewer's place round, too */
  host->off_axis_view(&sink->screen, viewer, eye, out);
  return 0;
}

static int compose(void* self, const dubsar_sink_frame* frame, char* error, size_t error_size) {
  const mirrored* sink = self;
  const int w = frame->width, h = frame->height;
  GLuint source = 0;
  glCreateFramebuffers(1, &source);
  glNamedFramebufferTextureLayer(source, GL_COLOR_ATTACHMENT0, frame->view_array, 0, 0);
  const int complete = glCheckNamedFramebufferStatus(source, GL_READ_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  if (complete && sink->upside_down)
    glBlitNamedFramebuffer(source, frame->framebuffer, 0, 0, w, h, 0, h, w, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  else if (complete)
    glBlitNamedFramebuffer(source, frame->framebuffer, 0, 0, w, h, w, 0, 0, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glDeleteFramebuffers(1, &source);
  if (complete) return 0;
  snprintf(error, error_size, "the driver cannot read the view array");
  return 1;
}

#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const dubsar_sink_table* dubsar_sink_plugin(const dubsar_sink_host* program) {
  static const dubsar_sink_table table = {DUBSAR_SINK_ABI, sizeof(dubsar_sink_table), "mirrored",
                                          "one view, mirrored left to right; or upside_down (sample plug-in)",
                                          create, destroy, configure, views, compose};
  if (program->abi != DUBSAR_SINK_ABI || program->size < sizeof(dubsar_sink_host)) return NULL;
  host = program;
  return &table;
}
