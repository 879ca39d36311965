#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# wheel.sh DIST [PYTHON…]: for each Python (default: python3, and the first of python3.13, python3.14 and python3.12 that is there with its
# headers) builds the wheel of python/ into DIST, makes it self-contained, and tests it in an environment with nothing but NumPy.
set -euo pipefail
mkdir -p "${1:?a folder for the wheels}"
dist=$(cd "$1" && pwd)
shift
cd "$(dirname "$(readlink -f "$0")")/.."

hasHeaders() { command -v "$1" >/dev/null && "$1" -c 'import os, sysconfig; raise SystemExit(not os.path.exists(sysconfig.get_paths()["include"] + "/Python.h"))' 2>/dev/null; }
pythons=("$@")
if [ ${#pythons[@]} -eq 0 ]; then
    pythons=(python3)
    # pyenv's own commands only name those that are there.
    for later in python3.13 python3.14 python3.12 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.1[2-9]*/bin/python3; do
        if hasHeaders "$later"; then pythons+=("$later"); break; fi
    done
    [ ${#pythons[@]} -gt 1 ] || echo "no Python 3.12 or later with headers is here: only the wheel of python3 is built" >&2
fi

for python in "${pythons[@]}"; do
    tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
    build=build/wheel-$tag
    [ -d "build/wheel-venv-$tag" ] || "$python" -m venv "build/wheel-venv-$tag"
    tools=$PWD/build/wheel-venv-$tag/bin
    "$tools/pip" install --quiet -r python/requirements.txt
    rm -rf "$build-raw"
    # At the depth of build/release, so that ccache knows its sources again.
    PATH=$tools:$PATH "$tools/pip" wheel --quiet --no-build-isolation --no-deps --wheel-dir "$build-raw" \
        -C "build-dir=$PWD/$build" ${CI:+-C cmake.define.CMAKE_UNITY_BUILD=ON} ./python
    # A wheel for later versions holds a module for later versions: its name alone says nothing.
    if [ "$tag" != cp311 ] && ! unzip -l "$build-raw"/hairloom-*.whl | grep '/_core\.abi3\.so$' >/dev/null; then
        echo "error: the wheel for Python 3.12 and later was built without the stable ABI" >&2
        exit 1
    fi
    rm -f "$dist"/hairloom-*-"$tag"-*.whl
    [ "$tag" = cp311 ] || rm -f "$dist"/hairloom-*-abi3-*.whl
    # libraries that every Linux has stay out; drivers are loaded by name at run time
    PATH=$tools:$PATH "$tools/auditwheel" repair --wheel-dir "$build-repaired" "$build-raw"/hairloom-*.whl
    wheel=$(ls -t "$build-repaired"/hairloom-*.whl | head -1)
    cp "$wheel" "$dist/"

    # Nothing of this machine but Python, NumPy, the C library and what manylinux counts as the system's may be found beside it:
    # Python's own pyexpat needs libexpat.
    bare=build/wheel-bare-$tag
    rm -rf "$bare"
    "$python" -m venv "$bare"
    "$bare/bin/pip" install --quiet "numpy==$(sed -n 's/^numpy==//p' python/requirements.txt)"
    "$bare/bin/pip" install --quiet --no-index --no-deps "$wheel"
    package=$("$bare/bin/python" -c 'import hairloom, os; print(os.path.dirname(hairloom.__file__))')
    missing=$(ldd "$package"/_core*.so "$package"/bin/* | awk '$2 == "=>" { print $1, $3 }' |
        grep -vE '^(linux-vdso|libc|libm|libstdc\+\+|libgcc_s|libpthread|libdl|librt|libz|libexpat)\.so' | grep -v "/hairloom.libs/" | sort -u || true)
    [ -z "$missing" ] || { printf 'error: the wheel is not self-contained:\n%s\n' "$missing" >&2; exit 1; }
    (cd python/tests && PYTHONDONTWRITEBYTECODE=1 "../../$bare/bin/python" -m unittest)
    # The stubs are what the package is, and what its examples and tests hold to.
    "$tools/mypy" --strict --python-executable "$bare/bin/python" --cache-dir "build/mypy-$tag" -p hairloom
    MYPYPATH=python/tests "$tools/mypy" --strict --python-executable "$bare/bin/python" --cache-dir "build/mypy-$tag" \
        python/generate_jobs.py python/tests/*.py samples/python/groom_heads.py
    for recipe in samples/python/accuracy_plot.py samples/python/strands_to_cards.py; do
        "$tools/mypy" --strict --python-executable "$bare/bin/python" --cache-dir "build/mypy-$tag" --ignore-missing-imports "$recipe"
    done
    # Beside this machine's libraries a missing one would not be noticed.
    if [ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null; then
        packaging/verify_wheel.sh "$dist/$(basename "$wheel")" build/wheel-roots
    else
        echo "the wheel was not tried in a bare Debian, which needs root and debootstrap" >&2
    fi
    ls -l "$dist/$(basename "$wheel")"
done
