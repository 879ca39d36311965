#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/sysroot.sh [--without-qt] FOLDER [ARCHIVES]
# Fills FOLDER with the libraries that Hairloom links and Debian has no mingw-w64 build of: static ones, built from
# Debian's own source packages, and links to headers that are the same on every system. What is there already stays.
# Qt, assimp and OpenMesh, which take longest, are unpacked from the folder ARCHIVES where it has them.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
libraries=(headers fmtlib spdlog highway meshoptimizer tbb png tinyexr googletest tinygltf assimp openmesh)
if [ "$1" = --without-qt ]; then shift; else libraries+=(qtbase); fi
mkdir -p "$1"
root=$(readlink -f "$1")
archives=${2:-}
export HAIRLOOM_WINDOWS_SYSROOT=$root
work=$root/work
mkdir -p "$work" "$root/include" "$root/lib/cmake" "$root/done"

say() { printf '%s\n' "$*" >&2; }

# source PACKAGE: unpacks Debian's source of it, patches applied, into $work/PACKAGE.
source_of() {
    local package=$1
    [ -d "$work/$package" ] && return
    if [ ! -f "$work/apt/sources.list" ]; then
        mkdir -p "$work/apt/lists/partial"
        # The machine's own archive of the release; security updates reach it with each point release.
        apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
            grep -E ' bookworm main$' | sort -u > "$work/apt/sources.list"
        [ -s "$work/apt/sources.list" ] || { say "error: this is not Debian 12 (bookworm)"; exit 1; }
    fi
    local apt=(-qq -o "Dir::Etc::SourceList=$work/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null
               -o "Dir::State::Lists=$work/apt/lists" -o APT::Sandbox::User=root)
    [ -f "$work/apt/updated" ] || { apt-get update "${apt[@]}" && touch "$work/apt/updated"; }
    mkdir -p "$work/download"
    (cd "$work/download" && apt-get source "${apt[@]}" --download-only "$package" >&2)
    dpkg-source --no-check -x "$work"/download/"${package}"_*.dsc "$work/$package" > /dev/null
}

# cmake_install NAME SOURCE OPTION…: always from an empty folder, since one that was begun from another checkout names files there.
cmake_install() {
    local name=$1 source=$2
    shift 2
    rm -rf "$work/build-$name"
    cmake -S "$source" -B "$work/build-$name" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$here/mingw64.cmake" \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$root" -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=OFF \
        -DBUILD_TESTING=OFF -DCMAKE_POLICY_DEFAULT_CMP0077=NEW \
        -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" \
        -DCMAKE_C_COMPILER_LAUNCHER="$(command -v ccache || true)" "$@" > "$work/$name.log" 2>&1 &&
        cmake --build "$work/build-$name" -j "$(nproc)" >> "$work/$name.log" 2>&1 &&
        cmake --install "$work/build-$name" >> "$work/$name.log" 2>&1 ||
        { tail -30 "$work/$name.log" >&2; say "error: $name cannot be built ($work/$name.log)"; exit 1; }
}

build_headers() {
    local name
    for name in CGAL boost nlohmann tl CLI vulkan vk_video xxhash.h; do
        ln -sfn "/usr/include/$name" "$root/include/$name"
    done
    ln -sfn /usr/include/eigen3 "$root/include/eigen3"
    local volk
    for volk in /usr/include/volk.h /usr/include/volk.c; do
        [ -f "$volk" ] && ln -sfn "$volk" "$root/include/"
    done
    # The configurations of header-only packages look for their headers three folders up.
    mkdir -p "$root/share/cmake" "$root/share/eigen3"
    for name in nlohmann_json tl-expected CLI11; do
        cp -r "/usr/share/cmake/$name" "$root/share/cmake/"
    done
    cp -r /usr/share/eigen3/cmake "$root/share/eigen3/"
}

build_fmtlib() { source_of fmtlib; cmake_install fmt "$work/fmtlib" -DFMT_TEST=OFF -DFMT_DOC=OFF; }

build_spdlog() {
    source_of spdlog
    cmake_install spdlog "$work/spdlog" -DSPDLOG_FMT_EXTERNAL=ON -DSPDLOG_BUILD_EXAMPLE=OFF -DSPDLOG_BUILD_TESTS=OFF
}

build_highway() {
    source_of highway
    cmake_install highway "$work/highway" -DHWY_ENABLE_CONTRIB=OFF -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_TESTS=OFF
}

build_meshoptimizer() { source_of meshoptimizer; cmake_install meshoptimizer "$work/meshoptimizer"; }

build_tbb() {
    source_of onetbb
    cmake_install tbb "$work/onetbb" -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_EXAMPLES=OFF
}

build_png() {
    source_of libpng1.6
    cmake_install png "$work/libpng1.6" -DPNG_SHARED=OFF -DPNG_TESTS=OFF
}

build_tinyexr() {
    source_of tinyexr
    x86_64-w64-mingw32-g++-posix -O2 -DTINYEXR_USE_MINIZ=0 -DTINYEXR_IMPLEMENTATION -include zlib.h -x c++ \
        -c "$work/tinyexr/tinyexr.h" -o "$work/tinyexr.o" > "$work/tinyexr.log" 2>&1 ||
        { tail -30 "$work/tinyexr.log" >&2; say "error: tinyexr cannot be built"; exit 1; }
    rm -f "$root/lib/libtinyexr.a"
    x86_64-w64-mingw32-ar rcs "$root/lib/libtinyexr.a" "$work/tinyexr.o"
    cp "$work/tinyexr/tinyexr.h" "$root/include/"
}

build_googletest() { cmake_install googletest /usr/src/googletest -DBUILD_GMOCK=ON; }

