# SPDX-License-Identifier: GPL-3.0-or-later
# CGAL's headers with Boost.Multiprecision as their exact numbers, for which GMP and MPFR are not needed.
if(NOT TARGET CGAL::CGAL)
    add_library(CGAL::CGAL INTERFACE IMPORTED)
    target_include_directories(CGAL::CGAL INTERFACE "${HAIRLOOM_WINDOWS_SYSROOT}/include")
    target_compile_definitions(CGAL::CGAL INTERFACE CGAL_DISABLE_GMP=1 CGAL_DISABLE_MPFR=1)
    target_compile_options(CGAL::CGAL INTERFACE -frounding-math)
endif()
set(CGAL_FOUND TRUE)
