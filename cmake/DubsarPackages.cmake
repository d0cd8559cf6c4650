# Every third-party package, found once. Debian 12 names; `./do deps` installs them.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TIFF REQUIRED)
find_package(JPEG REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(embree 3 REQUIRED)
find_package(meshoptimizer CONFIG REQUIRED)
pkg_check_modules(libdeflate REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)

# HDF5: the serial C library by pkg-config, never the OpenMPI build that find_package may prefer.
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5-serial)

if(DUBSAR_APP)
  find_package(glfw3 3.3 REQUIRED)
  pkg_check_modules(xcb REQUIRED IMPORTED_TARGET xcb)
  pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
  pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)
  pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
  pkg_check_modules(fribidi REQUIRED IMPORTED_TARGET fribidi)  # scripts from right to left
  pkg_check_modules(openxr IMPORTED_TARGET openxr)  # head-mounted displays; without it they say so
  if(openxr_FOUND)
    pkg_check_modules(x11 REQUIRED IMPORTED_TARGET x11)
    pkg_check_modules(vulkan REQUIRED IMPORTED_TARGET vulkan)  # its headers: the library is opened when a runtime asks for it
  endif()
  pkg_check_modules(hidapi REQUIRED IMPORTED_TARGET hidapi-hidraw)
  pkg_check_modules(libusb REQUIRED IMPORTED_TARGET libusb-1.0)

  # OpenCV 4.6 by its libraries: Debian keeps OpenCVConfig.cmake in libopencv-dev, which pulls in every module and Qt's, VTK's
  # and MPI's libraries. Only these modules are used; --no-install-recommends keeps them small.
  find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
  foreach(module core dnn objdetect videoio)
    find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
    add_library(opencv_${module} UNKNOWN IMPORTED)
    set_target_properties(opencv_${module} PROPERTIES
      IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
  endforeach()
endif()

if(DUBSAR_TESTS)
  find_package(GTest REQUIRED)
endif()
if(DUBSAR_TESTS AND DUBSAR_APP)
  pkg_check_modules(xtest IMPORTED_TARGET xcb xcb-xtest)  # real mouse and key events for tests of windows
  pkg_check_modules(umockdev IMPORTED_TARGET umockdev-1.0)  # device tests on simulated kernel interfaces
endif()
if(DUBSAR_BENCH)
  find_package(benchmark REQUIRED)
endif()
