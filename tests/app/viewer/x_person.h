#pragma once
// Somebody at the desk of a test's X server: real mouse and key events through the XTEST extension, so that
// they take the way of a user's.

#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

namespace dubsar::testing {

class XPerson {
 public:
  /// Uses DISPLAY. X11 key codes are those of Xvfb's default (US) layout, by name: see key().
  XPerson() : connection_(xcb_connect(nullptr, nullptr)) {
    if (xcb_connection_has_error(connection_) == 0)
      root_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
  }
  ~XPerson() { xcb_disconnect(connection_); }
  XPerson(const XPerson&) = delete;
  XPerson& operator=(const XPerson&) = delete;
  bool here() const { return root_ != 0; }

  /// Keys go to the window under the pointer from now on, as there is no window manager that gives it the
  /// focus.
  void type_where_the_pointer_is() {
    xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_POINTER_ROOT, XCB_INPUT_FOCUS_POINTER_ROOT, XCB_CURRENT_TIME);
    xcb_flush(connection_);
  }
  void point(int x, int y) { fake(XCB_MOTION_NOTIFY, 0, x, y); }  ///< on the screen
  void press(int button) { fake(XCB_BUTTON_PRESS, button); }      ///< 1 left, 2 middle, 3 right, 4 and 5 the wheel
  void release(int button) { fake(XCB_BUTTON_RELEASE, button); }
  void hold(const std::string& name) { fake(XCB_KEY_PRESS, code(name)); }
  void let_go(const std::string& name) { fake(XCB_KEY_RELEASE, code(name)); }
  /// Waits a little before the same key again: GLFW takes a press within 20 ms of the release, while that is still in
  /// its queue, for a repetition of a held key, and nobody types so fast.
  void key(const std::string& name) {
    if (name == last_key_) std::this_thread::sleep_until(last_release_ + std::chrono::milliseconds(40));
    hold(name);
    let_go(name);
    settle();
    last_key_ = name;
    last_release_ = std::chrono::steady_clock::now();
  }
  /// Returns when the server has done all that was asked of it.
  void settle() { std::free(xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr)); }

  /// Another program's window over this part of the screen, until it ends.
  void cover(int x, int y, int width, int height) {
    cover_ = xcb_generate_id(connection_);
    const std::array<std::uint32_t, 2> values{0x00ff00ff, 1};  // background, override-redirect: no manager is asked
    xcb_create_window(connection_, XCB_COPY_FROM_PARENT, cover_, root_, static_cast<std::int16_t>(x),
                      static_cast<std::int16_t>(y), static_cast<std::uint16_t>(width),
                      static_cast<std::uint16_t>(height), 0, XCB_WINDOW_CLASS_INPUT_OUTPUT, XCB_COPY_FROM_PARENT,
                      XCB_CW_BACK_PIXEL | XCB_CW_OVERRIDE_REDIRECT, values.data());
    xcb_map_window(connection_, cover_);
    settle();
  }
  void uncover() {
    xcb_destroy_window(connection_, cover_);
    settle();
  }
  /// What a window manager does with the window of the session, the newest on the screen.
  void minimise() {
    xcb_unmap_window(connection_, newest());
    settle();
  }
  void restore() {
    xcb_map_window(connection_, newest());
    settle();
  }
  void resize(int width, int height) {
    const std::array<std::uint32_t, 2> values{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    xcb_configure_window(connection_, newest(), XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, values.data());
    settle();
  }

  /// What a window manager writes over the window of the session.
  std::string title() {
    const auto atom = [&](const char* name) {
      xcb_intern_atom_reply_t* const reply = xcb_intern_atom_reply(
          connection_, xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(std::strlen(name)), name), nullptr);
      const xcb_atom_t out = reply->atom;
      std::free(reply);
      return out;
    };
    constexpr std::uint32_t kMostWords = 64;
    xcb_get_property_reply_t* const reply = xcb_get_property_reply(
        connection_,
        xcb_get_property(connection_, 0, newest(), atom("_NET_WM_NAME"), atom("UTF8_STRING"), 0, kMostWords), nullptr);
    if (reply == nullptr) return {};
    std::string out(static_cast<const char*>(xcb_get_property_value(reply)),
                    static_cast<std::size_t>(xcb_get_property_value_length(reply)));
    std::free(reply);
    return out;
  }

 private:
  xcb_window_t newest() {
    xcb_query_tree_reply_t* const tree = xcb_query_tree_reply(connection_, xcb_query_tree(connection_, root_), nullptr);
    const int count = xcb_query_tree_children_length(tree);
    const xcb_window_t out = count > 0 ? xcb_query_tree_children(tree)[count - 1] : 0;
    std::free(tree);
    return out;
  }
  static int code(const std::string& name) {  // evdev codes + 8
    if (name == "escape") return 9;
    if (name == "1") return 10;
    if (name == "2") return 11;
    if (name == "3") return 12;
    if (name.size() == 1 && name[0] >= '4' && name[0] <= '9') return 13 + name[0] - '4';
    if (name == "0") return 19;
    if (name == "s") return 39;
    if (name == "a") return 38;
    if (name == "b") return 56;
    if (name == "d") return 40;
    if (name == "e") return 26;
    if (name == "i") return 31;
    if (name == "k") return 45;
    if (name == "n") return 57;
    if (name == "r") return 27;
    if (name == "v") return 55;
    if (name == "space") return 65;
    if (name == "enter") return 36;
    if (name == "f5") return 71;
    if (name == "slash") return 61;
    if (name == "h") return 43;
    if (name == "alt") return 64;
    if (name == "shift") return 50;
    if (name == "control") return 37;
    if (name == "super") return 133;
    if (name == "f1") return 67;
    if (name == "f2") return 68;
    if (name == "f11") return 95;
    if (name == "right") return 114;
    if (name == "left") return 113;
    if (name == "z") return 52;
    if (name == "x") return 53;
    if (name == "tab") return 23;
    if (name == "home") return 110;
    if (name == "end") return 115;
    return 0;
  }
  void fake(int type, int detail, int x = 0, int y = 0) {
    xcb_test_fake_input(connection_, static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(detail),
                        XCB_CURRENT_TIME, root_, static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), 0);
    xcb_flush(connection_);
  }
  xcb_connection_t* connection_;
  xcb_window_t root_ = 0, cover_ = 0;
  std::string last_key_;
  std::chrono::steady_clock::time_point last_release_;
};

}  // namespace dubsar::testing
