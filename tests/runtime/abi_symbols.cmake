# SPDX-License-Identifier: GPL-3.0-or-later
# Fails where the C functions that LIBRARY defines are not those of the file LIST.
#   cmake -DLIBRARY=FILE -DNM=PROGRAM -DLIST=FILE -P abi_symbols.cmake
include("${CMAKE_CURRENT_LIST_DIR}/../support/run.cmake")
run("${NM}" --extern-only --defined-only --format=posix "${LIBRARY}")
string(REGEX MATCHALL "(^|\n)hl_[a-z_]+ T" lines "${output}")
list(TRANSFORM lines REPLACE "\n?(hl_[a-z_]+) T" "\\1")
list(SORT lines)
file(STRINGS "${LIST}" expected)
if(NOT "${lines}" STREQUAL "${expected}")
    message(FATAL_ERROR "${LIBRARY} defines\n${lines}\n${LIST} has\n${expected}")
endif()
