/* An input that lives outside of dubsar: a made-up depth camera on top of the panel that sees one person. A real one
 * (RealSense, Orbbec, OAK) would fill `depth` in capture() from its SDK; finding the head stays the same.
 * `dubsar view tablet.exa --input plugin:libdepth_camera.so,at=0/107/0,ipd=63` */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "source_plugin_abi.h"

enum { kWidth = 80, kHeight = 60 };
static const double kFocal_px = 70.0; /* 59 degrees wide */
static const double kHeadRadius_m = 0.09;

typedef struct {
  double half_ipd_m;
  int64_t opened_ns, frame;
  float depth_m[kHeight][kWidth];
} depth_camera;

static const dubsar_source_host* host;

static void* create(const char* options, char* error, size_t error_size) {
  double ipd_mm = 63.0;
  char rest;
  if (options[0] != '\0' && (sscanf(options, "ipd=%lf%c", &ipd_mm, &rest) != 1 || !(ipd_mm >= 40.0 && ipd_mm <= 90.0))) {
    snprintf(error, error_size, "\"%s\" found, expected ipd=MM, 40 to 90", options);
    return NULL;
  }
  depth_camera* camera = calloc(1, sizeof(depth_camera));
  if (camera == NULL) {
    snprintf(error, error_size, "out of memory");
    return NULL;
  }
  camera->half_ipd_m = 0.0005 * ipd_mm;
  return camera;
}

static void destroy(void* self) { free(self); }

static int open_camera(void* self, char* error, size_t error_size) {
  depth_camera* camera = self;
  (void)error;
  (void)error_size;
  camera->opened_ns = host->now_ns();
  camera->frame = -1;
  return 0;
}

static void close_camera(void* self) { (void)self; }

/* A wall at 2 m and a head that sways 150 mm to both sides, 600 mm away. */
static void capture(depth_camera* camera, double t_s) {
  const double x = 0.15 * sin(t_s), y = -0.05, z = 0.6;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const double px = (u + 0.5 - kWidth / 2) / kFocal_px * z - x, py = (kHeight / 2 - v - 0.5) / kFocal_px * z - y;
      camera->depth_m[v][u] = (float)(px * px + py * py < kHeadRadius_m * kHeadRadius_m ? z : 2.0);
    }
}

/* 30 pictures a second; the middle of what is nearer than 1 m is the head. */
static int read_camera(void* self, uint32_t timeout_ms, const dubsar_source_sink* sink, char* error, size_t error_size) {
  depth_camera* camera = self;
  const int64_t now = host->now_ns(), frame = (now - camera->opened_ns) / 33333333;
  double u_sum = 0.0, v_sum = 0.0, z_sum = 0.0, count = 0.0;
  (void)timeout_ms; /* a real camera waits here for its picture */
  (void)error;
  (void)error_size;
  if (frame == camera->frame) return DUBSAR_SOURCE_NOTHING;
  camera->frame = frame;
  capture(camera, 1e-9 * (double)(now - camera->opened_ns));
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u)
      if (camera->depth_m[v][u] < 1.0f) {
        u_sum += u + 0.5;
        v_sum += v + 0.5;
        z_sum += (double)camera->depth_m[v][u];
        count += 1.0;
      }
  if (count < 20.0) return DUBSAR_SOURCE_NEW; /* nobody there */
  dubsar_source_head head = {0};
  const double z = z_sum / count;
  const double x = (u_sum / count - kWidth / 2) / kFocal_px * z, y = (kHeight / 2 - v_sum / count) / kFocal_px * z;
  head.size = sizeof head;
  head.id = 1;
  head.flags = DUBSAR_SOURCE_TRACKED | DUBSAR_SOURCE_LEFT_EYE | DUBSAR_SOURCE_RIGHT_EYE;
  head.time_ns = now;
  head.confidence = 1.0;
  head.left_eye_m[0] = x - camera->half_ipd_m;
  head.right_eye_m[0] = x + camera->half_ipd_m;
  head.left_eye_m[1] = head.right_eye_m[1] = y;
  head.left_eye_m[2] = head.right_eye_m[2] = z;
  sink->head(sink->frame, &head);
  return DUBSAR_SOURCE_NEW;
}

static const dubsar_source_table table = {DUBSAR_SOURCE_ABI,
                                          sizeof(dubsar_source_table),
                                          "depth_camera",
                                          "a made-up depth camera: ipd=MM",
                                          create,
                                          destroy,
                                          open_camera,
                                          close_camera,
                                          read_camera};

#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const dubsar_source_table*
dubsar_source_plugin(const dubsar_source_host* given) {
  if (given->abi != DUBSAR_SOURCE_ABI || given->size < sizeof(dubsar_source_host)) return NULL;
  host = given;
  return &table;
}
