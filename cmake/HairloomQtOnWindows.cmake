# SPDX-License-Identifier: GPL-3.0-or-later
# What the cross-compiled editor needs of Qt besides linking it.

# Copies Qt's libraries and plugins, which packaging/windows/sysroot.sh put into the folder of libraries, beside the programs.
function(hairloom_qt_beside_programs target)
    set(qt "${HAIRLOOM_WINDOWS_SYSROOT}/qt")
    set(bin "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
    set(stamp "${CMAKE_BINARY_DIR}/qt-beside-programs")
    file(GLOB libraries "${qt}/bin/*.dll")
    add_custom_command(OUTPUT "${stamp}"
        COMMAND "${CMAKE_COMMAND}" -E make_directory "${bin}"
        COMMAND "${CMAKE_COMMAND}" -E copy_if_different ${libraries} "${bin}"
        COMMAND "${CMAKE_COMMAND}" -E copy_directory "${qt}/plugins/platforms" "${bin}/platforms"
        COMMAND "${CMAKE_COMMAND}" -E copy_directory "${qt}/plugins/styles" "${bin}/styles"
        COMMAND "${CMAKE_COMMAND}" -E touch "${stamp}"
        DEPENDS ${libraries} COMMENT "Copying Qt beside the programs" VERBATIM)
    add_custom_target(hairloom_qt DEPENDS "${stamp}")
    add_dependencies(${target} hairloom_qt)
endfunction()

# Qt's plugin for SVG is a package of its own, which is not built there: icons are drawn into PNG files, with 96 pixels for the
# 24 units of an icon, so that they stay sharp on any display.
function(hairloom_icons_as_png target icons)
    find_program(HAIRLOOM_RSVG_CONVERT rsvg-convert REQUIRED DOC "librsvg's program (Debian: librsvg2-bin)")
    set(folder "${CMAKE_CURRENT_BINARY_DIR}/png")
    set(outputs)
    set(entries "")
    foreach(icon IN LISTS icons)
        get_filename_component(name "${icon}" NAME_WE)
        set(output "${folder}/icons/${name}.png")
        add_custom_command(OUTPUT "${output}"
            COMMAND "${CMAKE_COMMAND}" -E make_directory "${folder}/icons"
            COMMAND "${HAIRLOOM_RSVG_CONVERT}" --width 96 --height 96 --output "${output}" "${icon}"
            DEPENDS "${icon}" COMMENT "Drawing icon ${name}" VERBATIM)
        list(APPEND outputs "${output}")
        string(APPEND entries "<file>icons/${name}.png</file>")
    endforeach()
    file(CONFIGURE OUTPUT "${folder}/icons_png.qrc" CONTENT "<RCC><qresource prefix=\"/\">${entries}</qresource></RCC>")
    add_custom_command(OUTPUT "${folder}/icons_png.cpp"
        COMMAND Qt6::rcc --no-zstd --name icons_png "${folder}/icons_png.qrc" -o "${folder}/icons_png.cpp"
        DEPENDS "${folder}/icons_png.qrc" ${outputs} VERBATIM)
    # An object of the programs, not of the library, from which a linker takes only what is called.
    add_library(hairloom_icons OBJECT "${folder}/icons_png.cpp")
    target_sources(${target} INTERFACE $<TARGET_OBJECTS:hairloom_icons>)
endfunction()
