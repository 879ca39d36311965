# SPDX-License-Identifier: GPL-3.0-or-later
# Writes compiled shaders as arrays of words. -DINPUTS=a.spv;b.spv -DOUTPUT=file.cpp -DTABLE=name; the function is table_NAME()
set(arrays "")
set(rows "")
set(count 0)
foreach(input IN LISTS INPUTS)
    get_filename_component(file "${input}" NAME)
    string(REGEX REPLACE "\\.spv$" "" name "${file}")
    file(READ "${input}" hex HEX)
    string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u," words "${hex}")
    string(APPEND arrays "constexpr std::uint32_t kWords${count}[] = {${words}};\n")
    string(APPEND rows "    {\"${name}\", kWords${count}},\n")
    math(EXPR count "${count} + 1")
endforeach()
file(WRITE "${OUTPUT}"
"#include \"shaders/shaders.h\"\n\nnamespace hairloom::shaders {\nnamespace {\n${arrays}
constexpr Shader kTable[] = {\n${rows}};\n}  // namespace\n
std::span<const Shader> table_${TABLE}();\nstd::span<const Shader> table_${TABLE}() { return kTable; }\n
}  // namespace hairloom::shaders\n")
