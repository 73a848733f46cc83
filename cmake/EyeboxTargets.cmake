# Two helpers, so that every library and every test is declared the same way.
#
#   eyebox_library(NAME name SOURCES ... [PUBLIC ...] [PRIVATE ...])
#   eyebox_test(NAME name SOURCES ... [LIBRARIES ...] [LABELS ...])
#
# PUBLIC is for libraries whose types stand in our headers; everything else links
# PRIVATE, which keeps HDF5, Ceres and gRPC invisible outside their folder.

find_program(EYEBOX_CCACHE ccache)
if(EYEBOX_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # The sloppiness is what ccache asks for before it caches what uses a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${EYEBOX_CCACHE})
endif()

add_library(eyebox_options INTERFACE)
target_include_directories(eyebox_options INTERFACE ${PROJECT_SOURCE_DIR})
# No contraction: the same source gives the same bits whatever the optimiser picks.
target_compile_options(eyebox_options INTERFACE -Wall -Wextra -Wshadow -Wconversion
                       -Wno-sign-conversion -Werror=return-type -ffp-contract=off)
# GCC 12 takes std::string's own copies for overruns (GCC bug 105329 and its kin); overruns are
# what the asan preset finds.
target_compile_options(eyebox_options INTERFACE -Wno-restrict -Wno-array-bounds
                       -Wno-stringop-overflow -Wno-stringop-overread)
# These change no result: they drop errno and floating-point traps, which nothing here looks at.
target_compile_options(eyebox_options INTERFACE -fno-math-errno -fno-trapping-math)
if(EYEBOX_SANITIZER STREQUAL "address")
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=address,undefined)
elseif(EYEBOX_SANITIZER STREQUAL "thread")
  add_compile_options(-fsanitize=thread)
  add_link_options(-fsanitize=thread)
endif()

if(EYEBOX_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize=vptr
                      -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=address,undefined)
endif()

# Parsing the standard library and Abseil is half of the time that a source takes, so it is done
# once. Sources still include what they use: clang-tidy reads them without these headers.
file(WRITE ${CMAKE_BINARY_DIR}/empty.cc "")
set(eyebox_common_headers <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional>
    <map> <memory> <optional> <span> <string> <string_view> <utility> <vector>
    <absl/status/statusor.h> <absl/strings/str_cat.h> <absl/strings/str_format.h>)
add_library(eyebox_pch OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/empty.cc)
target_link_libraries(eyebox_pch PRIVATE eyebox_options)
target_precompile_headers(eyebox_pch PRIVATE ${eyebox_common_headers})
add_library(eyebox_test_pch OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/empty.cc)
target_link_libraries(eyebox_test_pch PRIVATE eyebox_options)
target_compile_definitions(eyebox_test_pch PRIVATE GTEST_HAS_PTHREAD=1)  # as GTest::gtest has it
target_precompile_headers(eyebox_test_pch PRIVATE ${eyebox_common_headers}
                          <gmock/gmock.h> <gtest/gtest.h>)

function(eyebox_library)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${ARG_NAME} STATIC ${ARG_SOURCES})
  target_link_libraries(${ARG_NAME} PUBLIC ${ARG_PUBLIC} PRIVATE eyebox_options ${ARG_PRIVATE})
  target_precompile_headers(${ARG_NAME} REUSE_FROM eyebox_pch)
  target_include_directories(${ARG_NAME} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()

function(eyebox_test)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  if(NOT EYEBOX_BUILD_TESTS)
    return()
  endif()
  add_executable(${ARG_NAME} ${ARG_SOURCES})
  target_link_libraries(${ARG_NAME} PRIVATE eyebox_options ${ARG_LIBRARIES}
                        GTest::gmock GTest::gtest_main)
  target_precompile_headers(${ARG_NAME} REUSE_FROM eyebox_test_pch)
  target_compile_definitions(${ARG_NAME} PRIVATE
                             EYEBOX_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             EYEBOX_BINARY_DIR="${CMAKE_BINARY_DIR}")
  # One entry a program: what its tests share (a recording, a server) is made once.
  add_test(NAME ${ARG_NAME} COMMAND ${ARG_NAME} --gtest_brief=1)
  set_tests_properties(${ARG_NAME} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600)
endfunction()
