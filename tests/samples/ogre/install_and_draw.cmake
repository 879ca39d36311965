# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the runtime that is built, builds samples/ogre against it and Debian's Ogre, and has it draw the shoulder sample on its
# skinned head. To be run on a display; skipped where there is no Ogre.
#   cmake -DSOURCE=DIR -DBINARY=DIR -DWORK=DIR -DPICTURES=DIR -DCLI=PROGRAM -DCXX=CXX -P install_and_draw.cmake
execute_process(COMMAND pkg-config --exists OGRE RESULT_VARIABLE missing)
if(missing)
    message("skipped: there is no Ogre here; './dev ogre' installs libogre-1.12-dev")
    return()
endif()
include("${SOURCE}/tests/samples/installed_sample.cmake")
build_installed_sample(ogre -Wno-restrict)
write_sample_asset(shoulder)

# In the last frame of the clip's first second the head is down and turned.
set(first "${PICTURES}/ogre-first.png")
set(later "${PICTURES}/ogre.png")
run("${WORK}/build/ogre_hair" "${WORK}/shoulder.hairrt" "${SOURCE}/samples/bust/bust.glb" --frames 1 --picture "${first}")
run("${WORK}/build/ogre_hair" "${WORK}/shoulder.hairrt" "${SOURCE}/samples/bust/bust.glb" --frames 40 --picture "${later}")
message("${output}")
if(NOT output MATCHES "36000 hairs, .* roots hold to the skin within 0\\.0[0-9]+ mm")
    message(FATAL_ERROR "expected 36000 hairs whose roots hold to the skin that Ogre skins within 0.1 mm")
endif()

# The bust is clay and the rest is grey: hair alone has a colour to speak of.
run(convert "${later}" -colorspace HSL -channel G -separate -threshold 35% -format "%[fx:int(1000*mean)]" info:)
if(output LESS 60)
    message(FATAL_ERROR "${later}: ${output} thousandths are hair; expected 60 or more")
endif()
set(hair ${output})
execute_process(COMMAND compare -metric AE -fuzz 5% "${first}" "${later}" null: ERROR_VARIABLE moved)
if(moved LESS 20000)
    message(FATAL_ERROR "${moved} pixels differ between ${first} and ${later}; expected 20000 or more")
endif()
message("${hair} thousandths of the picture are hair, ${moved} pixels moved")