build_tinygltf() { ln -sfn /usr/include/tiny_gltf.h "$root/include/"; }

build_minizip() {
    source_of zlib
    local file objects=()
    mkdir -p "$work/build-minizip" "$root/include/minizip"
    for file in unzip zip ioapi iowin32; do
        x86_64-w64-mingw32-gcc-posix -O2 -c "$work/zlib/contrib/minizip/$file.c" -o "$work/build-minizip/$file.o"
        objects+=("$work/build-minizip/$file.o")
    done
    rm -f "$root/lib/libminizip.a"
    x86_64-w64-mingw32-ar rcs "$root/lib/libminizip.a" "${objects[@]}"
    cp "$work"/zlib/contrib/minizip/{unzip,zip,ioapi,iowin32}.h "$root/include/minizip/"
}

build_assimp() {
    build_minizip
    source_of assimp
    # Debian's patch needs a packaged draco, which the readers here do without.
    if [ -f "$work/assimp/debian/patches/use-system-libdraco.patch" ] && [ ! -f "$work/assimp/.without-draco" ]; then
        patch -s -R -p1 -d "$work/assimp" < "$work/assimp/debian/patches/use-system-libdraco.patch"
        touch "$work/assimp/.without-draco"
    fi
    mkdir -p "$work/assimp-headers"
    ln -sfn /usr/include/utf8cpp/* /usr/include/stb "$work/assimp-headers/"
    cmake_install assimp "$work/assimp" -DASSIMP_NO_EXPORT=ON -DASSIMP_BUILD_ALL_IMPORTERS_BY_DEFAULT=OFF \
        -DASSIMP_BUILD_{OBJ,GLTF,FBX,PLY,STL}_IMPORTER=ON -DASSIMP_BUILD_TESTS=OFF -DASSIMP_BUILD_ASSIMP_TOOLS=OFF \
        -DASSIMP_BUILD_DRACO=OFF -DASSIMP_WARNINGS_AS_ERRORS=OFF -DASSIMP_BUILD_ZLIB=OFF -DUNZIP_FOUND=1 \
        "-DUNZIP_INCLUDE_DIRS=$root/include" "-DUNZIP_LIBRARIES=$root/lib/libminizip.a" \
        "-DCMAKE_CXX_FLAGS=-Wa,-mbig-obj -I$work/assimp-headers"
}

build_openmesh() {
    source_of openmesh
    cmake_install openmesh "$work/openmesh" -DBUILD_APPS=OFF -DOPENMESH_BUILD_UNIT_TESTS=OFF -DOPENMESH_DOCS=OFF
}

# Core, Gui, Widgets and Test, as libraries of the host's version, whose moc, rcc and uic are used.
build_qtbase() {
    source_of qt6-base
    local source=$work/qt6-base
    local windows=$source/src/plugins/platforms/windows
    # Debian's archive has no wintab.h: pens come through Windows' own messages. QTabletEvent stays.
    sed -i 's/QT_CONFIG(tabletevent)/0/' "$windows"/qwindowspointerhandler.{h,cpp} "$windows/qwindowscontext.cpp"
    sed -i 's/CONDITION QT_FEATURE_tabletevent/CONDITION FALSE/' "$windows/CMakeLists.txt"
    # Without OpenGL a guard is missing, and Direct2D's plugin has no headers in mingw-w64.
    sed -i '/isSoftwareGl()/,/#if/ s/#if QT_CONFIG(dynamicgl)$/#if QT_CONFIG(dynamicgl) \&\& QT_CONFIG(opengl)/' \
        "$windows/qwindowswindow.cpp"
    sed -i '/add_subdirectory(direct2d)/d' "$source/src/plugins/platforms/CMakeLists.txt"
    cmake_install qtbase "$source" "-DCMAKE_INSTALL_PREFIX=$root/qt" -DBUILD_SHARED_LIBS=ON -DCMAKE_EXE_LINKER_FLAGS= \
        -DQT_BUILD_{EXAMPLES,TESTS}=OFF -DQT_BUILD_TOOLS_WHEN_CROSSCOMPILING=OFF \
        -DFEATURE_{dbus,sql,network,opengl,vulkan,printsupport,pkg_config,icu,zstd,glib}=OFF \
        -DFEATURE_system_{zlib,png,jpeg,freetype,harfbuzz,pcre2,doubleconversion}=OFF
    cp "$(x86_64-w64-mingw32-gcc-posix -print-file-name=libgcc_s_seh-1.dll)" \
        "$(x86_64-w64-mingw32-gcc-posix -print-file-name=libstdc++-6.dll)" \
        /usr/x86_64-w64-mingw32/lib/libwinpthread-1.dll "$root/qt/bin/"
}

# once NAME: runs build_NAME unless it has been run to its end.
once() {
    [ -f "$root/done/$1" ] && return
    say "windows: $1"
    "build_$1"
    touch "$root/done/$1"
}

meshes=$(compgen -G "$archives/assimp-*-openmesh-*-mingw64.tar.zst" | tail -1 || true)
if [ -n "$archives" ] && [ -n "$meshes" ] && [ ! -f "$root/done/assimp" ]; then
    say "windows: assimp and openmesh from $meshes"
    tar --zstd -xf "$meshes" -C "$root" --strip-components=1
    touch "$root/done/assimp" "$root/done/openmesh"
fi
qt=$(compgen -G "$archives/qtbase-*-mingw64.tar.zst" | tail -1 || true)
if [ -n "$archives" ] && [ -n "$qt" ] && [ ! -f "$root/done/qtbase" ]; then
    say "windows: qtbase from $qt"
    tar --zstd -xf "$qt" -C "$root"
    touch "$root/done/qtbase"
fi
for library in "${libraries[@]}"; do
    once "$library"
done
