#!/usr/bin/env bash
# An installed Lamella is found by pkg-config and by CMake, and a program that reads a scene links and runs with both.
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
cmake -S "$dir/user" -B "$dir/user/build" -DCMAKE_PREFIX_PATH="$dir/usr" >"$dir/cmake.log" 2>&1 || { cat "$dir/cmake.log"; exit 1; }
cmake --build "$dir/user/build" >"$dir/cmake.log" 2>&1 || { cat "$dir/cmake.log"; exit 1; }
for program in "$dir/by-pkg-config" "$dir/user/build/user" ; do
  [ "$("$program" "$2/tests/scenes/shear-bonded.yaml")" = "3 loads" ] || { echo "FAILED: $program does not read a scene"; exit 1; }
done
"$dir/usr/bin/lamella" --version | grep -q '^lamella ' || { echo "FAILED: the installed program does not run"; exit 1; }
