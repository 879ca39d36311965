#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: findings/gcc12-contract-off.sh
# GCC 12.2.0 (Debian 12, 12.2.0-14+deb12u1) fuses products with sums although -ffp-contract=off forbids it, where it makes a
# vector of a difference and a sum side by side, as products of complex numbers and of quaternions have them. Both vectorisers do
# so: the one of straight code (-fno-tree-slp-vectorize stops it) and the one of loops (-fno-tree-loop-vectorize). Whoever promises
# the same bits from several compilers needs both switches beside -ffp-contract=off.
# Compiles 5 lines for processors with FMA and counts the fused instructions. Fails if any count is another one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq cpp-12=12.2.0-14+deb12u1 g++-12=12.2.0-14+deb12u1 libisl23 libmpc3 libmpfr6 libgmp10 libzstd1 zlib1g
for package in *.deb; do dpkg -x "$package" root; done
export LD_LIBRARY_PATH=$folder/root/usr/lib/x86_64-linux-gnu:$folder/root/lib/x86_64-linux-gnu
cat > product.cpp <<'CODE'
struct Complex { double re, im; };
Complex product(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
void products(const Complex* a, const Complex* b, Complex* out, int count) {
    for (int i = 0; i < count; ++i) out[i] = product(a[i], b[i]);
}
CODE
compiler=root/usr/lib/gcc/x86_64-linux-gnu/12/cc1plus
"$compiler" -version /dev/null -o /dev/null 2>&1 </dev/null | sed -n 1p
failed=0
# fused EXPECTED OPTIONS…
fused() {
    local expected=$1 found
    shift
    "$compiler" -quiet -std=c++20 -mavx2 -mfma -ffp-contract=off "$@" product.cpp -o product.s
    found=$(grep -cE '^\s*vf(n?madd|n?msub)' product.s || true)
    printf '%-64s %s fused instructions\n' "-ffp-contract=off $*" "$found"
    [ "$found" -eq "$expected" ] || { echo "error: expected $expected" >&2; failed=1; }
}
fused 0 -O1
fused 4 -O3
fused 2 -O3 -fno-tree-slp-vectorize
fused 0 -O3 -fno-tree-slp-vectorize -fno-tree-loop-vectorize
exit "$failed"
