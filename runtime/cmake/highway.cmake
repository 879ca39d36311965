# SPDX-License-Identifier: MIT
# Highway as a target to link, in `highway`, and how an installed package finds it again, in `find_highway`.
# Debian's by pkg-config; where there is none, as with vcpkg, by Highway's own package.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
    pkg_check_modules(HWY QUIET IMPORTED_TARGET libhwy)
endif()
if(HWY_FOUND)
    set(highway PkgConfig::HWY)
    set(find_highway "find_dependency(PkgConfig)
if(NOT TARGET PkgConfig::HWY)
    pkg_check_modules(HWY REQUIRED QUIET IMPORTED_TARGET libhwy)
endif()")
else()
    find_package(hwy CONFIG REQUIRED)
    set(highway hwy::hwy)
    set(find_highway "find_dependency(hwy CONFIG)")
endif()
