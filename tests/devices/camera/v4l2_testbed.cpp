#include "tests/devices/camera/v4l2_testbed.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace dubsar {
namespace {

constexpr std::uint32_t kBuffers = 4;
constexpr std::size_t kPage = 4096;

std::string folder(int number) {
  return fmt::format("/devices/pci0000:00/usb1/1-1/1-1:1.0/video4linux/video{}", number);
}

template <std::size_t N>
void write_name(std::uint8_t (&to)[N], const char* name) {
  std::memcpy(to, name, std::min(N, std::strlen(name) + 1));
}

}  // namespace

V4l2Testbed::V4l2Testbed() : testbed_(umockdev_testbed_new()), handler_(umockdev_ioctl_base_new()) {
  g_signal_connect(handler_, "handle-ioctl", reinterpret_cast<GCallback>(on_ioctl), this);
}

V4l2Testbed::~V4l2Testbed() {
  unplug();
  g_object_unref(handler_);
  g_object_unref(testbed_);
}

std::string V4l2Testbed::node() const { return fmt::format("/dev/video{}", numbers_.front()); }

void V4l2Testbed::add_node(int number) {
  const std::string text = fmt::format(
      "P: {0}\nN: video{1}=00\nE: DEVNAME=/dev/video{1}\nE: SUBSYSTEM=video4linux\nE: MAJOR=81\nE: "
      "MINOR={1}\n"
      "A: dev=81:{1}\\n\nA: name=Simulated Webcam\\n\nA: index=0\\n\n\n",
      folder(number), number);
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(testbed_, text.c_str(), &error)) throw std::runtime_error(error->message);
  const std::string path = fmt::format("/dev/video{}", number);
  if (!umockdev_testbed_attach_ioctl(testbed_, path.c_str(), handler_, &error))
    throw std::runtime_error(error->message);
  numbers_.push_back(number);
}

void V4l2Testbed::plug_metadata_node(int number) {
  metadata_number_ = number;
  add_node(number);
}

void V4l2Testbed::plug(int number, Picture picture) {
  {
    const std::lock_guard lock(mutex_);
    picture_ = std::move(picture);
    queue_.clear();
  }
  add_node(number);
  std::rotate(numbers_.begin(), numbers_.end() - 1, numbers_.end());
  // the node is a regular file that the buffers' offsets point into, so that mmap works
  char* const root = umockdev_testbed_get_root_dir(testbed_);
  const std::string path = root + node();
  g_free(root);
  pitch_ = (picture_.bytes.size() + kPage - 1) / kPage * kPage;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0 || ::ftruncate(file, static_cast<::off_t>(pitch_ * kBuffers)) != 0)
    throw std::runtime_error("node file");
  void* const memory = ::mmap(nullptr, pitch_ * kBuffers, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) throw std::runtime_error("mmap");
  memory_ = static_cast<std::uint8_t*>(memory);
  plugged_ = true;
}

void V4l2Testbed::unplug() {
  plugged_ = false;
  const std::lock_guard lock(mutex_);
  for (const int number : numbers_) {
    umockdev_testbed_detach_ioctl(testbed_, fmt::format("/dev/video{}", number).c_str(), nullptr);
    const std::string sysfs = "/sys" + folder(number);
    umockdev_testbed_uevent(testbed_, sysfs.c_str(), "remove");
    umockdev_testbed_remove_device(testbed_, sysfs.c_str());
  }
  numbers_.clear();
  metadata_number_ = -1;
  if (memory_ != nullptr) ::munmap(memory_, pitch_ * kBuffers);
  memory_ = nullptr;
}

std::vector<std::uint32_t> V4l2Testbed::formats_asked_for() {
  const std::lock_guard lock(mutex_);
  return asked_;
}

template <class T, class Answer>
gboolean V4l2Testbed::answer(UMockdevIoctlClient* client, const Answer& answer) {
  UMockdevIoctlData* const memory =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(T), nullptr);
  T value;
  std::memcpy(&value, memory->data, sizeof value);
  const int error = answer(value);
  if (error == 0) umockdev_ioctl_data_update(memory, 0, reinterpret_cast<guint8*>(&value), sizeof value);
  g_object_unref(memory);
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  return TRUE;
}

