# Compile rules shared by all rooms, and the two functions that declare a room and its tests.

add_library(dubsar_options INTERFACE)
# Rooms of app see the rooms below app from one folder, and of app their own folders and those of the rooms in their DEPS.
set(DUBSAR_WALLS ${PROJECT_BINARY_DIR}/walls)
target_include_directories(dubsar_options INTERFACE
  $<IF:$<BOOL:$<TARGET_PROPERTY:DUBSAR_WALLED>>,${DUBSAR_WALLS}/house,${PROJECT_SOURCE_DIR}>)
foreach(room core devices input display)
  file(MAKE_DIRECTORY ${DUBSAR_WALLS}/house)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${room} ${DUBSAR_WALLS}/house/${room} SYMBOLIC)
endforeach()
target_compile_options(dubsar_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align
  -Woverloaded-virtual -Wconversion -Wno-sign-conversion -Wno-psabi -Werror=return-type
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>  # g++ 12 cries wolf over std::optional at -O3
  -ffp-contract=off  # a*d-b*c must be symmetric: the asymptotic decider depends on it
  -fstack-protector-strong)
target_compile_definitions(dubsar_options INTERFACE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
if(NOT DUBSAR_SANITIZE)  # copies into buffers whose size the compiler knows are checked; the sanitizers check more, and all of them
  target_compile_options(dubsar_options INTERFACE $<$<CONFIG:Release,RelWithDebInfo>:-U_FORTIFY_SOURCE>
    $<$<CONFIG:Release,RelWithDebInfo>:-D_FORTIFY_SOURCE=3>)
endif()
if(DUBSAR_WERROR)
  target_compile_options(dubsar_options INTERFACE -Werror)
endif()
if(DUBSAR_SANITIZE)
  target_compile_options(dubsar_options INTERFACE
    -fsanitize=${DUBSAR_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(dubsar_options INTERFACE -fsanitize=${DUBSAR_SANITIZE})
endif()
# Every program and test of a build with AddressSanitizer ends as sanitized_end.cpp says.
if(DUBSAR_SANITIZE MATCHES "address")
  add_library(dubsar_sanitized_end OBJECT ${CMAKE_CURRENT_LIST_DIR}/sanitized_end.cpp)
  target_compile_options(dubsar_sanitized_end PRIVATE -fsanitize=${DUBSAR_SANITIZE})
  target_sources(dubsar_options INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:$<TARGET_OBJECTS:dubsar_sanitized_end>>)
endif()

# dubsar_cold(target): code that is run once a command, a key press or a device's report; -O3 would take a third longer to compile, for nothing.
function(dubsar_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# dubsar_shipped(target): a program or library that people get. It looks for libraries in the system's folders alone: a RUNPATH
# of the build has an empty element, which is the folder that somebody happens to be in. All symbols are bound at the start,
# and the table of them cannot be written any more.
function(dubsar_shipped target)
  set_target_properties(${target} PROPERTIES SKIP_BUILD_RPATH ON)
  target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now -Wl,-z,noexecstack)
endfunction()

# The headers that most files read, read once for all rooms. Off where the includes of each file are to be proven (ci, core).
if(DUBSAR_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/common_headers.cpp CONTENT "")
  add_library(dubsar_common_headers STATIC ${PROJECT_BINARY_DIR}/common_headers.cpp)
  target_link_libraries(dubsar_common_headers PUBLIC dubsar_options PRIVATE fmt::fmt tl::expected glm::glm nlohmann_json::nlohmann_json
    OpenMP::OpenMP_CXX Threads::Threads)
  target_precompile_headers(dubsar_common_headers PRIVATE
    <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <string> <vector>
    <fmt/format.h> <tl/expected.hpp> <glm/glm.hpp> <nlohmann/json.hpp>)
endif()
# The same for tests, which take twice as long to read their headers as to compile. An executable, as tests are: -fPIE.
if(DUBSAR_TEST_PCH AND DUBSAR_TESTS)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test_headers.cpp CONTENT "int main() {}\n")
  add_executable(dubsar_test_headers EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/test_headers.cpp)
  target_link_libraries(dubsar_test_headers PRIVATE dubsar_options fmt::fmt tl::expected glm::glm OpenMP::OpenMP_CXX
    Threads::Threads GTest::gtest GTest::gmock)
  dubsar_cold(dubsar_test_headers)
  target_precompile_headers(dubsar_test_headers PRIVATE
    <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <random> <span> <string> <vector>
    <fmt/format.h> <tl/expected.hpp> <glm/glm.hpp> <gtest/gtest.h> <gmock/gmock.h>)
endif()

# Twelve files a compilation: headers are two thirds of a compiler's work here. Kernels that Highway compiles once per vector
# unit are left alone, as they include themselves.
function(dubsar_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)  # other files of the batch are no headers
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(source MATCHES "\\.cpp$" AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${source})
      file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/${source} kernels REGEX "HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
      if(kernels)
        set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endif()
  endforeach()
endfunction()

# dubsar_walled(target): it can include what lies in the folders of its sources, and what lies in those of the rooms that it
# links: each has an include folder of its own.
function(dubsar_walled target)
  file(RELATIVE_PATH room ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set(wall ${DUBSAR_WALLS}/${target})
  file(MAKE_DIRECTORY ${wall}/${room})
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(source MATCHES "^([a-z_]+)/")
      file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${CMAKE_MATCH_1} ${wall}/${room}/${CMAKE_MATCH_1} SYMBOLIC)
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES DUBSAR_WALLED ON)
  target_include_directories(${target} PUBLIC ${wall})
endfunction()

# dubsar_library(name [COLD] [WALLED] SOURCES a.cpp ... [DEPS public targets] [PRIVATE_DEPS third-party targets])
# One static library per room. Only what stands in DEPS can be included: the link line is the wall.
function(dubsar_library name)
  cmake_parse_arguments(ARG "COLD;WALLED" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  if(NOT ARG_SOURCES)  # a room that is laid out but empty
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE dubsar_options ${ARG_DEPS})
    return()
  endif()
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC dubsar_options ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS})
  if(ARG_COLD)
    dubsar_cold(${name})
  endif()
  if(ARG_WALLED)
    dubsar_walled(${name})
  endif()
  if(DUBSAR_UNITY AND NOT name IN_LIST DUBSAR_LOOSE)
    dubsar_unity(${name})
  endif()
  if(DUBSAR_PCH)
    target_precompile_headers(${name} REUSE_FROM dubsar_common_headers)
  endif()
