# SPDX-License-Identifier: GPL-3.0-or-later
# The single header by another compiler than the project's, on other flags: a program in C plays an asset by it, and by the
# library, to the same bits. `./dev compilers` tries all compilers and many flags.
#   cmake -DSOURCE=DIR -DBINARY=DIR -DWORK=DIR -DLIBRARY=FILE -DCXX=CXX -P other_compiler.cmake
file(MAKE_DIRECTORY "${WORK}")
include("${SOURCE}/tests/support/run.cmake")
find_program(CLANG clang++-16)
find_program(CLANG_C clang-16)
if(NOT CLANG OR NOT CLANG_C)
    message("skipped: there is no clang-16")
    return()
endif()
run(${CMAKE_COMMAND} --build "${BINARY}" --target hairloom_single)
file(WRITE "${WORK}/hair.cpp" "#define HAIRLOOM_IMPLEMENTATION\n#include \"hairloom_single.h\"\n")
set(host "${SOURCE}/tests/runtime/installed/play.c")
set(asset "${SOURCE}/tests/exporters/files/version_1.hairrt")

# By the library, which takes the best of this machine.
run(cc -std=c99 -O2 -Wall -Wextra -Wpedantic -Werror "-I${SOURCE}/runtime/include" -c "${host}" -o "${WORK}/host.o")
run("${CXX}" "${WORK}/host.o" "${LIBRARY}" -lhwy -lm -o "${WORK}/by_library")
run("${WORK}/by_library" "${asset}")
string(REGEX MATCH "fused [01] state [0-9a-f]+ shown [0-9a-f]+ slept [1-9][0-9]*" expected "${output}")
if(NOT expected)
    message(FATAL_ERROR "the library comes to ${output}; expected a state, and hair that slept")
endif()

# Without -ffp-contract=off: the header says it itself.
set(flags -O1)
if(expected MATCHES "fused 1")
    list(APPEND flags -march=haswell)
elseif(CMAKE_HOST_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND flags -msse4.2)
endif()
run("${CLANG}" -std=c++20 ${flags} -Werror "-I${BINARY}/runtime" -c "${WORK}/hair.cpp" -o "${WORK}/hair.o")
run("${CLANG_C}" -std=c99 -O2 -Wall -Wextra -Wpedantic -Werror -DSINGLE_HEADER "-I${BINARY}/runtime" -c "${host}" -o "${WORK}/single.o")
run("${CLANG}" "${WORK}/single.o" "${WORK}/hair.o" -lm -o "${WORK}/by_header")
run("${WORK}/by_header" "${asset}")
if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "by the header and clang: ${output}; by the library: ${expected}")
endif()

# What a host without the flags is told.
if(CMAKE_HOST_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    execute_process(COMMAND "${CLANG}" -std=c++20 -fsyntax-only "-I${BINARY}/runtime" "${WORK}/hair.cpp" ERROR_VARIABLE said)
    if(NOT said MATCHES "compiled without vectors.*-march=haswell")
        message(FATAL_ERROR "nobody says that there are no vectors: ${said}")
    endif()
    execute_process(COMMAND "${CLANG}" -std=c++20 -fsyntax-only -march=haswell -ffast-math "-I${BINARY}/runtime" "${WORK}/hair.cpp"
        ERROR_VARIABLE said RESULT_VARIABLE result)
    if(result EQUAL 0 OR NOT said MATCHES "without -ffast-math")
        message(FATAL_ERROR "-ffast-math is taken: ${said}")
    endif()
endif()
message("${expected}")
