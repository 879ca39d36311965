# SPDX-License-Identifier: GPL-3.0-or-later
if(NOT TARGET CGAL::Eigen3_support)
    add_library(CGAL::Eigen3_support INTERFACE IMPORTED)
    target_compile_definitions(CGAL::Eigen3_support INTERFACE CGAL_EIGEN3_ENABLED)
    target_link_libraries(CGAL::Eigen3_support INTERFACE Eigen3::Eigen)
endif()
