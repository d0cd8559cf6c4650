#pragma once
// A tool: what is done with the object by pointing at it. Events of a session come one after the other, and whoever
// takes one first has it.

#include "app/stage/stage.h"
#include "core/base/system/clock.h"
#include "input/input_event.h"

namespace dubsar::app {

/// One thread: that of the session.
class Tool {
 public:
  virtual ~Tool() = default;
  /// True: the event is this tool's, nobody behind it sees it. What it knows of an event that it leaves it may add.
  virtual bool take(InputEvent& event) {
    static_cast<void>(event);
    return false;
  }
  /// Once a turn of the session, before what is shown is put together.
  virtual void update(TimestampNs now) { static_cast<void>(now); }
  /// What it changes of the next picture, or adds to it.
  virtual void contribute(Shown& shown) { static_cast<void>(shown); }
  /// Another tool has the pointer, or another surface is shown: what it held is let go.
  virtual void let_go() {}
};

}  // namespace dubsar::app
