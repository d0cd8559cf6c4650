#pragma once
// A webcam of the simulated kernel: a Video4Linux node whose requests are answered here. Needs
// libumockdev-preload.

#include <linux/videodev2.h>
#include <umockdev.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace dubsar {

class V4l2Testbed {
 public:
  struct Picture {
    std::uint32_t pixel_format = V4L2_PIX_FMT_MJPEG;
    int width = 0, height = 0;
    std::vector<std::byte> bytes;  ///< as the camera sends them
  };

  V4l2Testbed();
  ~V4l2Testbed();
  V4l2Testbed(const V4l2Testbed&) = delete;
  V4l2Testbed& operator=(const V4l2Testbed&) = delete;

  /// /dev/videoNUMBER delivers this picture 100 times a second.
  void plug(int number, Picture picture);
  /// A node without pictures, as webcams have for metadata.
  void plug_metadata_node(int number);
  void unplug();
  /// No picture comes any more, but the device is there.
  void set_silent(bool silent) { silent_ = silent; }

  std::vector<std::uint32_t> formats_asked_for();

 private:
  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  void add_node(int number);
  template <class T, class Answer>
  gboolean answer(UMockdevIoctlClient* client, const Answer& answer);
  int dequeue(v4l2_buffer& buffer);
  std::string node() const;

  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  std::mutex mutex_;
  Picture picture_;
  std::vector<int> numbers_;
  int metadata_number_ = -1;
  std::uint8_t* memory_ = nullptr;
  std::size_t pitch_ = 0;
  std::deque<std::uint32_t> queue_;
  std::uint32_t sequence_ = 0;
  std::vector<std::uint32_t> asked_;
  std::atomic<bool> plugged_{false}, silent_{false};
};

}  // namespace dubsar