endfunction()

# What `./do asan ROOM` builds: of each folder of tests/ those of the labels unit, gl, replay and app, which need
# no preloaded library; of core/exa those of tests/core/exa, of app/kiosk the binaries whose first source lies in tests/app/kiosk:
# cases have that name as a second label. Those of label app run the program: a room of their own.
foreach(room core devices input display app program)
  add_custom_target(dubsar_checked_${room}_tests)
endforeach()

# dubsar_test(name SOURCES a_test.cpp ... DEPS rooms [LABEL unit|gl|device|slow] [TIMEOUT seconds]
#             [ENVIRONMENT NAME=value] [LONG patterns] [TOGETHER suites])
# One GoogleTest binary per room; every case becomes one ctest test. Cases that match one of the patterns of LONG (as of
# --gtest_filter, colons between) have the label long instead: `./do test` leaves them to `./do long`. Suites of TOGETHER
# share what they make at their beginning, a scan or a surface: each is one ctest test.
function(dubsar_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT;ENVIRONMENT;LONG" "SOURCES;DEPS;TOGETHER" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(DUBSAR_SANITIZE)
    math(EXPR ARG_TIMEOUT "4 * ${ARG_TIMEOUT}")
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE dubsar_options ${ARG_DEPS} GTest::gtest GTest::gmock GTest::gtest_main)
  dubsar_cold(${name})  # a test is compiled more often than its loops are run
  if(DUBSAR_UNITY AND NOT name IN_LIST DUBSAR_LOOSE)
    dubsar_unity(${name})
  endif()
  if(DUBSAR_TEST_PCH)
    target_precompile_headers(${name} REUSE_FROM dubsar_test_headers)
    # Of the standard library's own strings, once they come from a precompiled header (g++ 12).
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow>)
  endif()
  set(labels ${ARG_LABEL})
  if(ARG_LABEL MATCHES "^(unit|gl|replay|app)$")
    file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}/tests" "${CMAKE_CURRENT_SOURCE_DIR}")
    string(REGEX REPLACE "/.*" "" room "${folder}")
    if(ARG_LABEL STREQUAL "app")
      set(room program)
    elseif(room MATCHES "^(core|app)$")
      if(folder STREQUAL "app")
        list(GET ARG_SOURCES 0 first)
        string(REGEX REPLACE "/.*" "" first "${first}")
        string(APPEND folder "/${first}")
      endif()
      if(room STREQUAL "app")  # of all folders of app one CMakeLists.txt: ctest tells them apart by label
        list(APPEND labels ${folder})
      endif()
      string(REPLACE "/" "_" chamber "${folder}")
      if(NOT TARGET dubsar_checked_${chamber}_tests)
        add_custom_target(dubsar_checked_${chamber}_tests)
      endif()
      add_dependencies(dubsar_checked_${chamber}_tests ${name})
    endif()
    add_dependencies(dubsar_checked_${room}_tests ${name})
  endif()
  include(GoogleTest)
  set(environment)
  if(ARG_ENVIRONMENT)
    set(environment ENVIRONMENT ${ARG_ENVIRONMENT})
  endif()
  set(apart ${ARG_LONG})
  foreach(suite IN LISTS ARG_TOGETHER)
    list(APPEND apart "${suite}.*")
    add_test(NAME ${suite} COMMAND ${name} --gtest_filter=${suite}.*)
    set_tests_properties(${suite} PROPERTIES LABELS "${labels}" TIMEOUT ${ARG_TIMEOUT} ${environment})
  endforeach()
  set(single)
  if(apart)
    list(JOIN apart ":" apart)
    set(single TEST_FILTER "-${apart}")
  endif()
  if(ARG_LONG)
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_FILTER "${ARG_LONG}" TEST_LIST ${name}_LONG_TESTS
                         PROPERTIES LABELS long TIMEOUT ${ARG_TIMEOUT} ${environment})
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 ${single}
                       PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT} ${environment})
  if(NOT labels STREQUAL ARG_LABEL)  # gtest_discover_tests takes no list
    set(script ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
    file(CONFIGURE OUTPUT ${script} @ONLY CONTENT "if(@name@_TESTS)
  set_tests_properties(\${@name@_TESTS} PROPERTIES LABELS \"@labels@\")
endif()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
  endif()
endfunction()
