# SPDX-License-Identifier: GPL-3.0-or-later
# Writes HLSL sources as arrays of characters, for programs that compile permutations of them when they run.
# -DINPUTS=a.hlsli;b.h -DOUTPUT=file.cpp; a source is known by the name of its file.
set(arrays "")
set(rows "")
set(count 0)
foreach(input IN LISTS INPUTS)
    get_filename_component(name "${input}" NAME)
    file(READ "${input}" hex HEX)
    string(REGEX REPLACE "(..)" "'\\\\x\\1'," characters "${hex}")
    string(APPEND arrays "constexpr char kText${count}[] = {${characters}};\n")
    string(APPEND rows "    {\"${name}\", {kText${count}, sizeof(kText${count})}},\n")
    math(EXPR count "${count} + 1")
endforeach()
file(WRITE "${OUTPUT}"
"#include \"shaders/shaders.h\"\n\nnamespace hairloom::shaders {\nnamespace {\n${arrays}
constexpr Source kSources[] = {\n${rows}};\n}  // namespace\n
std::span<const Source> sources() { return kSources; }\n
}  // namespace hairloom::shaders\n")
