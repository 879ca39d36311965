# SPDX-License-Identifier: GPL-3.0-or-later
# Writes compiled shaders as arrays of words. -DINPUTS=a.spv;b.spv -DOUTPUT=file.cpp -DTABLE=name; the function is table_NAME().
# -DDXBC=ON: beside each a.spv lies an a.dxbc.
set(arrays "")
set(rows "")
set(count 0)
foreach(input IN LISTS INPUTS)
    get_filename_component(file "${input}" NAME)
    string(REGEX REPLACE "\\.spv$" "" name "${file}")
    file(READ "${input}" hex HEX)
    string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u," words "${hex}")
    string(APPEND arrays "constexpr std::uint32_t kWords${count}[] = {${words}};\n")
    set(dxbc "{}")
    if(DXBC)
        string(REGEX REPLACE "\\.spv$" ".dxbc" compiled "${input}")
        file(READ "${compiled}" hex HEX)
        string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u," words "${hex}")
        string(APPEND arrays "constexpr std::uint32_t kDxbc${count}[] = {${words}};\n")
        set(dxbc "std::as_bytes(std::span(kDxbc${count}))")
    endif()
    string(APPEND rows "    {\"${name}\", kWords${count}, ${dxbc}},\n")
    math(EXPR count "${count} + 1")
endforeach()
file(WRITE "${OUTPUT}"
"#include \"shaders/shaders.h\"\n\nnamespace hairloom::shaders {\nnamespace {\n${arrays}
const Shader kTable[] = {\n${rows}};\n}  // namespace\n
std::span<const Shader> table_${TABLE}();\nstd::span<const Shader> table_${TABLE}() { return kTable; }\n
}  // namespace hairloom::shaders\n")
