# SPDX-License-Identifier: GPL-3.0-or-later
# hairloom_room: one library per folder. hairloom_test: one test program per room, registered with ctest.

# What most files include of others' headers: a third of the time of a file, once a build instead.
set(HAIRLOOM_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span> <string>
    <string_view> <unordered_map> <variant> <vector> <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <tl/expected.hpp>)

# hairloom_room(NAME SOURCES file... [PUBLIC target...] [PRIVATE target...] [PRECOMPILE header...] [PLAIN])
# makes hairloom_NAME (alias hairloom::NAME); includes are written from the top of the repository. HAIRLOOM_COMMON_HEADERS are
# precompiled, once for all rooms, or with PRECOMPILE's together for this one; PLAIN rooms do without.
function(hairloom_room name)
    cmake_parse_arguments(ARG "PLAIN" "" "SOURCES;PUBLIC;PRIVATE;PRECOMPILE" ${ARGN})
    add_library(hairloom_${name} STATIC ${ARG_SOURCES})
    add_library(hairloom::${name} ALIAS hairloom_${name})
    target_include_directories(hairloom_${name} PUBLIC "${PROJECT_SOURCE_DIR}")
    target_link_libraries(hairloom_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} hairloom_warnings)
    if(ARG_PRECOMPILE)
        hairloom_precompile(hairloom_${name} ${HAIRLOOM_COMMON_HEADERS} ${ARG_PRECOMPILE})
    elseif(NOT ARG_PLAIN)
        target_precompile_headers(hairloom_${name} REUSE_FROM hairloom_common_headers)
        hairloom_precompiled_for_ccache(hairloom_${name})
    endif()
    hairloom_unity(hairloom_${name})
endfunction()

# hairloom_precompile(TARGET HEADER...): for where most of a file's time goes into what these include. Our own are named from the
# top of the repository, as everywhere: a compiler's cache then knows them again in another checkout.
function(hairloom_precompile target)
    set(headers)
    foreach(header IN LISTS ARGN)
        if(NOT header MATCHES "^<")
            file(RELATIVE_PATH header "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/${header}")
            set(header "\"${header}\"")
        endif()
        list(APPEND headers "${header}")
    endforeach()
    target_precompile_headers(${target} PRIVATE ${headers})
    hairloom_precompiled_for_ccache(${target})
endfunction()

# -fpch-preprocess is what ccache asks for. The warnings are GCC 12's about its own library, whose templates it no longer takes for
# a system's once they are precompiled.
function(hairloom_precompiled_for_ccache target)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
            -Wno-stringop-overread)
    endif()
endfunction()

# hairloom_registry(TARGET LIST HEADER header ENTRY type FUNCTION pattern FILES glob... [NAMESPACE namespace] [EXCEPT file...])
# Adds the files to the target and writes `const std::vector<ENTRY>& LIST()`, which the header declares: what each file's function
# returns, in order of file name. The function is named by the file: with @name@Job, jobs/load_test.cpp defines `Job loadTestJob()`
# (@Name@ gives LoadTest). A new file is found by itself; EXCEPT names those that make no entry. Nothing relies on static objects.
function(hairloom_registry target list)
    cmake_parse_arguments(ARG "" "HEADER;ENTRY;FUNCTION;NAMESPACE" "FILES;EXCEPT" ${ARGN})
    if(NOT ARG_NAMESPACE)
        set(ARG_NAMESPACE hairloom)
    endif()
    file(GLOB files RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS ${ARG_FILES})
    list(REMOVE_ITEM files ${ARG_EXCEPT})
    set(declared)
    set(added)
    foreach(file IN LISTS files)
        get_filename_component(stem "${file}" NAME_WE)
        string(REPLACE "_" ";" words "${stem}")
        set(Name)
        foreach(word IN LISTS words)
            string(SUBSTRING "${word}" 0 1 first)
            string(SUBSTRING "${word}" 1 -1 rest)
            string(TOUPPER "${first}" first)
            string(APPEND Name "${first}${rest}")
        endforeach()
        string(SUBSTRING "${Name}" 0 1 first)
        string(SUBSTRING "${Name}" 1 -1 rest)
        string(TOLOWER "${first}" first)
        string(REPLACE "@name@" "${first}${rest}" function "${ARG_FUNCTION}")
        string(REPLACE "@Name@" "${Name}" function "${function}")
        string(APPEND declared "${ARG_ENTRY} ${function}();  // ${file}\n")
        string(APPEND added "        all.push_back(${function}());\n")
    endforeach()
    set(generated "${CMAKE_CURRENT_BINARY_DIR}/${list}_registry.cpp")
    file(CONFIGURE OUTPUT "${generated}" @ONLY CONTENT [[
// Written by hairloom_registry (cmake/HairloomRooms.cmake) from the names of files.
#include "@ARG_HEADER@"

namespace @ARG_NAMESPACE@ {

@declared@
const std::vector<@ARG_ENTRY@>& @list@() {
    static const std::vector<@ARG_ENTRY@> entries = [] {
        std::vector<@ARG_ENTRY@> all;
@added@        return all;
    }();
    return entries;
}

}  // namespace @ARG_NAMESPACE@
]])
    target_sources(${target} PRIVATE ${files} "${generated}")
