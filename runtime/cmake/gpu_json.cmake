# SPDX-License-Identifier: MIT
# Writes the tables of hairloom/gpu.h as JSON: cmake -DHEADER=FILE -DVERSION=X.Y.Z -DOUTPUT=FILE -P gpu_json.cmake
file(READ "${HEADER}" text)
string(REPLACE "\\\n" "\n" text "${text}")

# Rows X(…) of the table NAME, their fields apart by "|".
function(rows_of name output)
    string(FIND "${text}" "#define HL_GPU_${name}(X)" begin)
    string(SUBSTRING "${text}" ${begin} -1 table)
    string(FIND "${table}" "\n\n" end)
    string(SUBSTRING "${table}" 0 ${end} table)
    string(REGEX MATCHALL "X\\([A-Z][^)]*\\)" rows "${table}")
    list(TRANSFORM rows REPLACE "^X\\((.*)\\)$" "\\1")
    set(${output} "${rows}" PARENT_SCOPE)
endfunction()
function(shift_of class output)
    string(REGEX MATCH "#define HL_GPU_VULKAN_${class} ([0-9]+)" line "${text}")
    set(${output} ${CMAKE_MATCH_1} PARENT_SCOPE)
endfunction()

set(passes "")
rows_of(PASSES rows)
foreach(row IN LISTS rows)
    string(REGEX MATCH "^([A-Z_]+), (\"[^\"]+\"), ([A-Z]+), ([0-9]+),[ \n]*(\".*\")$" line "${row}")
    list(APPEND passes "    {\"name\": \"${CMAKE_MATCH_1}\", \"file\": ${CMAKE_MATCH_2}, \"kind\": \"${CMAKE_MATCH_3}\", \"entry\": \"main\", \"threads\": ${CMAKE_MATCH_4}, \"what\": ${CMAKE_MATCH_5}}")
endforeach()
set(buffers "")
rows_of(BUFFERS rows)
foreach(row IN LISTS rows)
    string(REGEX MATCH "^([A-Z_]+), ([0-9]+), ([A-Z_]+), ([A-Z]+),[ \n]*(\".*\")$" line "${row}")
    list(APPEND buffers "    {\"name\": \"${CMAKE_MATCH_1}\", \"element\": ${CMAKE_MATCH_2}, \"count\": \"${CMAKE_MATCH_3}\", \"filled\": \"${CMAKE_MATCH_4}\", \"what\": ${CMAKE_MATCH_5}}")
endforeach()
set(bindings "")
rows_of(BINDINGS rows)
foreach(row IN LISTS rows)
    string(REGEX MATCH "^([A-Z_]+), ([BTU]), ([0-9]+), ([A-Z_]+)$" line "${row}")
    set(pass "${CMAKE_MATCH_1}")
    set(class "${CMAKE_MATCH_2}")
    set(number "${CMAKE_MATCH_3}")
    set(buffer "${CMAKE_MATCH_4}")
    shift_of(${class} shift)
    math(EXPR binding "${number} + ${shift}")
    string(TOLOWER "${class}" letter)
    list(APPEND bindings "    {\"pass\": \"${pass}\", \"register\": \"${letter}${number}\", \"binding\": ${binding}, \"buffer\": \"${buffer}\"}")
endforeach()
foreach(table IN ITEMS passes buffers bindings)
    list(JOIN ${table} ",\n" ${table})
endforeach()
file(WRITE "${OUTPUT}" "{
  \"version\": \"${VERSION}\",
  \"passes\": [\n${passes}\n  ],
  \"buffers\": [\n${buffers}\n  ],
  \"bindings\": [\n${bindings}\n  ]
}
")
