#include "display/render/context/window_recall.h"

#include <xcb/xcb.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <string_view>

namespace dubsar {
namespace {

constexpr std::uint32_t kAdd = 1, kPager = 2, kAllDesktops = 0xffffffff;  // EWMH 1.5
constexpr xcb_atom_t kNoAtom = XCB_ATOM_NONE;

struct Free {
  void operator()(void* reply) const noexcept { std::free(reply); }
};
template <typename Reply>
using Replied = std::unique_ptr<Reply, Free>;

class Asker {
 public:
  Asker() : connection_(xcb_connect(nullptr, nullptr)) {}
  ~Asker() { xcb_disconnect(connection_); }
  Asker(const Asker&) = delete;
  Asker& operator=(const Asker&) = delete;

  /// The root of its screen; 0: there is no such window.
  xcb_window_t root_of(xcb_window_t window) {
    if (xcb_connection_has_error(connection_) != 0) return 0;
    const Replied<xcb_get_geometry_reply_t> reply(
        xcb_get_geometry_reply(connection_, xcb_get_geometry(connection_, window), nullptr));
    return reply ? reply->root : 0;
  }
  xcb_atom_t atom(std::string_view name) {
    const Replied<xcb_intern_atom_reply_t> reply(xcb_intern_atom_reply(
        connection_, xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(name.size()), name.data()), nullptr));
    return reply ? reply->atom : kNoAtom;
  }
  void ask_manager(xcb_window_t root, xcb_window_t window, std::string_view what,
                   const std::array<std::uint32_t, 5>& with) {
    xcb_client_message_event_t event{};
    event.response_type = XCB_CLIENT_MESSAGE;
    event.format = 32;
    event.window = window;
    event.type = atom(what);
    for (std::size_t i = 0; i < with.size(); ++i) event.data.data32[i] = with[i];
    xcb_send_event(connection_, 0, root, XCB_EVENT_MASK_SUBSTRUCTURE_REDIRECT | XCB_EVENT_MASK_SUBSTRUCTURE_NOTIFY,
                   reinterpret_cast<const char*>(&event));
  }
  void raise(xcb_window_t window) {
    const std::uint32_t above = XCB_STACK_MODE_ABOVE;
    xcb_map_window(connection_, window);
    xcb_configure_window(connection_, window, XCB_CONFIG_WINDOW_STACK_MODE, &above);
  }
  void give_keyboard(xcb_window_t window) {
    xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_POINTER_ROOT, window, XCB_CURRENT_TIME);
  }
  /// Returns when the server has done what it was asked.
  void settle() {
    const Replied<xcb_get_input_focus_reply_t> reply(
        xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr));
  }

 private:
  xcb_connection_t* connection_;
};

}  // namespace

void recall_window(std::uint32_t window, bool covers, bool keyboard) {
  Asker x;
  const xcb_window_t root = x.root_of(window);
  if (root == 0) return;
  x.ask_manager(root, root, "_NET_SHOWING_DESKTOP", {0});
  x.ask_manager(root, window, "_NET_WM_DESKTOP", {kAllDesktops, kPager});
  x.raise(window);
  x.ask_manager(root, window, "_NET_WM_STATE",
                {kAdd, x.atom("_NET_WM_STATE_ABOVE"), covers ? x.atom("_NET_WM_STATE_FULLSCREEN") : kNoAtom, kPager});
  if (keyboard) {
    x.ask_manager(root, window, "_NET_ACTIVE_WINDOW", {kPager, XCB_CURRENT_TIME});
    x.give_keyboard(window);
  }
  x.settle();
}

}  // namespace dubsar
