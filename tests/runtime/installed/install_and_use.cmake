# SPDX-License-Identifier: GPL-3.0-or-later
# Configures, builds and installs runtime/ as if there were nothing else, then builds a game against what is installed, by CMake
# and by pkg-config. Its strands come to the same state as those of INSIDE, the same program of this project.
#   cmake -DSOURCE=DIR -DBUILD=DIR -DINSIDE=PROGRAM -DCOMPILER=CXX -P install_and_use.cmake
file(REMOVE_RECURSE "${BUILD}/prefix" "${BUILD}/game")
include("${SOURCE}/tests/support/run.cmake")

find_program(CCACHE ccache)
if(CCACHE)
    set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${CCACHE}")
    set(ENV{CCACHE_BASEDIR} "${SOURCE}")
    set(ENV{CCACHE_NOHASHDIR} 1)
endif()

# One instruction set, this machine's, makes it quick; its bits are those that the dispatching library comes to.
run(${CMAKE_COMMAND} -S "${SOURCE}/runtime" -B "${BUILD}/library" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_COMPILER=${COMPILER}"
    "-DCMAKE_CXX_FLAGS=-march=native -DHWY_COMPILE_ONLY_STATIC"
    -DCMAKE_INSTALL_LIBDIR=lib)
run(${CMAKE_COMMAND} --build "${BUILD}/library" --parallel 2)
run(${CMAKE_COMMAND} --install "${BUILD}/library" --prefix "${BUILD}/prefix")

run(${CMAKE_COMMAND} -S "${SOURCE}/tests/runtime/installed" -B "${BUILD}/game" -DCMAKE_BUILD_TYPE=Release
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_PREFIX_PATH=${BUILD}/prefix")
run(${CMAKE_COMMAND} --build "${BUILD}/game")

set(ENV{PKG_CONFIG_PATH} "${BUILD}/prefix/lib/pkgconfig")
run(pkg-config --cflags --libs hairloom-runtime)
separate_arguments(flags UNIX_COMMAND "${output}")
run(${COMPILER} -std=c++20 -O2 "${SOURCE}/tests/runtime/installed/step_strands.cpp" ${flags} -o "${BUILD}/game/by_pkg_config")

run("${INSIDE}")
set(expected "${output}")
foreach(program game by_pkg_config)
    run("${BUILD}/game/${program}")
    if(NOT output STREQUAL expected)
        message(FATAL_ERROR "${program} comes to the state ${output}, the project to ${expected}")
    endif()
endforeach()
foreach(file include/hairloom/engine.h share/doc/hairloom-runtime/LICENSE)
    if(NOT EXISTS "${BUILD}/prefix/${file}")
        message(FATAL_ERROR "${file} is not installed")
    endif()
endforeach()
file(GLOB_RECURSE inner "${BUILD}/prefix/include/*kernels*" "${BUILD}/prefix/include/*state.h")
if(inner)
    message(FATAL_ERROR "the inside of the engine is installed: ${inner}")
endif()
message("state ${expected}")
