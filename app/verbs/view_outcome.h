#pragma once
// What is said of a session when it is over.

#include <string>
#include <vector>

#include "app/cli/verb.h"
#include "app/viewer/view_options.h"

namespace dubsar::app {

/// Pictures, the view, and how long input took to become cameras; `simulated`: in simulated time.
VerbResult describe_session(const std::string& display, const ViewResult& done, std::size_t triangles, bool simulated);

/// How the sources were at the end.
void add_sources(const std::vector<SourceRow>& rows, VerbResult& out);

/// How the further panels were at the end.
void add_panel_states(const ViewResult& done, VerbResult& out);

/// From picture to picture, of all that were presented while things moved.
void add_intervals(const ViewResult& done, VerbResult& out);

}  // namespace dubsar::app
