# SPDX-License-Identifier: GPL-3.0-or-later
# For scripts that try a sample as a game would build it. They are given -DSOURCE=DIR -DBINARY=DIR -DWORK=DIR -DPICTURES=DIR
# -DCLI=PROGRAM -DCXX=CXX.
include("${SOURCE}/tests/support/run.cmake")

# Empties ${WORK}, installs the runtime that is built into ${WORK}/prefix, and builds samples/NAME against it in ${WORK}/build.
# More flags for the compiler may follow.
macro(build_installed_sample name)
    file(REMOVE_RECURSE "${WORK}")
    file(MAKE_DIRECTORY "${WORK}" "${PICTURES}")
    run(${CMAKE_COMMAND} --install "${BINARY}" --component runtime --prefix "${WORK}/prefix")
    run(${CMAKE_COMMAND} -S "${SOURCE}/samples/${name}" -B "${WORK}/build" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_COMPILER=${CXX}"
        "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror ${ARGN}" "-DCMAKE_PREFIX_PATH=${WORK}/prefix")
    run(${CMAKE_COMMAND} --build "${WORK}/build")
endmacro()

# Writes ${WORK}/STYLE.hairrt of that sample hairstyle. More options for make_hairstyle.sh may follow.
macro(write_sample_asset style)
    run(${CMAKE_COMMAND} -E env "HAIRLOOM_CLI=${CLI}" "${SOURCE}/samples/make_hairstyle.sh" ${ARGN} --project-only ${style} "${WORK}")
    run("${CLI}" export "${WORK}/${style}.hairloom" --format runtime -o "${WORK}/${style}.hairrt")
endmacro()
