# SPDX-License-Identifier: GPL-3.0-or-later
# Cross-compiling for 64-bit Windows with Debian's mingw-w64 (posix threads). sysroot.sh makes the folder of libraries that
# HAIRLOOM_WINDOWS_SYSROOT names; nothing of the host's /usr/include or /usr/lib is seen.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
# Windows 10 is the oldest system that the code is written for.
set(CMAKE_C_FLAGS_INIT "-D_WIN32_WINNT=0x0A00")
set(CMAKE_CXX_FLAGS_INIT "-D_WIN32_WINNT=0x0A00 -Wa,-mbig-obj")

if(NOT DEFINED HAIRLOOM_WINDOWS_SYSROOT)
    set(HAIRLOOM_WINDOWS_SYSROOT "$ENV{HAIRLOOM_WINDOWS_SYSROOT}")
endif()
set(HAIRLOOM_WINDOWS_SYSROOT "${HAIRLOOM_WINDOWS_SYSROOT}" CACHE PATH "Folder that packaging/windows/sysroot.sh made")
if(NOT IS_DIRECTORY "${HAIRLOOM_WINDOWS_SYSROOT}/include")
    message(FATAL_ERROR "HAIRLOOM_WINDOWS_SYSROOT is '${HAIRLOOM_WINDOWS_SYSROOT}'; expected the folder that packaging/windows/sysroot.sh made")
endif()
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HAIRLOOM_WINDOWS_SYSROOT)

set(CMAKE_FIND_ROOT_PATH "${HAIRLOOM_WINDOWS_SYSROOT}" "${HAIRLOOM_WINDOWS_SYSROOT}/qt" /usr/x86_64-w64-mingw32)
# moc, rcc and uic are the host's, of the same version.
set(QT_HOST_PATH /usr CACHE PATH "Where the host's Qt is")
set(QT_HOST_PATH_CMAKE_DIR /usr/lib/x86_64-linux-gnu/cmake CACHE PATH "CMake's files of the host's Qt")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ZLIB_LIBRARY /usr/x86_64-w64-mingw32/lib/libz.a CACHE FILEPATH "Static zlib, not the DLL's import library")
set(ENV{PKG_CONFIG_LIBDIR} "${HAIRLOOM_WINDOWS_SYSROOT}/lib/pkgconfig")

set(CGAL_DIR "${CMAKE_CURRENT_LIST_DIR}/cmake")
set(assimp_DIR "${CMAKE_CURRENT_LIST_DIR}/cmake")
set(tinyexr_DIR "${CMAKE_CURRENT_LIST_DIR}/cmake")
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}/cmake")
# Programs that the build makes and runs, and tests, run under Wine.
set(CMAKE_CROSSCOMPILING_EMULATOR "${CMAKE_CURRENT_LIST_DIR}/wine.sh")
