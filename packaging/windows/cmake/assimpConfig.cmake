# SPDX-License-Identifier: GPL-3.0-or-later
# A static assimp does not say what it needs itself.
if(NOT TARGET assimp::assimp)
    add_library(assimp::assimp STATIC IMPORTED)
    set_target_properties(assimp::assimp PROPERTIES
        IMPORTED_LOCATION "${HAIRLOOM_WINDOWS_SYSROOT}/lib/libassimp.a"
        INTERFACE_INCLUDE_DIRECTORIES "${HAIRLOOM_WINDOWS_SYSROOT}/include"
        INTERFACE_LINK_LIBRARIES "${HAIRLOOM_WINDOWS_SYSROOT}/lib/libminizip.a;/usr/x86_64-w64-mingw32/lib/libz.a")
endif()
set(assimp_FOUND TRUE)
