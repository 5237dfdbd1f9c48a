# slow: Installed with a static and with a shared library and moved, Lamella runs from there: program, Python package, the UMAT
# of hosts, examples; CMake finds it by both spellings of its name.
. "$(dirname "$0")/common.sh"
package h5py
unset PYTHONPATH LAMELLA_LIBRARY

run() { "$@" >log 2>&1 || { cat log; fail "$*"; }; }

for shared in OFF ON; do
  run cmake -S "$source" -B build$shared -DBUILD_SHARED_LIBS=$shared -DBUILD_TESTING=OFF
  run cmake --build build$shared --parallel 2
  run cmake --install build$shared --prefix "$work/empty"
  prefix=$work/moved$shared
  mv empty "$prefix"
  mv build$shared away # nothing is found in the build
  scene=$prefix/share/doc/lamella/tests/scenes/shear-bonded.yaml

  expect 0 "$prefix/bin/lamella" rve "$scene" --no-estimate -o states.h5
  expect 0 "$prefix/bin/lamella" plot states.h5 -o states.png
  expect 0 env PYTHONPATH="$prefix/share/lamella/python" "$python" - "$scene" "$prefix" <<'PYTHON'
import sys, lamella, lamella.program, lamella.validation as validation
scene, prefix = sys.argv[1:]
assert lamella.__file__.startswith(prefix) and lamella.RVE(scene).solve([[1, 0.1], [0, 1]]).converged
assert lamella.program._program() == prefix + "/bin/lamella" and lamella.run("check", scene).complete
assert str(validation.TISSUES).startswith(prefix) and list(validation.TISSUES.glob("*.yaml"))
PYTHON
  expect 0 "$python" - "$prefix" <<'PYTHON'
import ctypes, glob, sys
umat, = glob.glob(sys.argv[1] + "/lib/**/libLAMELLAUMAT.so", recursive=True)
umat = ctypes.CDLL(umat)
assert umat.CALCULIX and umat.umat_ and umat.LamBindStart() == 0
PYTHON
  for name in Lamella lamella; do
    sed "s/find_package(Lamella/find_package($name/" -i "$prefix/share/doc/lamella/examples/CMakeLists.txt"
    run cmake -S "$prefix/share/doc/lamella/examples" -B examples$name$shared -DCMAKE_PREFIX_PATH="$prefix"
    sed "s/find_package(lamella/find_package(Lamella/" -i "$prefix/share/doc/lamella/examples/CMakeLists.txt"
  done
  run cmake --build exampleslamella$shared
  expect 0 -o 'dP12/dF12 ' exampleslamella$shared/example_state "${scene%bonded.yaml}contact.yaml"
  rm -rf away
done
