# dubsar_embed_text(OUTPUT_VARIABLE header function files...)
# Makes a C++ source with the text of every file, as the function that `header` declares:
#   std::span<const std::pair<std::string_view, std::string_view>> function();   // (file name, text)
# Run as a script it writes that source: cmake -DOUTPUT=... -DHEADER=... -DFUNCTION=... -DFILES=a;b -P EmbedText.cmake
if(CMAKE_SCRIPT_MODE_FILE)
  set(table "")
  foreach(file IN LISTS FILES)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" text)
    string(APPEND table "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
  endforeach()
  list(LENGTH FILES count)
  file(WRITE "${OUTPUT}" "// Made by cmake/EmbedText.cmake.
#include \"${HEADER}\"

#include <array>

namespace dubsar {
namespace {
using Entry = std::pair<std::string_view, std::string_view>;
constexpr std::array<Entry, ${count}> kTexts{{
${table}}};
}  // namespace

std::span<const Entry> ${FUNCTION}() { return kTexts; }

}  // namespace dubsar
")
  return()
endif()

set(DUBSAR_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(dubsar_embed_text output_variable header function)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DOUTPUT=${output}" "-DHEADER=${header}" "-DFUNCTION=${function}" "-DFILES=${ARGN}"
            -P ${DUBSAR_EMBED_SCRIPT}
    DEPENDS ${ARGN} ${DUBSAR_EMBED_SCRIPT}
    VERBATIM)
  set(${output_variable} ${output} PARENT_SCOPE)
endfunction()

# dubsar_english_rows(en.json output): the rows {"id", "text"}, of app/words/text.h.
function(dubsar_english_rows json output)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${json})
  file(READ ${json} rows)
  string(REGEX REPLACE "\n  (\"[a-z0-9_.-]+\"): (\"[^\n]*\"),?" "\n{\\1, \\2}," rows "${rows}")
  string(REGEX REPLACE "[{}]\n" "\n" rows "${rows}")
  file(CONFIGURE OUTPUT ${output} CONTENT "${rows}" @ONLY)
endfunction()
