#ifndef DUBSAR_PLUGIN_ABI_H
#define DUBSAR_PLUGIN_ABI_H
/* Displays from shared libraries: `dubsar render --plugin FILE.so --display NAME[:options]`. Plain C, no dependencies.
 *
 * A plug-in exports one function, dubsar_sink_plugin(). It is called once, after loading, with what the program offers,
 * and returns the plug-in's table, which has to stay valid; or NULL when it cannot work with this host.
 *
 * Versions: the program refuses a table whose `abi` is not DUBSAR_SINK_ABI. Within one version structures only grow at
 * their ends; `size` is what the side that filled the structure knows, so read no member beyond it.
 *
 * Frames: the screen frame is in millimetres with its origin in the middle of the panel, +X right, +Y up, +Z to the
 * viewer. Pixels count from the panel's upper left corner. Matrices are column-major, for column vectors, clip space as
 * in OpenGL.
 *
 * Everything is called in one thread. compose(), and destroy() after a compose(), are called with the program's
 * OpenGL 4.5 core context current; leave no program, vertex array or framebuffer of yours bound. Functions that return
 * int return 0 for success; else they write one sentence, NUL-terminated, into error[0 .. error_size - 1]. No exception
 * may leave a function.
 */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(readability-identifier-naming): names of C */
#define DUBSAR_SINK_ABI 1u
#define DUBSAR_SINK_ENTRY "dubsar_sink_plugin"

typedef struct dubsar_sink_screen {
  uint32_t size;
  int32_t width_px, height_px;                    /* of the panel */
  int32_t window_x, window_y, window_w, window_h; /* drawing area on the panel, physical pixels */
  int32_t reserved;
  double width_mm, height_mm; /* of the panel */
} dubsar_sink_screen;

typedef struct dubsar_sink_viewer {
  uint32_t size;
  uint32_t reserved;
  double left_mm[3], right_mm[3]; /* eyes, screen frame */
  double front_mm, back_mm;       /* depth range of what is shown, screen z */
} dubsar_sink_viewer;

typedef struct dubsar_sink_view {
  double view_from_screen[16];
  double clip_from_view[16];
} dubsar_sink_view;

enum {
  DUBSAR_SINK_TRACKED = 1,     /* follows the viewer's eyes */
  DUBSAR_SINK_EXACT_PIXELS = 2 /* works only unscaled, at a known place on the panel */
};

typedef struct dubsar_sink_traits {
  uint32_t size; /* set by the program */
  uint32_t flags;
  int32_t views;              /* 1 .. 2048 */
  int32_t view_w, view_h;     /* pixels of one view, 1 .. 16384 */
  int32_t output_w, output_h; /* pixels of the composed picture, 1 .. 16384 */
  int32_t fields;             /* pictures that take turns at each refresh: 2 for shutters, else 0 or 1 */
} dubsar_sink_traits;

typedef struct dubsar_sink_frame {
  uint32_t size;
  uint32_t view_array; /* GL_TEXTURE_2D_ARRAY, GL_RGBA8, layer k is view k, bytes are sRGB-coded, row 0 at the bottom */
  uint32_t framebuffer; /* draw here; sRGB-coded bytes */
  int32_t width, height;
  int32_t field; /* whose turn it is: 0, or 1 where the traits say two fields */
} dubsar_sink_frame;

typedef struct dubsar_sink_host {
  uint32_t abi, size;
  /* The view of eye_mm through the window of `screen`, clip planes around the viewer's depth range. */
  void (*off_axis_view)(const dubsar_sink_screen* screen, const dubsar_sink_viewer* viewer, const double eye_mm[3],
                        dubsar_sink_view* out);
  /* A message for people. */
  void (*log)(const char* text);
} dubsar_sink_host;

typedef struct dubsar_sink_table {
  uint32_t abi, size;
  const char* name;    /* a-z, 0-9 and _, at most 32 characters; not that of a built-in display */
  const char* summary; /* one line with the options */
  /* `options` is what stands behind "NAME:", perhaps empty: words and key=value with commas between; those that hold
     commas are in quotation marks. NULL: `error` says why. */
  void* (*create)(const char* options, char* error, size_t error_size);
  void (*destroy)(void* sink);
  /* Called before the first views() and when the window changes; fills `traits`. */
  int (*configure)(void* sink, const dubsar_sink_screen* screen, dubsar_sink_traits* traits, char* error,
                   size_t error_size);
  /* Fills `views`, as many as the traits say. */
  int (*views)(void* sink, const dubsar_sink_viewer* viewer, dubsar_sink_view* views, char* error, size_t error_size);
  int (*compose)(void* sink, const dubsar_sink_frame* frame, char* error, size_t error_size);
} dubsar_sink_table;

typedef const dubsar_sink_table* (*dubsar_sink_entry)(const dubsar_sink_host* host);
/* NOLINTEND(readability-identifier-naming) */

#ifdef __cplusplus
}
#endif
#endif
