# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the runtime that is built, builds samples/vulkan against it, and has it play two samples: hairs of the GPU lie where
# the CPU has them, the image has hair in it, Vulkan's validation layer has nothing to say, and the tables as JSON name what the
# kernels bind. Hair at rest as its material says looks as in our pictures.
#   cmake -DSOURCE=DIR -DBINARY=DIR -DWORK=DIR -DPICTURES=DIR -DCLI=PROGRAM -DCXX=CXX -DDIFFERENCE=PROGRAM -P install_and_draw.cmake
include("${SOURCE}/tests/samples/installed_sample.cmake")
build_installed_sample(vulkan -Wno-missing-field-initializers)
set(shaders "${WORK}/prefix/share/hairloom-runtime/shaders")

file(READ "${shaders}/gpu.json" json)
string(JSON bindings LENGTH "${json}" bindings)
set(listed "")
math(EXPR last "${bindings} - 1")
foreach(i RANGE ${last})
    string(JSON pass GET "${json}" bindings ${i} pass)
    string(JSON binding GET "${json}" bindings ${i} binding)
    list(APPEND listed "${pass} ${binding}")
endforeach()
set(bound "")
foreach(shader IN ITEMS "GUIDES guides.comp" "WISPS follow_wisps.comp" "HAIRS follow_hairs.comp" "RIBBONS ribbons.vert" "RIBBONS ribbons.frag" "LAMP_FIRST lamp_first.comp" "LAMP_COUNT lamp_count.comp"
        "LAMP_SUM lamp_sum.comp" "SHADE shade_hairs.comp" "SHADED shaded_ribbons.vert" "SHADED shaded_ribbons.frag")
    string(REPLACE " " ";" shader "${shader}")
    list(GET shader 0 pass)
    list(GET shader 1 file)
    run(spirv-val --target-env vulkan1.1 "${shaders}/${file}.spv")
    run(spirv-dis "${shaders}/${file}.spv")
    string(REGEX MATCHALL " Binding [0-9]+" found "${output}")
    list(TRANSFORM found REPLACE " Binding" "${pass}")
    list(APPEND bound ${found})
endforeach()
list(REMOVE_DUPLICATES bound)
list(SORT bound)
list(SORT listed)
if(NOT "${bound}" STREQUAL "${listed}")
    message(FATAL_ERROR "gpu.json lists ${listed}\nthe kernels bind ${bound}")
endif()

# play(NAME ARGUMENT...): the sample on an asset of that name, under Vulkan's validation layer; sets `output`.
function(play name)
    run(${CMAKE_COMMAND} -E env VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "${WORK}/build/vulkan_hair" "${WORK}/${name}.hairrt"
        "${shaders}" ${ARGN})
    message("${name} ${ARGN}: ${output}")
    if(output MATCHES "VUID|Validation")
        message(FATAL_ERROR "${name}: Vulkan's validation layer speaks")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

foreach(style IN ITEMS short shoulder)
    write_sample_asset(${style} --spheres-only)  # guides on the GPU meet spheres, not the skin
    set(image "${PICTURES}/vulkan-${style}.ppm")
    play(${style} -o "${image}" --frames 20 --check)
    # docs/gpu-simulation.md: 1e-6 m in hairs of 0.2 m.
    if(NOT output MATCHES "36000 hairs, .*apart from the CPU's: ([0-9]\\.?[0-9]*e-0[6-9]|0) m at most")
        message(FATAL_ERROR "${style}: expected 36000 hairs within 0.00001 m of the CPU's")
    endif()
    # The same with guides on the GPU (docs/gpu-simulation.md), in few frames: lavapipe takes its time for rods.
    play(${style} --frames 6 --gpu --check)
    if(NOT output MATCHES "at most, ([0-9]\\.?[0-9]*e-(0[5-9]|1[0-9])|0|0\\.0001[0-9]*) m root mean square")
        message(FATAL_ERROR "${style}: expected 0.0002 m root mean square of the CPU's at most")
    endif()
    # A share of them: other dispatches, the same hairs as the CPU reads then.
    play(${style} --frames 5 --share 0.3 --check)
    if(NOT output MATCHES "1[0-9][0-9][0-9][0-9] hairs, .*apart from the CPU's: ([0-9]\\.?[0-9]*e-0[6-9]|0) m at most")
        message(FATAL_ERROR "${style}: expected about a third of 36000 hairs within 0.00001 m of the CPU's")
    endif()
    # All but hair is one grey.
    run(convert "${image}" -fuzz 2% -fill white -opaque "srgb(188,188,188)" -fill black +opaque white -format "%[fx:int(1000*(1-mean))]" info:)
    if(output LESS 60 OR output GREATER 900)
        message(FATAL_ERROR "${image}: ${output} thousandths are hair; expected 60 to 900")
    endif()
