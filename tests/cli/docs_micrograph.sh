# slow: docs/micrograph.md shows what its commands print: from a label image to a force curve.
. "$(dirname "$0")/common.sh"
package scipy PIL h5py matplotlib
"$python" "$source/tests/cli/docs.py" "$lamella" "$source" docs/micrograph.md
