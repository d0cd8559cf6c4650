// A plug-in that does what none should; its option says what.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include "source_plugin_abi.h"

namespace {

const dubsar_source_host* host = nullptr;

void* create(const char* options, char* error, size_t error_size) {
  if (std::strcmp(options, "throw_create") == 0) throw std::runtime_error("no memory for a camera");
  if (std::strcmp(options, "refuse") == 0) {
    std::snprintf(error, error_size, "it does not want to");
    return nullptr;
  }
  return new std::string(options);
}
void destroy(void* self) { delete static_cast<std::string*>(self); }

int open(void* self, char* error, size_t error_size) {
  const std::string& way = *static_cast<std::string*>(self);
  if (way == "throw_open") throw 7;
  if (way == "absent") return std::snprintf(error, error_size, "no camera is plugged in");
  return 0;
}
void close(void*) {}

int read(void* self, uint32_t, const dubsar_source_sink* sink, char* error, size_t error_size) {
  const std::string& way = *static_cast<std::string*>(self);
  if (way == "throw_read") throw std::logic_error("index 7 of 3");
  if (way == "block") std::this_thread::sleep_for(std::chrono::seconds(5));
  if (way == "stall") std::this_thread::sleep_for(std::chrono::milliseconds(40));  // twice what it was told
  if (way == "lost") {
    std::memset(error, 'x', error_size);  // without an end
    return DUBSAR_SOURCE_LOST;
  }
  dubsar_source_head head{};
  head.size = sizeof head;
  head.flags = DUBSAR_SOURCE_TRACKED | DUBSAR_SOURCE_LEFT_EYE | DUBSAR_SOURCE_RIGHT_EYE;
  head.left_eye_m[2] = head.right_eye_m[2] = 0.6;
  if (way == "nan") head.left_eye_m[0] = std::nan("");
  if (way == "short") head.size = 8;
  if (way == "future") head.time_ns = host->now_ns() + 1000000000000;
  dubsar_source_key key{};
  key.size = sizeof key;
  key.down = 1;
  std::strcpy(key.name, "home");
  const int times = way == "flood" ? 5000 : 1;
  for (int i = 0; i < times; ++i) {
    sink->head(sink->frame, &head);
    sink->key(sink->frame, &key);
  }
  return DUBSAR_SOURCE_NEW;
}

const dubsar_source_table kTable{DUBSAR_SOURCE_ABI,
                                 sizeof(dubsar_source_table),
                                 "unruly",
                                 "does what none should",
                                 create,
                                 destroy,
                                 open,
                                 close,
                                 read};

}  // namespace

extern "C" const dubsar_source_table* dubsar_source_plugin(const dubsar_source_host* given) {
  host = given;
  return &kTable;
}
