#pragma once
// A file manager on a test's X server that lets files fall on the newest window: the source's side of the XDND
// protocol, version 5 (freedesktop.org).

#include <poll.h>
#include <xcb/xcb.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace dubsar::testing {

/// Lets files fall, in a thread, as the window takes them while its events are taken. The destructor does not wait for
/// a window that is gone.
class XDrop {
 public:
  explicit XDrop(const std::vector<std::string>& files) {
    for (const std::string& file : files) list_ += "file://" + file + "\r\n";
    thread_ = std::jthread([this](const std::stop_token& over) { run(over); });
  }

 private:
  xcb_atom_t atom(const char* name) {
    xcb_intern_atom_reply_t* const reply = xcb_intern_atom_reply(
        connection_, xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(std::strlen(name)), name), nullptr);
    const xcb_atom_t out = reply->atom;
    std::free(reply);
    return out;
  }
  void say(const char* type, const std::array<std::uint32_t, 5>& data) {
    xcb_client_message_event_t event{};
    event.response_type = XCB_CLIENT_MESSAGE;
    event.format = 32;
    event.window = target_;
    event.type = atom(type);
    std::memcpy(event.data.data32, data.data(), sizeof(data));
    xcb_send_event(connection_, 0, target_, 0, reinterpret_cast<const char*>(&event));
    xcb_flush(connection_);
  }
  void answer(const xcb_selection_request_event_t& asked) {
    xcb_change_property(connection_, XCB_PROP_MODE_REPLACE, asked.requestor, asked.property, asked.target, 8,
                        static_cast<std::uint32_t>(list_.size()), list_.data());
    xcb_selection_notify_event_t event{};
    event.response_type = XCB_SELECTION_NOTIFY;
    event.requestor = asked.requestor;
    event.selection = asked.selection;
    event.target = asked.target;
    event.property = asked.property;
    event.time = asked.time;
    xcb_send_event(connection_, 0, asked.requestor, 0, reinterpret_cast<const char*>(&event));
    xcb_flush(connection_);
  }
  /// Nothing when it is over, or the server is gone.
  xcb_generic_event_t* next_event(const std::stop_token& over) {
    constexpr int kLookMs = 20;
    pollfd socket{xcb_get_file_descriptor(connection_), POLLIN, 0};
    while (!over.stop_requested() && xcb_connection_has_error(connection_) == 0) {
      if (xcb_generic_event_t* const event = xcb_poll_for_event(connection_)) return event;
      ::poll(&socket, 1, kLookMs);
    }
    return nullptr;
  }
  void run(const std::stop_token& stop) {
    connection_ = xcb_connect(nullptr, nullptr);
    if (xcb_connection_has_error(connection_) == 0) {
      const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
      xcb_query_tree_reply_t* const tree =
          xcb_query_tree_reply(connection_, xcb_query_tree(connection_, root), nullptr);
      target_ = xcb_query_tree_children(tree)[xcb_query_tree_children_length(tree) - 1];
      std::free(tree);
      const xcb_window_t source = xcb_generate_id(connection_);
      xcb_create_window(connection_, XCB_COPY_FROM_PARENT, source, root, -10, -10, 1, 1, 0, XCB_WINDOW_CLASS_INPUT_ONLY,
                        XCB_COPY_FROM_PARENT, 0, nullptr);
      xcb_set_selection_owner(connection_, source, atom("XdndSelection"), XCB_CURRENT_TIME);
      const xcb_atom_t finished = atom("XdndFinished"), status = atom("XdndStatus");
      say("XdndEnter", {source, 5u << 24, atom("text/uri-list"), 0, 0});
      say("XdndPosition", {source, 0, 0, XCB_CURRENT_TIME, atom("XdndActionCopy")});
      for (bool over = false; !over;) {
        xcb_generic_event_t* const event = next_event(stop);
        if (event == nullptr) break;
        const int type = event->response_type & 0x7f;
        if (type == XCB_SELECTION_REQUEST) answer(*reinterpret_cast<xcb_selection_request_event_t*>(event));
        if (type == XCB_CLIENT_MESSAGE) {
          const xcb_atom_t said = reinterpret_cast<xcb_client_message_event_t*>(event)->type;
          if (said == status) say("XdndDrop", {source, 0, XCB_CURRENT_TIME, 0, 0});
          over = said == finished;
        }
        std::free(event);
      }
    }
    xcb_disconnect(connection_);
  }

  std::string list_;
  xcb_connection_t* connection_ = nullptr;
  xcb_window_t target_ = 0;
  std::jthread thread_;
};

}  // namespace dubsar::testing
