# SPDX-License-Identifier: GPL-3.0-or-later
# Writes a file of ctest with an entry NAME.SUITE for each suite of a program of GoogleTest.
#   cmake -DPROGRAM=FILE -DNAME=NAME -DSLOW=FILTER -DTIMEOUT=SECONDS -DFILE=FILE -P discover_suites.cmake
# Suites of which SLOW chooses a case have the label NAME-slow and begin before others.
cmake_minimum_required(VERSION 3.25)

set(text "")
function(suites_of filter result)
    execute_process(COMMAND "${PROGRAM}" --gtest_list_tests "--gtest_filter=${filter}"
        OUTPUT_VARIABLE output RESULT_VARIABLE failed)
    if(failed)
        message(FATAL_ERROR "${PROGRAM} does not list its tests: ${failed}\n${output}")
    endif()
    string(REGEX MATCHALL "(^|\n)[^ \n#]+\\." suites "${output}")
    string(REGEX REPLACE "[\n]" "" suites "${suites}")
    set(${result} ${suites} PARENT_SCOPE)
endfunction()
suites_of("*" all)
set(slow "")
if(SLOW)
    suites_of("${SLOW}" slow)
    if(NOT slow)
        message(FATAL_ERROR "no test of ${PROGRAM} is among the slow ones, ${SLOW}")
    endif()
endif()
foreach(suite IN LISTS all)
    string(REGEX REPLACE "\\.$" "" suite_name "${suite}")
    set(label "${NAME}")
    set(cost "")
    if(suite IN_LIST slow)
        set(label "${NAME}-slow")
        set(cost " COST 10")
    endif()
    string(APPEND text "add_test([=[${NAME}.${suite_name}]=] \"${PROGRAM}\" [=[--gtest_filter=${suite}*]=])\n"
        "set_tests_properties([=[${NAME}.${suite_name}]=] PROPERTIES TIMEOUT ${TIMEOUT} LABELS ${label}${cost})\n")
endforeach()
file(WRITE "${FILE}" "${text}")