endfunction()

# hairloom_program(NAME SOURCES file... LINK target...)
# On Windows all text of a program is UTF-8, by its manifest.
function(hairloom_program name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${name} PRIVATE ${ARG_LINK} hairloom_warnings)
    hairloom_unity(${name})
    if(MSVC)
        target_sources(${name} PRIVATE "${PROJECT_SOURCE_DIR}/packaging/windows/hairloom.manifest")
    elseif(WIN32)
        target_sources(${name} PRIVATE "${PROJECT_SOURCE_DIR}/packaging/windows/manifest.rc")
        set_source_files_properties("${PROJECT_SOURCE_DIR}/packaging/windows/manifest.rc" PROPERTIES
            OBJECT_DEPENDS "${PROJECT_SOURCE_DIR}/packaging/windows/hairloom.manifest")
        target_sources(${name} PRIVATE "${PROJECT_SOURCE_DIR}/packaging/windows/utf8_names.cpp")
        target_link_options(${name} PRIVATE -Wl,--wrap=mbrtowc)
    endif()
endfunction()

function(hairloom_optimise_little target)
    if(NOT MSVC AND CMAKE_BUILD_TYPE STREQUAL "Release")
        target_compile_options(${target} PRIVATE -O1)
    endif()
endfunction()

# hairloom_test(NAME [SOURCES file...] LINK target... [PRECOMPILE header...] [TIMEOUT seconds] [SLOW filter] [BY_SUITE])
# Every *_test.cpp of the folder is part of it; SOURCES are what else is.
# Each gtest case becomes a ctest entry NAME.Suite.Case; where programs run under Wine, whose start takes longer than most
# cases, all cases together become the entry NAME. Tests find the repository through tests/support/source_dir.h.
# Tests are compiled once and run for moments: what they include is precompiled, once for all or with PRECOMPILE's together for
# this one, and they are optimised little. SLOW is a filter of GoogleTest for cases that take seconds: they have the label
# NAME-slow, which ./dev test --quick leaves out, and begin before others, so that no core waits for the last. They have 300 s.
# BY_SUITE: the entries are NAME.Suite, since cases of a suite share what takes longer than they do, as kernels of a device. A suite
# of which one case is slow is slow, and all have TIMEOUT.
function(hairloom_test name)
    cmake_parse_arguments(ARG "BY_SUITE" "TIMEOUT;SLOW" "SOURCES;LINK;PRECOMPILE" ${ARGN})
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 120)
    endif()
    file(GLOB tests CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp")
    hairloom_program(test_${name} SOURCES ${tests} ${ARG_SOURCES} LINK ${ARG_LINK} hairloom_test_support GTest::gtest_main GTest::gmock)
    hairloom_optimise_little(test_${name})
    if(ARG_PRECOMPILE)
        hairloom_precompile(test_${name} <gtest/gtest.h> <gmock/gmock.h> ${ARG_PRECOMPILE})
    else()
        target_precompile_headers(test_${name} REUSE_FROM hairloom_test_headers)
        hairloom_precompiled_for_ccache(test_${name})
    endif()
    if(CMAKE_CROSSCOMPILING)
        add_test(NAME ${name} COMMAND test_${name} --gtest_brief=1)
        set_tests_properties(${name} PROPERTIES TIMEOUT 900 LABELS ${name})
        return()
    endif()
    if(ARG_BY_SUITE)
        set(suites "${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake")
        add_custom_command(TARGET test_${name} POST_BUILD BYPRODUCTS "${suites}" VERBATIM
            COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:test_${name}>" "-DNAME=${name}" "-DSLOW=${ARG_SLOW}"
                    "-DTIMEOUT=${ARG_TIMEOUT}" "-DFILE=${suites}" -P "${PROJECT_SOURCE_DIR}/cmake/discover_suites.cmake")
        file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/test_${name}_entries.cmake"
            "if(EXISTS \"${suites}\")\n  include(\"${suites}\")\nelse()\n  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)\nendif()\n")
        set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${CMAKE_CURRENT_BINARY_DIR}/test_${name}_entries.cmake")
        return()
    endif()
    if(ARG_SLOW)
        gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60 TEST_FILTER "${ARG_SLOW}"
            TEST_LIST test_${name}_slow PROPERTIES TIMEOUT 300 COST 10 LABELS ${name}-slow)
        set(quick TEST_FILTER "-${ARG_SLOW}")
    endif()
    gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60 ${quick}
        PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS ${name})
endfunction()
