# SPDX-License-Identifier: GPL-3.0-or-later
# Writes HLSL as C++ that core/software compiles: cmake -DINPUT=x.hlsl -DOUTPUT=x.hlsl -P hlsl_to_cpp.cmake. The
# result is the inside of a struct whose members are the shader's registers; core/software/hlsl.h has the types. Only words change
# that C++ has no like of, so that lines stay those of the shader.
file(READ "${INPUT}" text)

# Inside the kernel's own types, not beside those that C++ shares.
string(REPLACE "__cplusplus" "HAIRLOOM_SHARED_WITH_CPP" text "${text}")
string(REGEX REPLACE "#include \"(runtime/shaders/)?types\\.h\"" "" text "${text}")
string(REPLACE "#include \"runtime/shaders/" "#include \"software_kernels/runtime/" text "${text}")
string(REGEX REPLACE "#include \"shaders/" "#include \"software_kernels/" text "${text}")

# Registers.
string(REGEX REPLACE "cbuffer ([A-Za-z]+) : register\\(b([0-9]+)\\) { ([A-Za-z]+) ([A-Za-z]+); };"
    "const \\3& \\4 = constants<\\3>(\\2);" text "${text}")
string(REGEX REPLACE "(RWStructuredBuffer<[A-Za-z0-9]+>) ([A-Za-z]+) : register\\(u([0-9]+)\\)" "\\1 \\2 = written(\\3)" text "${text}")
string(REGEX REPLACE "([ \n])(StructuredBuffer<[A-Za-z0-9]+>) ([A-Za-z]+) : register\\(t([0-9]+)\\)" "\\1\\2 \\3 = read(\\4)" text "${text}")
string(REGEX REPLACE "(Texture2D<[A-Za-z0-9]+>) ([A-Za-z]+) : register\\(t([0-9]+)\\)" "\\1 \\2 = texture(\\3)" text "${text}")
string(REGEX REPLACE "SamplerState ([A-Za-z]+) : register\\(s[0-9]+\\)" "SamplerState \\1" text "${text}")

# Entry points, and what is told of functions before they are there.
string(REGEX REPLACE "\\[numthreads\\(([^,]*), ([^,]*), ([^)]*)\\)\\]" "static constexpr uint kGroup[3] = {\\1, \\2, \\3};" text "${text}")
string(REGEX REPLACE " : SV_[A-Za-z0-9]+" "" text "${text}")
string(REGEX REPLACE "\nvoid visitPixel\\([^)]*\\);" "" text "${text}")
string(REPLACE "[unroll] " "" text "${text}")

# What is large goes by reference.
set(large "ShadeConstants|LightConstants|MeshConstants|FibreConstants|ViewConstants|LookConstants|StrandHeader|RibbonPiece|Corners|SkyMoments|SkyInHair|SkySeen")
string(REGEX REPLACE "([(,][ \n]*)(${large}) ([a-z][A-Za-z]*)" "\\1const \\2& \\3" text "${text}")
string(REGEX REPLACE "const (LightConstants|StrandHeader) ([a-z]+) = ([A-Za-z.]+)\\[" "const \\1& \\2 = \\3[" text "${text}")
string(REGEX REPLACE "inout ([A-Za-z0-9]+) " "\\1& " text "${text}")
string(REPLACE "static const " "static constexpr " text "${text}")

# Parts of vectors; FibreConstants has a member called r.
string(REPLACE "fibre.r.rgb" "fibre.<r>.xyz()" text "${text}")
string(REGEX REPLACE "\\.r([^A-Za-z0-9_(])" ".x\\1" text "${text}")
string(REGEX REPLACE "\\.g([^A-Za-z0-9_(])" ".y\\1" text "${text}")
string(REGEX REPLACE "\\.b([^A-Za-z0-9_(])" ".z\\1" text "${text}")
string(REGEX REPLACE "\\.a([^A-Za-z0-9_(])" ".w\\1" text "${text}")
string(REGEX REPLACE "\\.rgb([^A-Za-z0-9_(])" ".xyz()\\1" text "${text}")
string(REGEX REPLACE "\\.([xyzw][xyzw][xyzw]?[xyzw]?)([^A-Za-z0-9_(])" ".\\1()\\2" text "${text}")
string(REPLACE "fibre.<r>" "fibre.r" text "${text}")

# Numbers are of single precision.
string(REGEX REPLACE "([^A-Za-z0-9_.])([0-9]+\\.[0-9]*(e[-+]?[0-9]+)?|[0-9]+e[-+]?[0-9]+)" "\\1\\2f" text "${text}")

file(WRITE "${OUTPUT}.new" "${text}")
file(COPY_FILE "${OUTPUT}.new" "${OUTPUT}" ONLY_IF_DIFFERENT)
file(REMOVE "${OUTPUT}.new")
file(TOUCH "${OUTPUT}")