/// Blocks as a camera does between two pictures: select() always finds the node ready.
int V4l2Testbed::dequeue(v4l2_buffer& buffer) {
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  while (silent_ && plugged_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::lock_guard lock(mutex_);
  if (!plugged_ || memory_ == nullptr) return ENODEV;
  if (queue_.empty()) return EAGAIN;
  const std::uint32_t index = queue_.front();
  queue_.pop_front();
  std::memcpy(memory_ + index * pitch_, picture_.bytes.data(), picture_.bytes.size());
  buffer.index = index;
  buffer.bytesused = static_cast<std::uint32_t>(picture_.bytes.size());
  buffer.length = static_cast<std::uint32_t>(pitch_);
  buffer.m.offset = static_cast<std::uint32_t>(index * pitch_);
  buffer.sequence = sequence_++;
  buffer.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  return 0;
}

gboolean V4l2Testbed::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self_pointer) {
  auto& self = *static_cast<V4l2Testbed*>(self_pointer);
  const auto request = static_cast<unsigned>(umockdev_ioctl_client_get_request(client));
  if (!self.plugged_ && self.metadata_number_ < 0) {
    umockdev_ioctl_client_complete(client, -1, ENODEV);
    return TRUE;
  }
  // umockdev does not say which node was asked; the metadata node is only ever asked what it can do
  switch (request) {
    case static_cast<unsigned>(VIDIOC_QUERYCAP):
      return self.answer<v4l2_capability>(client, [&](v4l2_capability& v) {
        v = {};
        write_name(v.driver, "uvcvideo");
        write_name(v.card, "Simulated Webcam");
        v.device_caps = (self.plugged_ ? V4L2_CAP_VIDEO_CAPTURE : V4L2_CAP_META_CAPTURE) | V4L2_CAP_STREAMING;
        v.capabilities = v.device_caps | V4L2_CAP_DEVICE_CAPS;
        return 0;
      });
    case static_cast<unsigned>(VIDIOC_G_FMT):
    case static_cast<unsigned>(VIDIOC_S_FMT):
    case static_cast<unsigned>(VIDIOC_TRY_FMT):
      return self.answer<v4l2_format>(client, [&](v4l2_format& v) {
        const std::lock_guard lock(self.mutex_);
        auto& pixels = v.fmt.pix;
        if (request == static_cast<unsigned>(VIDIOC_S_FMT)) self.asked_.push_back(pixels.pixelformat);
        pixels.pixelformat = self.picture_.pixel_format;
        pixels.width = static_cast<std::uint32_t>(self.picture_.width);
        pixels.height = static_cast<std::uint32_t>(self.picture_.height);
        pixels.bytesperline = pixels.pixelformat == V4L2_PIX_FMT_YUYV ? 2 * pixels.width : 0;
        pixels.sizeimage = static_cast<std::uint32_t>(self.picture_.bytes.size());
        pixels.field = V4L2_FIELD_NONE;
        return 0;
      });
    case static_cast<unsigned>(VIDIOC_G_PARM):
    case static_cast<unsigned>(VIDIOC_S_PARM):
      return self.answer<v4l2_streamparm>(client, [](v4l2_streamparm& v) {
        v.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
        v.parm.capture.timeperframe = {1, 100};
        return 0;
      });
    case static_cast<unsigned>(VIDIOC_G_INPUT):
    case static_cast<unsigned>(VIDIOC_S_INPUT):
      return self.answer<int>(client, [](int& v) { return v = 0; });
    case static_cast<unsigned>(VIDIOC_ENUMINPUT):
      return self.answer<v4l2_input>(client, [](v4l2_input& v) {
        v.type = V4L2_INPUT_TYPE_CAMERA;
        return v.index == 0 ? 0 : EINVAL;
      });
    case static_cast<unsigned>(VIDIOC_REQBUFS):
      return self.answer<v4l2_requestbuffers>(client, [&](v4l2_requestbuffers& v) {
        const std::lock_guard lock(self.mutex_);
        v.count = std::min(v.count, kBuffers);
        self.queue_.clear();
        return 0;
      });
    case static_cast<unsigned>(VIDIOC_QUERYBUF):
      return self.answer<v4l2_buffer>(client, [&](v4l2_buffer& v) {
        v.length = static_cast<std::uint32_t>(self.pitch_);
        v.m.offset = static_cast<std::uint32_t>(v.index * self.pitch_);
        return v.index < kBuffers ? 0 : EINVAL;
      });
    case static_cast<unsigned>(VIDIOC_QBUF):
      return self.answer<v4l2_buffer>(client, [&](v4l2_buffer& v) {
        const std::lock_guard lock(self.mutex_);
        self.queue_.push_back(v.index);
        return 0;
      });
    case static_cast<unsigned>(VIDIOC_DQBUF):
      return self.answer<v4l2_buffer>(client, [&](v4l2_buffer& v) { return self.dequeue(v); });
    case static_cast<unsigned>(VIDIOC_STREAMON):
    case static_cast<unsigned>(VIDIOC_STREAMOFF):
      umockdev_ioctl_client_complete(client, 0, 0);
      return TRUE;
    default:
      umockdev_ioctl_client_complete(client, -1, ENOTTY);
      return TRUE;
  }
}

}  // namespace dubsar
