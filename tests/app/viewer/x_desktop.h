#pragma once
// What lies behind a full-screen window of a test's X server: it counts what reaches it. And somebody who does things
// at random.

#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string_view>

namespace dubsar::testing {

class XDesktop {
 public:
  /// Covers the screen with magenta. Uses DISPLAY; make it before the window that is to cover it.
  XDesktop() : connection_(xcb_connect(nullptr, nullptr)) {
    if (xcb_connection_has_error(connection_) != 0) return;
    const xcb_screen_t& screen = *xcb_setup_roots_iterator(xcb_get_setup(connection_)).data;
    root_ = screen.root;
    width_ = screen.width_in_pixels;
    height_ = screen.height_in_pixels;
    window_ = xcb_generate_id(connection_);
    const std::array<std::uint32_t, 3> values{0x00ff00ff, 1,
                                              XCB_EVENT_MASK_KEY_PRESS | XCB_EVENT_MASK_BUTTON_PRESS |
                                                  XCB_EVENT_MASK_POINTER_MOTION | XCB_EVENT_MASK_ENTER_WINDOW};
    xcb_create_window(connection_, XCB_COPY_FROM_PARENT, window_, root_, 0, 0, width_, height_, 0,
                      XCB_WINDOW_CLASS_INPUT_OUTPUT, XCB_COPY_FROM_PARENT,
                      XCB_CW_BACK_PIXEL | XCB_CW_OVERRIDE_REDIRECT | XCB_CW_EVENT_MASK, values.data());
    xcb_map_window(connection_, window_);
    settle();
  }
  ~XDesktop() { xcb_disconnect(connection_); }
  XDesktop(const XDesktop&) = delete;
  XDesktop& operator=(const XDesktop&) = delete;

  /// Events that came here since the last call.
  int reached() {
    settle();
    int count = 0;
    while (xcb_generic_event_t* const event = xcb_poll_for_event(connection_)) {
      count += (event->response_type & 0x7f) >= XCB_KEY_PRESS && (event->response_type & 0x7f) <= XCB_ENTER_NOTIFY;
      std::free(event);
    }
    return count;
  }
  /// One thing at random: a key of all that a keyboard may have, a button, a place, or a request to close the window.
  void anything(std::mt19937& random) {
    const auto below = [&](unsigned n) { return static_cast<std::uint8_t>(random() % n); };
    switch (random() % 8) {
      case 0:
      case 1:
      case 2:
        return fake(XCB_KEY_PRESS, static_cast<std::uint8_t>(9 + below(240)));
      case 3:
        return fake(XCB_KEY_RELEASE, static_cast<std::uint8_t>(9 + below(240)));
      case 4:
        return fake(XCB_BUTTON_PRESS, static_cast<std::uint8_t>(1 + below(9)));
      case 5:
        return fake(XCB_BUTTON_RELEASE, static_cast<std::uint8_t>(1 + below(9)));
      case 6:
        return fake(XCB_MOTION_NOTIFY, 0, static_cast<int>(random() % width_), static_cast<int>(random() % height_));
      default:
        return close_newest();
    }
  }
  /// No key and no button is down any more.
  void let_go() {
    for (int code = 9; code < 256; ++code) fake(XCB_KEY_RELEASE, static_cast<std::uint8_t>(code));
    for (int button = 1; button < 10; ++button) fake(XCB_BUTTON_RELEASE, static_cast<std::uint8_t>(button));
    settle();
  }
  /// Returns when the server has done all that was asked of it.
  void settle() { std::free(xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr)); }

 private:
  /// What a window manager sends when somebody closes the window.
  void close_newest() {
    xcb_query_tree_reply_t* const tree = xcb_query_tree_reply(connection_, xcb_query_tree(connection_, root_), nullptr);
    const int count = xcb_query_tree_children_length(tree);
    const xcb_window_t newest = count > 0 ? xcb_query_tree_children(tree)[count - 1] : 0;
    std::free(tree);
    if (newest == window_ || newest == 0) return;
    xcb_client_message_event_t event{};
    event.response_type = XCB_CLIENT_MESSAGE;
    event.format = 32;
    event.window = newest;
    event.type = atom("WM_PROTOCOLS");
    event.data.data32[0] = atom("WM_DELETE_WINDOW");
    std::array<char, 32> bytes{};
    static_assert(sizeof event == bytes.size());
    std::copy_n(reinterpret_cast<const char*>(&event), bytes.size(), bytes.data());
    xcb_send_event(connection_, 0, newest, XCB_EVENT_MASK_NO_EVENT, bytes.data());
    xcb_flush(connection_);
  }
  xcb_atom_t atom(std::string_view name) {
    xcb_intern_atom_reply_t* const reply = xcb_intern_atom_reply(
        connection_, xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(name.size()), name.data()), nullptr);
    const xcb_atom_t out = reply == nullptr ? 0 : reply->atom;
    std::free(reply);
    return out;
  }
  void fake(int type, std::uint8_t detail, int x = 0, int y = 0) {
    xcb_test_fake_input(connection_, static_cast<std::uint8_t>(type), detail, XCB_CURRENT_TIME, root_,
                        static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), 0);
    xcb_flush(connection_);
  }
  xcb_connection_t* connection_;
  xcb_window_t root_ = 0, window_ = 0;
  std::uint16_t width_ = 1, height_ = 1;
};

}  // namespace dubsar::testing
