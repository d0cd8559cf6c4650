#include "tests/devices/transport/evdev_testbed.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>

namespace dubsar {

EvdevTestbed::EvdevTestbed()
    : testbed_(umockdev_testbed_new()), handler_(umockdev_ioctl_base_new()), id_(kSlots, -1), x_(kSlots), y_(kSlots) {
  g_signal_connect(handler_, "handle-ioctl", reinterpret_cast<GCallback>(on_ioctl), this);
}

EvdevTestbed::~EvdevTestbed() {
  unplug();
  g_object_unref(handler_);
  g_object_unref(testbed_);
}

std::string EvdevTestbed::folder() const { return fmt::format("/devices/platform/panel/input/input{}", plugging_); }
std::string EvdevTestbed::node() const { return fmt::format("/dev/input/event{}", plugging_); }

std::string EvdevTestbed::node_in_testbed() const {
  char* const root = umockdev_testbed_get_root_dir(testbed_);
  std::string path = root + node();
  g_free(root);
  return path;
}

void EvdevTestbed::plug(const InputIdentity& identity) {
  ++plugging_;
  const std::string text = fmt::format(
      "P: {0}\nE: SUBSYSTEM=input\nA: name={2}\\n\nA: properties={3}\\n\nA: capabilities/abs={4}\\n\n"
      "A: id/vendor={5:04x}\\n\nA: id/product={6:04x}\\n\n\n"
      "P: {0}/event{1}\nN: input/event{1}\nE: DEVNAME=/dev/input/event{1}\nE: SUBSYSTEM=input\nE: MAJOR=13\n"
      "E: MINOR={7}\nA: dev=13:{7}\\n\nL: device=../../input{1}\n\n",
      folder(), plugging_, identity.name, identity.properties, identity.axes, identity.vendor, identity.product,
      64 + plugging_);
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(testbed_, text.c_str(), &error)) throw std::runtime_error(error->message);
  if (!umockdev_testbed_attach_ioctl(testbed_, node().c_str(), handler_, &error))
    throw std::runtime_error(error->message);
  const std::string real = node_in_testbed();
  ::unlink(real.c_str());
  if (::mkfifo(real.c_str(), 0666) != 0) throw std::runtime_error("mkfifo");
  fifo_ = ::open(real.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fifo_ < 0) throw std::runtime_error("FIFO");
}

void EvdevTestbed::unplug() {
  if (fifo_ < 0) return;
  ::close(fifo_);
  fifo_ = -1;
  umockdev_testbed_detach_ioctl(testbed_, node().c_str(), nullptr);
  const std::string leaf = fmt::format("/sys{}/event{}", folder(), plugging_);
  umockdev_testbed_uevent(testbed_, leaf.c_str(), "remove");
  umockdev_testbed_remove_device(testbed_, leaf.c_str());
  umockdev_testbed_remove_device(testbed_, ("/sys" + folder()).c_str());
  ::unlink(node_in_testbed().c_str());
}

bool EvdevTestbed::send(int type, int code, int value) {
  input_event event{};
  event.input_event_sec = 5;
  event.type = static_cast<__u16>(type);
  event.code = static_cast<__u16>(code);
  event.value = value;
  return ::write(fifo_, &event, sizeof event) == static_cast<::ssize_t>(sizeof event);
}

void EvdevTestbed::set_slot(int slot, int id, int x, int y) {
  const std::lock_guard lock(mutex_);
  const auto s = static_cast<std::size_t>(slot);
  id_[s] = id;
  x_[s] = x;
  y_[s] = y;
}

void EvdevTestbed::hold_elsewhere(bool held) {
  const std::lock_guard lock(mutex_);
  held_elsewhere_ = held;
}

int EvdevTestbed::grabs() {
  const std::lock_guard lock(mutex_);
  return grabs_;
}

gboolean EvdevTestbed::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self_pointer) {
  auto* const self = static_cast<EvdevTestbed*>(self_pointer);
  const gulong request = umockdev_ioctl_client_get_request(client);
  const std::size_t size = _IOC_SIZE(request);
  if (_IOC_TYPE(request) != 'E') return FALSE;
  const std::lock_guard lock(self->mutex_);
  const auto memory = [&](std::size_t bytes) {
    return umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, bytes, nullptr);
  };
  if (request == EVIOCGRAB) {
    self->grabs_ += self->held_elsewhere_ ? 0 : 1;
    umockdev_ioctl_client_complete(client, self->held_elsewhere_ ? -1 : 0, self->held_elsewhere_ ? EBUSY : 0);
    return TRUE;
  }
  const auto number = static_cast<unsigned>(_IOC_NR(request));
  if (number >= _IOC_NR(EVIOCGABS(0)) && number < _IOC_NR(EVIOCGABS(0)) + ABS_CNT) {
    const auto axis = static_cast<unsigned>(number - _IOC_NR(EVIOCGABS(0)));
    input_absinfo info{};
    info.maximum = axis == ABS_MT_SLOT         ? kSlots - 1
                   : axis == ABS_MT_POSITION_X ? 4095
                   : axis == ABS_MT_POSITION_Y ? 2047
                                               : 65535;
    UMockdevIoctlData* const to = memory(sizeof info);
    umockdev_ioctl_data_update(to, 0, reinterpret_cast<guint8*>(&info), sizeof info);
    g_object_unref(to);
    umockdev_ioctl_client_complete(client, 0, 0);
    return TRUE;
  }
  if (number == _IOC_NR(EVIOCGMTSLOTS(0))) {
    UMockdevIoctlData* const to = memory(size);
    std::vector<int> words(size / sizeof(int));
    std::copy_n(reinterpret_cast<const int*>(to->data), words.size(), words.begin());
    const std::vector<int>* const values = words[0] == ABS_MT_TRACKING_ID  ? &self->id_
                                           : words[0] == ABS_MT_POSITION_X ? &self->x_
                                           : words[0] == ABS_MT_POSITION_Y ? &self->y_
                                                                           : nullptr;
    for (std::size_t s = 0; s + 1 < words.size(); ++s) words[s + 1] = values != nullptr ? (*values)[s] : 0;
    umockdev_ioctl_data_update(to, 0, reinterpret_cast<guint8*>(words.data()), static_cast<gint>(size));
    g_object_unref(to);
    umockdev_ioctl_client_complete(client, 0, 0);
    return TRUE;
  }
  umockdev_ioctl_client_complete(client, number == _IOC_NR(EVIOCSCLOCKID) ? 0 : -1,
                                 number == _IOC_NR(EVIOCSCLOCKID) ? 0 : ENOTTY);
  return TRUE;
}

}  // namespace dubsar
