# SPDX-License-Identifier: GPL-3.0-or-later
if(NOT TARGET tinyexr::tinyexr)
    add_library(tinyexr::tinyexr STATIC IMPORTED)
    set_target_properties(tinyexr::tinyexr PROPERTIES
        IMPORTED_LOCATION "${HAIRLOOM_WINDOWS_SYSROOT}/lib/libtinyexr.a"
        INTERFACE_INCLUDE_DIRECTORIES "${HAIRLOOM_WINDOWS_SYSROOT}/include"
        INTERFACE_LINK_LIBRARIES "/usr/x86_64-w64-mingw32/lib/libz.a")
endif()
set(tinyexr_FOUND TRUE)
