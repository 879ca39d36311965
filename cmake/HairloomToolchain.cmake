# SPDX-License-Identifier: GPL-3.0-or-later
# Language level, output folders, warnings, sanitizers and the faster linker, for every target of the project.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()

set(HAIRLOOM_SANITIZE "" CACHE STRING "Sanitizers to build with: empty, address+undefined or thread")
set_property(CACHE HAIRLOOM_SANITIZE PROPERTY STRINGS "" "address+undefined" "thread")

# Warnings are errors in our own code only; third-party headers come in as system headers.
add_library(hairloom_warnings INTERFACE)
if(MSVC)
    target_compile_options(hairloom_warnings INTERFACE /W4 /WX /permissive- /utf-8 /bigobj)
else()
    target_compile_options(hairloom_warnings INTERFACE
        -Wall -Wextra -Werror -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
        -Woverloaded-virtual -Wold-style-cast)
    # Contracting a*b+c differently in two places would break the promise of equal bits for any thread count.
    add_compile_options(-ffp-contract=off)
    # Nothing asks errno after a square root; without this a loop that takes one is not vectorised.
    add_compile_options(-fno-math-errno)
endif()
if(WIN32)
    add_compile_definitions(NOMINMAX WIN32_LEAN_AND_MEAN _USE_MATH_DEFINES)
endif()

# GCC 12 takes variables for uninitialised that only its own instrumentation touches.
if(NOT HAIRLOOM_SANITIZE STREQUAL "" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized)
endif()

if(HAIRLOOM_SANITIZE STREQUAL "address+undefined")
    add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    add_link_options(-fsanitize=address,undefined)
    add_compile_definitions(HAIRLOOM_ADDRESS_SANITIZER=1)
elseif(HAIRLOOM_SANITIZE STREQUAL "thread")
    add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
    add_link_options(-fsanitize=thread)
elseif(NOT HAIRLOOM_SANITIZE STREQUAL "")
    message(FATAL_ERROR "HAIRLOOM_SANITIZE is '${HAIRLOOM_SANITIZE}'; expected nothing, address+undefined or thread")
endif()

find_program(HAIRLOOM_CCACHE ccache)
if(HAIRLOOM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # Without the first it keeps nothing that uses a precompiled header, whose content it compares anyway; with the others it finds
    # what another checkout has compiled.
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros
        "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" CCACHE_NOHASHDIR=1)
    if(CMAKE_HOST_UNIX)
        list(APPEND CMAKE_CXX_COMPILER_LAUNCHER sh "${CMAKE_SOURCE_DIR}/cmake/ccache.sh")
    endif()
    list(APPEND CMAKE_CXX_COMPILER_LAUNCHER "${HAIRLOOM_CCACHE}")
endif()