endforeach()

# Shaded as the material says: Kajiya and Kay's hair, Marschner's, and that with streaks, dye and white strands; at rest, without
# the head, in the light of one lamp.
set(streaks material.streakShare=0.4 material.streakWidth=0.02 material.greyShare=0.3 material.dyeStrength=0.8 material.dyeStart=0.4
    material.dyeEnd=0.8)
foreach(look IN ITEMS "short kajiya" "long marschner" "shoulder marschner streaks")
    string(REPLACE " " ";" look "${look}")
    list(GET look 0 style)
    list(GET look 1 model)
    set(more "")
    if("${look}" MATCHES "streaks")
        set(more ${streaks})
    endif()
    list(JOIN look "-" name)
    if(NOT EXISTS "${WORK}/${style}.hairloom")
        write_sample_asset(${style} --spheres-only)
    endif()
    run("${CLI}" set "${WORK}/${style}.hairloom" material.shadingModel=${model} ${more} -o "${WORK}/${name}.hairloom")
    run("${CLI}" export "${WORK}/${name}.hairloom" --format runtime -o "${WORK}/${name}.hairrt")
    set(image "${PICTURES}/vulkan-${name}.ppm")
    play(${name} -o "${image}" --frames 0 --shade)
    if(NOT output MATCHES "seen from ([^ ]+) ([^ ]+) ([^ ]+) towards ([^ ]+) ([^ ]+) ([^ \n]+)")
        message(FATAL_ERROR "${name}: expected where it is seen from")
    endif()
    # f = 2.2 = 1/tan(fov/2)
    file(WRITE "${WORK}/${name}.view.json" "{\"camera\": {\"eye\": [${CMAKE_MATCH_1}, ${CMAKE_MATCH_2}, ${CMAKE_MATCH_3}],
        \"target\": [${CMAKE_MATCH_4}, ${CMAKE_MATCH_5}, ${CMAKE_MATCH_6}], \"up\": [0, 1, 0], \"fov_y_deg\": 48.887909},
        \"lights\": [{\"type\": \"directional\", \"to_light\": [0.5, 0.70710678, 0.5], \"irradiance\": [2, 2, 2]}],
        \"subdivisions\": 1}")
    run("${CLI}" render "${WORK}/${name}.hairloom" --view "${WORK}/${name}.view.json" --hide * --size 640x640 --passes 4 --scatter dual
        --exr "${WORK}/${name}.exr" -o "${PICTURES}/ours-${name}.png")
    run("${DIFFERENCE}" "${WORK}/${name}.exr" "${image}" 8)
    message("${name}: ${output}")
    # docs/integrate.md: the light's grid is coarser than our maps.
    if(NOT output MATCHES "FLIP 0\\.0[0-2][0-9]*, light (0\\.7[5-9]|0\\.[89]|1\\.[01])")
        message(FATAL_ERROR "${name}: expected FLIP below 0.03 and the light of ours within 25 %")
    endif()
endforeach()
