#ifndef DUBSAR_SOURCE_PLUGIN_ABI_H
#define DUBSAR_SOURCE_PLUGIN_ABI_H
/* Inputs from shared libraries: `dubsar view --input plugin:FILE.so[,options]`. Plain C, no dependencies.
 *
 * A plug-in exports one function, dubsar_source_plugin(). It is called once, after loading, with what the program
 * offers, and returns the plug-in's table, which has to stay valid; or NULL when it cannot work with this host.
 *
 * Versions: the program refuses a table whose `abi` is not DUBSAR_SOURCE_ABI. Within one version structures only grow
 * at their ends; `size` is what the side that filled the structure knows, and no member beyond it is read.
 *
 * Frames: right-handed, metres: x right, y up, z to the user. What a plug-in tells may be in its device's own frame;
 * the program's options at= and turn= say where the device stands before the panel (none: the frame is that of the
 * panel, origin in its middle). Rotations are unit quaternions w, x, y, z. Times are nanoseconds of host->now_ns(); 0
 * means now, times to come are taken as now.
 *
 * The least to fill: of a hand `size`, `id`, `flags`, `chirality`, `palm`, `grab` and `pinch_m`, joints may stay 0; of
 * a head `size`, `id`, `flags` with the eyes that are seen, and those. A hand or head that is away is not told: a
 * read() that returns DUBSAR_SOURCE_NEW without it takes it away. `dubsar devices monitor plugin:FILE.so` shows what is
 * told.
 *
 * Threads: create() and destroy() are called in the session's thread, open(), read() and close() in one thread of this
 * source alone. read() may wait, at most for the time it is told. A read() that does not come back makes the source
 * lost with that reason, and nothing else waits for it. Functions that return a pointer or int write one sentence,
 * NUL-terminated, into error[0 .. error_size - 1] when they fail. C++ exceptions that leave a function are caught and
 * make the source lost; those of a thread that the plug-in itself has made are not.
 */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(readability-identifier-naming): names of C */
#define DUBSAR_SOURCE_ABI 1u
#define DUBSAR_SOURCE_ENTRY "dubsar_source_plugin"
#define DUBSAR_SOURCE_JOINTS 26 /* in the order of OpenXR's XR_EXT_hand_tracking: palm, wrist, thumb ... little tip */

typedef struct dubsar_source_pose {
  double position_m[3];
  double rotation_wxyz[4];
} dubsar_source_pose;

enum { DUBSAR_SOURCE_TRACKED = 1, DUBSAR_SOURCE_LEFT_EYE = 2, DUBSAR_SOURCE_RIGHT_EYE = 4 };

/* A person's eyes; an eye that is not seen has no flag. */
typedef struct dubsar_source_head {
  uint32_t size;
  uint32_t id; /* the same while this person is followed without a break */
  uint32_t flags;
  uint32_t reserved;
  int64_t time_ns;
  double confidence; /* 0 .. 1 */
  double left_eye_m[3], right_eye_m[3];
} dubsar_source_head;

typedef struct dubsar_source_joint {
  dubsar_source_pose pose; /* -z to the finger tip, y out of the back of the hand */
  double radius_m;         /* 0: not known */
  uint32_t valid, tracked;
} dubsar_source_joint;

typedef struct dubsar_source_hand {
  uint32_t size;
  uint32_t id;
  uint32_t flags;     /* DUBSAR_SOURCE_TRACKED */
  uint32_t chirality; /* 0 not known, 1 left, 2 right */
  int64_t time_ns;
  double confidence;
  dubsar_source_pose palm;
  double grab;    /* 0 open .. 1 fist */
  double pinch_m; /* thumb tip to index tip */
  dubsar_source_joint joints[DUBSAR_SOURCE_JOINTS];
} dubsar_source_hand;

/* A puck's deflection, -1 .. 1 each, axes of the panel; it stays until the next one. */
typedef struct dubsar_source_puck {
  uint32_t size;
  uint32_t reserved;
  int64_t time_ns;
  double push[3], twist[3];
} dubsar_source_puck;

/* A key or button goes down or up. */
typedef struct dubsar_source_key {
  uint32_t size;
  uint32_t down;
  int64_t time_ns;
  char name[32]; /* NUL-terminated; as in docs/input.md: "home", "puck1" ... */
} dubsar_source_key;

/* Where read() puts what it has measured. Heads and hands of one read() belong together and replace the last ones. More
 * than 16 heads, 8 hands or 256 keys in one read() are dropped, and the source says so. */
typedef struct dubsar_source_sink {
  uint32_t size;
  uint32_t reserved;
  void* frame;
  void (*head)(void* frame, const dubsar_source_head* head);
  void (*hand)(void* frame, const dubsar_source_hand* hand);
  void (*puck)(void* frame, const dubsar_source_puck* puck);
  void (*key)(void* frame, const dubsar_source_key* key);
} dubsar_source_sink;

typedef struct dubsar_source_host {
  uint32_t abi, size;
  int64_t (*now_ns)(void); /* any thread */
  void (*log)(const char* text);
} dubsar_source_host;

enum { DUBSAR_SOURCE_NOTHING = 0, DUBSAR_SOURCE_NEW = 1, DUBSAR_SOURCE_LOST = -1 };

typedef struct dubsar_source_table {
  uint32_t abi, size;
  const char* name;    /* a-z, 0-9 and _, at most 32 characters */
  const char* summary; /* one line with the options */
  /* `options` are those that the program does not know, "key=value,..."; perhaps empty. NULL: `error` says why. */
  void* (*create)(const char* options, char* error, size_t error_size);
  void (*destroy)(void* source);
  /* Opens the device: 0, or why it is not there; tried again after 0.5, 1, 2 ... 10 s. */
  int (*open)(void* source, char* error, size_t error_size);
  void (*close)(void* source);
  /* Waits at most timeout_ms. DUBSAR_SOURCE_LOST: `error` says why; close() and open() follow. */
  int (*read)(void* source, uint32_t timeout_ms, const dubsar_source_sink* sink, char* error, size_t error_size);
} dubsar_source_table;

typedef const dubsar_source_table* (*dubsar_source_entry)(const dubsar_source_host* host);
/* NOLINTEND(readability-identifier-naming) */

#ifdef __cplusplus
}
#endif
#endif
