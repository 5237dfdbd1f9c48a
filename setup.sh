#!/usr/bin/env bash
# Sets Lamella up on Debian 12 or 13.
#   ./setup.sh            install what is missing, build the program, show its Python package to /usr/bin/python3, run the
#                         main job and show its result
#   ./setup.sh test       install what is missing, build everything, run the tests
#   ./setup.sh deps       only install what is missing
#   ./setup.sh notebook   install Jupyter's notebook, too, and open those of docs/notebooks
#   ./setup.sh partners   install FEniCSx and build CalculiX for their tests, where Debian has them
#   ./setup.sh fuzz       install clang, too, and build the targets of tests/fuzz with it
# Needs root or sudo only where a package is missing.
set -euo pipefail
cd "$(dirname "$0")"

packages=(
  build-essential cmake ninja-build pkg-config
  libpetsc-real-dev libmumps-dev libmetis-dev libsundials-dev libhdf5-openmpi-dev libopenmpi-dev openmpi-bin
  libopenblas0-serial # MUMPS is 1.4 to 2.4 times faster with it than with the reference BLAS
  libfyaml-dev libudunits2-dev libjansson-dev zlib1g-dev
  libmuparser-dev # expressions of the position
  python3-numpy python3-cffi python3-yaml python3-h5py python3-matplotlib python3-scipy # of the Python package
)
test_packages=(libcmocka-dev python3-pip python3-setuptools python3-venv python3-wheel python3-meshio
  python3-nbclient python3-ipykernel) # of the notebooks
fuzz_packages=(clang libclang-rt-dev)

# One thread per rank, on one machine as on a cluster; Open MPI refuses root unless it is told.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
if [ "$(id -u)" = 0 ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

install_missing() {
  local missing=() as_root=()
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "setup.sh: missing packages, and neither root nor sudo: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
}

build() { # PRESET DIRECTORY [OPTIONS]
  cmake --preset "$1" -G Ninja >"$1.cmake.log" 2>&1 || { cat "$1.cmake.log"; rm -f "$1.cmake.log"; exit 1; }
  rm -f "$1.cmake.log"
  cmake --build "${@:2}"
}

# A line in the user's own packages, as pip writes it for a source tree that stays where it is.
install_package() {
  local packages
  packages=$(/usr/bin/python3 -m site --user-site) || true
  mkdir -p "$packages"
  echo "$PWD/python" >"$packages/lamella.pth"
}

# The one that the system's alternatives choose; they are not touched, another program may need them as they are.
report_blas() {
  local blas
  blas=$(readlink -f "/usr/lib/$(gcc -print-multiarch)/libblas.so.3")
  case "$blas" in
  */openblas-*) echo "BLAS         $blas" ;;
  *) echo "BLAS         $blas: slow; update-alternatives --config libblas.so.3-$(gcc -print-multiarch) chooses OpenBLAS" ;;
  esac
}

main_job() {
  local begin=$SECONDS
  mkdir -p main-job
  echo
  echo "The main job: a block of tissue is inflated by its turgor, then sheared (tests/scenes/tissue-block.yaml)."
  build/lamella fe2 tests/scenes/tissue-block.yaml -o main-job/tissue-block.h5
  build/lamella plot main-job/tissue-block.h5 -o main-job/tissue-block.png
  echo "result       main-job/tissue-block.h5 (main-job/tissue-block.xdmf for ParaView)"
  echo "curves       main-job/tissue-block.csv"
  echo "picture      main-job/tissue-block.png"
  report_blas
  echo "time         $((SECONDS - begin)) s"
}

case "${1-run}" in
  deps) install_missing "${packages[@]}" "${test_packages[@]}" ;;
  run)
    install_missing "${packages[@]}" "${test_packages[@]}"
    build release build --target lamella lamella_program lamella_shared lamella_umat
    install_package
    main_job
    ;;
  test)
    install_missing "${packages[@]}" "${test_packages[@]}"
    build release build
    ctest --test-dir build -j2 --output-on-failure -LE 'slow|bench'
    ;;
  notebook)
    install_missing "${packages[@]}" python3-ipykernel jupyter-notebook
    build release build --target lamella lamella_program lamella_shared
    install_package
    exec jupyter notebook --notebook-dir=docs/notebooks
    ;;
  partners)
    install_missing "${packages[@]}"
    ! apt-cache show python3-dolfinx >/dev/null 2>&1 || install_missing python3-dolfinx
    ! apt-cache show calculix-ccx >/dev/null 2>&1 || [ -x build-ccx/ccx ] || integrations/calculix/build_ccx.sh build-ccx
    ;;
  fuzz)
    install_missing "${packages[@]}" "${test_packages[@]}" "${fuzz_packages[@]}"
    build fuzz build-fuzz --target fuzz
    ;;
  *) echo "usage: ./setup.sh [deps|test|notebook|partners|fuzz]" >&2; exit 1 ;;
esac
