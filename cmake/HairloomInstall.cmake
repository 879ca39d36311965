# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install BUILD --component application` lays down, and the two Debian packages that `./dev package` makes: the
# application, and the runtime that games build against (component runtime, runtime/CMakeLists.txt).
include(GNUInstallDirs)
set(data "${CMAKE_INSTALL_DATAROOTDIR}")
set(debian "${PROJECT_SOURCE_DIR}/packaging/debian")

# The mesh reader and the writers of meshes and videos are found beside the programs.
install(TARGETS hairloom-cli hairloom-mesh-reader RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT application)
foreach(writer hairloom-mesh-writer hairloom-video-writer)
    if(TARGET ${writer})
        install(TARGETS ${writer} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT application)
    endif()
endforeach()
if(TARGET hairloom)
    install(TARGETS hairloom RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT application)
    install(FILES "${debian}/hairloom.desktop" DESTINATION "${data}/applications" COMPONENT application)
    install(FILES "${debian}/hairloom.xml" DESTINATION "${data}/mime/packages" COMPONENT application)
    install(FILES "${debian}/hairloom.svg" DESTINATION "${data}/icons/hicolor/scalable/apps" COMPONENT application)
    install(FILES "${debian}/hairloom.svg" DESTINATION "${data}/icons/hicolor/scalable/mimetypes"
        RENAME application-x-hairloom.svg COMPONENT application)
endif()
install(DIRECTORY samples/hairstyles samples/materials DESTINATION "${data}/hairloom/samples" COMPONENT application)
install(FILES samples/bust/bust.glb samples/bust/bust.obj samples/bust/bust.mtl samples/bust/spheres.json samples/bust/README.md
    DESTINATION "${data}/hairloom/samples/bust" COMPONENT application)
install(FILES "${debian}/copyright" DESTINATION "${data}/doc/hairloom" COMPONENT application)
# Where `./dev web` has made it.
install(DIRECTORY "${PROJECT_BINARY_DIR}/share/hairloom/web" DESTINATION "${data}/hairloom" COMPONENT application OPTIONAL)

# The program writes its own manual pages.
install(CODE "execute_process(COMMAND \"$<TARGET_FILE:hairloom-cli>\" reference --man \"${PROJECT_BINARY_DIR}/man\"
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)" COMPONENT application)
install(DIRECTORY "${PROJECT_BINARY_DIR}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT application
    FILES_MATCHING PATTERN "*.1")

# Packing builds nothing: `./dev package` has built what is in them.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "The Hairloom authors")
set(CPACK_PACKAGE_CONTACT "The Hairloom authors <nobody@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL application runtime)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)

set(CPACK_COMPONENT_APPLICATION_DESCRIPTION "Hairstyles for games: grooming, simulation, export
Pick the scalp on a head, place roots, groom strands, put collision spheres
where they belong, see the hair move in the simulation that a game will run,
and export it; in a window (hairloom) or without (hairloom-cli).")
set(CPACK_DEBIAN_APPLICATION_PACKAGE_NAME hairloom)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_SHLIBDEPS ON)
# Loaded at run time: the loader of Vulkan's drivers, and what Qt draws icons with.
set(CPACK_DEBIAN_APPLICATION_PACKAGE_DEPENDS "libvulkan1, libqt6svg6")
set(CPACK_DEBIAN_APPLICATION_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, qt6-wayland, shared-mime-info")

set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Strand engine for hair in games, to build against
Plays Hairloom's runtime assets: headers for C99 and C++17, a static library,
and what CMake's find_package(hairloom-runtime) and pkg-config look for.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME hairloom-runtime-dev)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "libhwy-dev, pkg-config")
include(CPack)
