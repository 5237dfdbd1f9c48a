#!/usr/bin/env bash
# Each installed header compiles alone, as C and as C++; a library of the same objects shows what they declare, and nothing else.
set -eu
build=$(dirname "$1") source=$2
if grep -q '^LAMELLA_SANITIZE:STRING=.' "$build/CMakeCache.txt" || grep -q '^LAMELLA_COVERAGE:BOOL=ON' "$build/CMakeCache.txt"; then
  exit 77 # instruments show symbols of their own
fi
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cmake --install "$build" --prefix "$dir/usr" >"$dir/install.log" || { cat "$dir/install.log"; exit 1; }
export PKG_CONFIG_PATH=$(dirname "$(find "$dir/usr" -name lamella.pc)")
failed=0
fail() { echo "FAILED: $*"; failed=1; }

for header in "$dir"/usr/include/lamella/*.h; do
  name=lamella/$(basename "$header")
  cc -std=c17 -D_GNU_SOURCE -Wall -Wextra -Werror -Wno-unused-parameter -fsyntax-only -x c $(pkg-config --cflags lamella) - <<<"#include <$name>" ||
    fail "$name as C"
  c++ -std=c++17 -Wall -Werror -fsyntax-only -x c++ $(pkg-config --cflags lamella) - <<<"#include <$name>" || fail "$name as C++"
done

library=$(find "$dir/usr/lib" -name 'liblamella.a' -o -name 'liblamella.so')
if [ "${library%.a}" != "$library" ]; then
  cc -shared -o "$dir/liblamella.so" -Wl,--whole-archive "$library" -Wl,--no-whole-archive
  library=$dir/liblamella.so
fi
nm -D --defined-only "$library" | awk '$3 !~ /^(__bss_start|_edata|_end)$/ {print $3}' | sort >"$dir/shown"
# what the preprocessor leaves of the headers: a name after each mark
cc -E -P -x c -DLAM_EXPORT=LAM_EXPORT -DLAMELLA_EXPORT_H -DLAM_C_BEGIN= -DLAM_C_END= $(pkg-config --cflags lamella) - \
  <<<'#include <lamella/lamella.h>' | tr '\n' ' ' | sed 's/LAM_EXPORT/\n&/g' | sed -n 's/^LAM_EXPORT [^([;]*\b\(Lam[A-Za-z0-9]*\) *[[(;].*/\1/p' | sort >"$dir/declared"
[ "$(wc -l <"$dir/declared")" -gt 100 ] || fail "only $(wc -l <"$dir/declared") names declared"
diff "$dir/declared" "$dir/shown" >"$dir/diff" || fail "declared (<) and shown (>) differ:" $(grep '^[<>]' "$dir/diff")
# a function of the headers without the mark
sed 's/^static.*//' "$dir"/usr/include/lamella/*.h | grep -E '^[A-Za-z][A-Za-z0-9_ *]* \**Lam[A-Z][A-Za-z0-9]*\(' | grep -vE '^(LAM_EXPORT|typedef)' && fail "without LAM_EXPORT"
exit $failed
