#!/usr/bin/env bash
# An installed Lamella is found by pkg-config and by CMake; a program that reads a scene links and runs with both, and with a
# shared library. Its version is one everywhere. Completion, manual, documents and examples come with it.
set -eu
lamella=$1
build=$(dirname "$lamella")
if grep -q '^LAMELLA_SANITIZE:STRING=.' "$build/CMakeCache.txt" || grep -q '^LAMELLA_COVERAGE:BOOL=ON' "$build/CMakeCache.txt"; then
  exit 77 # an instrumented library needs the same flags in its user
fi
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cmake --install "$build" --prefix "$dir/usr" >"$dir/install.log" || { cat "$dir/install.log"; exit 1; }
mkdir "$dir/user"
cat >"$dir/user/main.c" <<'C'
#include <lamella/lamella.h>
#include <stdio.h>

int main(int argc, char **argv)
{
  LamScene *scene;

  if (argc == 1) return printf("%s %d.%d.%d\n", LAMELLA_VERSION, LAMELLA_VERSION_MAJOR, LAMELLA_VERSION_MINOR, LAMELLA_VERSION_PATCH) < 0;
  if (argc != 2 || LamSceneRead(argv[1], &scene)) return 1;
  printf("%d loads\n", (int)scene->load_count);
  return LamSceneDestroy(&scene) ? 1 : 0;
}
C
cat >"$dir/user/CMakeLists.txt" <<'C'
cmake_minimum_required(VERSION 3.22)
project(user LANGUAGES C)
find_package(Lamella REQUIRED)
add_executable(user main.c)
target_link_libraries(user PRIVATE Lamella::lamella)
C
pc=$(dirname "$(find "$dir/usr" -name lamella.pc)")
export PKG_CONFIG_PATH=$pc
cc "$dir/user/main.c" -o "$dir/by-pkg-config" $(pkg-config --cflags --libs lamella)
library=$(find "$dir/usr/lib" -name 'liblamella.a' -o -name 'liblamella.so')
if [ "${library%.a}" != "$library" ]; then # the same objects
  cc -shared -o "$dir/liblamella.so" -Wl,-soname,liblamella.so -Wl,--whole-archive "$library" -Wl,--no-whole-archive $(pkg-config --libs lamella)
  library=$dir/liblamella.so
fi
cc "$dir/user/main.c" -o "$dir/shared" $(pkg-config --cflags lamella) "$library" -Wl,-rpath,"$(dirname "$library")" $(pkg-config --libs PETSc)
export LD_LIBRARY_PATH=$(dirname "$library")
cmake -S "$dir/user" -B "$dir/user/build" -DCMAKE_PREFIX_PATH="$dir/usr" >"$dir/cmake.log" 2>&1 || { cat "$dir/cmake.log"; exit 1; }
cmake --build "$dir/user/build" >"$dir/cmake.log" 2>&1 || { cat "$dir/cmake.log"; exit 1; }
for program in "$dir/by-pkg-config" "$dir/user/build/user" "$dir/shared"; do
  [ "$("$program" "$2/tests/scenes/shear-bonded.yaml")" = "3 loads" ] || { echo "FAILED: $program does not read a scene"; exit 1; }
done
version=$(pkg-config --modversion lamella)
[ "$("$dir/shared")" = "$version $version" ] || { echo "FAILED: $("$dir/shared"), but pkg-config says $version"; exit 1; }
"$dir/usr/bin/lamella" --version | grep -q "^lamella $version" || { echo "FAILED: the installed program does not run"; exit 1; }

share=$dir/usr/share
for shell in bash zsh; do "$dir/usr/bin/lamella" completion $shell >"$dir/$shell"; done
"$dir/usr/bin/lamella" manual >"$dir/manual"
cmp "$dir/bash" "$share/bash-completion/completions/lamella"
cmp "$dir/zsh" "$share/zsh/site-functions/_lamella"
cmp "$dir/manual" "$share/man/man1/lamella.1"
diff -r "$2/docs" "$share/doc/lamella/docs"
"$dir/usr/bin/lamella" check "$share/doc/lamella/tests/scenes/shear-bonded.yaml" >/dev/null
# what the installed documents refer to has come, too
while IFS= read -r document; do
  while IFS= read -r link; do
    [ -e "$(dirname "$document")/$link" ] || { echo "FAILED: $document refers to $link, which is not installed"; exit 1; }
  done < <(sed 's/^    .*//' "$document" | grep -oE '\]\([^)# ]+' | cut -c3- | grep -v :)
done < <(find "$share/doc/lamella" -name '*.md')
cmake -S "$share/doc/lamella/examples" -B "$dir/examples" -DCMAKE_PREFIX_PATH="$dir/usr" >"$dir/cmake.log" 2>&1 || { cat "$dir/cmake.log"; exit 1; }
