#pragma once
// A window manager as people have it, on a test's X server: openbox with the keys that Debian gives it. And what it is
// asked by those who hide windows.

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xcb/xcb.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>

namespace dubsar::testing {

class XManager {
 public:
  /// Uses DISPLAY, ended by the destructor; none of its own or its user's settings are read.
  XManager() : connection_(xcb_connect(nullptr, nullptr)) {
    if (xcb_connection_has_error(connection_) != 0) return;
    root_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
    settings_ = std::filesystem::temp_directory_path() / ("dubsar_openbox_" + std::to_string(::getpid()));
    std::filesystem::create_directories(settings_);
    process_ = ::fork();
    if (process_ == 0) {
      const int nothing = ::open("/dev/null", O_RDWR);
      for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
      for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME"})
        ::setenv(name, settings_.c_str(), 1);
      ::execlp("openbox", "openbox", "--sm-disable", nullptr);
      ::_exit(127);
    }
    for (int i = 0; i < 200 && !manages(); ++i) {
      if (::waitpid(process_, nullptr, WNOHANG) == process_) {
        process_ = -1;
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  ~XManager() {
    if (process_ > 0) {
      ::kill(process_, SIGTERM);
      ::waitpid(process_, nullptr, 0);
    }
    xcb_disconnect(connection_);
    std::filesystem::remove_all(settings_);
  }
  XManager(const XManager&) = delete;
  XManager& operator=(const XManager&) = delete;

  /// Empty: it manages windows; else why not.
  std::string problem() const { return process_ > 0 ? "" : "openbox cannot be started; install openbox"; }

  /// What a button to minimise a window asks for.
  void minimise(xcb_window_t window) { ask(window, "WM_CHANGE_STATE", {3}); }
  /// What "send to desktop" asks for.
  void send_to_desktop(xcb_window_t window, std::uint32_t desktop) { ask(window, "_NET_WM_DESKTOP", {desktop, 2}); }
  /// The window that the manager gave the keys; 0: none of its own.
  xcb_window_t active() { return number_of(root_, "_NET_ACTIVE_WINDOW", XCB_ATOM_WINDOW); }

 private:
  xcb_atom_t atom(std::string_view name) {
    xcb_intern_atom_reply_t* const reply = xcb_intern_atom_reply(
        connection_, xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(name.size()), name.data()), nullptr);
    const xcb_atom_t out = reply != nullptr ? reply->atom : 0;
    std::free(reply);
    return out;
  }
  std::uint32_t number_of(xcb_window_t window, std::string_view name, xcb_atom_t type) {
    xcb_get_property_reply_t* const reply =
        xcb_get_property_reply(connection_, xcb_get_property(connection_, 0, window, atom(name), type, 0, 1), nullptr);
    std::uint32_t out = 0;
    if (reply != nullptr && xcb_get_property_value_length(reply) == 4)
      out = *static_cast<const std::uint32_t*>(xcb_get_property_value(reply));
    std::free(reply);
    return out;
  }
  bool manages() { return number_of(root_, "_NET_SUPPORTING_WM_CHECK", XCB_ATOM_WINDOW) != 0; }
  void ask(xcb_window_t window, std::string_view what, const std::array<std::uint32_t, 5>& with) {
    xcb_client_message_event_t event{};
    event.response_type = XCB_CLIENT_MESSAGE;
    event.format = 32;
    event.window = window;
    event.type = atom(what);
    for (std::size_t i = 0; i < with.size(); ++i) event.data.data32[i] = with[i];
    xcb_send_event(connection_, 0, root_, XCB_EVENT_MASK_SUBSTRUCTURE_REDIRECT | XCB_EVENT_MASK_SUBSTRUCTURE_NOTIFY,
                   reinterpret_cast<const char*>(&event));
    xcb_flush(connection_);
  }

  xcb_connection_t* connection_;
  xcb_window_t root_ = 0;
  std::filesystem::path settings_;
  pid_t process_ = -1;
};

}  // namespace dubsar::testing
