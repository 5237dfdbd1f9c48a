#!/usr/bin/env bash
# Builds CalculiX with external behaviours, which Debian's own binary lacks, from Debian's own source package:
#   build_ccx.sh FOLDER     FOLDER/ccx is the program; two minutes on two cores
# For Debian 12: Debian 13 has no calculix-ccx. Installs the packages that it needs as root, or with sudo.
set -euo pipefail
[ $# = 1 ] || { echo "usage: $0 FOLDER" >&2; exit 2; }
mkdir -p "$1"
cd "$1"
folder=$PWD
as_root=()
[ "$(id -u)" = 0 ] || as_root=(sudo)

packages=(dpkg-dev gcc gfortran make perl libspooles-dev libarpack2-dev liblapack-dev)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  "${as_root[@]}" apt-get -qq update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
fi

# From the host that the binaries come from; apt checks the signature of its index and the sums of the sources. The index
# goes into a folder of our own, so that the system's lists stay as they are.
if ! compgen -G "calculix-ccx_*.dsc" >/dev/null; then
  uri=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    awk '$2 ~ /^[a-z]+$/ && $3 == "main" {print $1, $2; exit}')
  [ -n "$uri" ] || { echo "build_ccx.sh: apt knows no Debian archive (component main)" >&2; exit 1; }
  mkdir -p lists
  echo "deb-src $uri main" >sources.list
  options=(-o APT::Sandbox::User=root -o Dir::State::Lists="$folder/lists"
    -o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null)
  apt-get -qq "${options[@]}" update
  apt-get -qq "${options[@]}" source --download-only calculix-ccx
fi
rm -rf source
dpkg-source --no-check -x calculix-ccx_*.dsc source >/dev/null

cd source/ccx_*/src
version=$(basename "$(dirname "$PWD")")
sed -i 's/^LIBS *=.*/& -ldl/' Makefile
options='-I/usr/include/spooles -DARCH="Linux" -DSPOOLES -DARPACK -DMATRIXSTORAGE -DUSE_MT=1' # those of Debian
make -j"$(nproc)" "$version" CFLAGS="-O2 -w $options -DCALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT" \
  FFLAGS='-O2 -w -fallow-argument-mismatch' >"$folder/build.log" 2>&1 || { tail -20 "$folder/build.log" >&2; exit 1; }
cp "$version" "$folder/ccx"
echo "built $folder/ccx"
