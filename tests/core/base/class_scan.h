// Reads C++ as far as one must to count what the classes of the house hold: scopes, statements and declarators, no
// types.

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dubsar {

struct ScannedClass {
  std::string name;          // with the classes around it, "Viewer::Parts"; "(unnamed)" where there is none
  int members = 0;           // data members of its own: neither static ones nor those of bases and nested classes
  std::string scope;         // the namespaces around it, "dubsar::app"; "(unnamed)" for those without a name
  bool enumeration = false;  // an enum has no members
};

// All classes, structs, unions and enums that `source` defines, in order of their ends. A nested struct without a name
// whose members are reached through the outer class counts as members of that class.
std::vector<ScannedClass> scan_classes(std::string_view source);

}  // namespace dubsar
