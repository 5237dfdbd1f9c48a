#!/usr/bin/env bash
# Fibres that stiffen exponentially, in all commands that know the parameters of a wall.
. "$(dirname "$0")/common.sh"
serve=1
set -e -o pipefail
scene=$source/tests/scenes/stiffening.yaml
law='law: fibre_exponential'

# first FILE: P11 of its last state
first() { sed -n '$p' "$1" | sed 's/.*"P": \[\([-0-9.e+]*\),.*/\1/'; }

expect 0 "$lamella" check "$scene"
grep -q 'fibre_exponential: C1 0.1, C2 0.01, k1 0.5, k2 5 (a number), dispersion 0 (a number) (fibres: both)' out.txt || fail "check: $(cat out.txt)"
expect 0 "$lamella" rve "$scene" --json
cp out.txt stiff.txt
[ "$(grep -c '"status": "converged"' stiff.txt)" = 3 ] || fail "not three states: $(cat stiff.txt)"

# without an exponent they are the quadratic fibres
sed 's/k2: 5/k2: 0/' "$scene" >flat.yaml
expect 0 "$lamella" rve flat.yaml --json
cp out.txt flat.txt
sed '/^map/,$d' "$scene" | sed "s/$law/law: fibre_mooney_rivlin/; s/k1: 0.5 MPa, k2: 5/C4: 1 MPa/" >quadratic.yaml
expect 0 "$lamella" rve quadratic.yaml --json
awk "BEGIN { d = $(first flat.txt) / $(first out.txt) - 1; exit !(d * d < 1e-20) }" || fail "k2 = 0: $(first flat.txt), not $(first out.txt)"
awk "BEGIN { exit !($(first stiff.txt) > 1.1 * $(first flat.txt)) }" || fail "does not stiffen: $(first stiff.txt)"

# a database, and what it says where it was not solved
expect 0 "$lamella" build "$scene" -d d.h5
expect 0 "$lamella" query d.h5 -F '1.02 0.005 0 1.01' -p '0.02 MPa' --json
cp out.txt query.txt
sed 's/- {ramp.*/- {F: [[1.02, 0.005], [0, 1.01]], turgor: 0.02 MPa}/; /^map/,/^process/d' "$scene" | sed '/^  duration/,$d' >one.yaml
expect 0 "$lamella" rve one.yaml --json
awk "BEGIN { d = $(first query.txt) - ($(first out.txt)); exit !(d * d < 1e-6) }" || fail "query: $(first query.txt), solved $(first out.txt)"

# one parameter that changes in time: solved directly, in the file, refused of a database
expect 0 -o '"k1": 0.62' "$lamella" process "$scene" -o p.h5 --json
expect 0 "$lamella" plot --dpi 40 p.h5 -o p.svg
expect 2 -e 'the parameters of the walls do not change alike' "$lamella" process "$scene" -d d.h5
sed 's/of: k1/of: C4/' "$scene" >lacks.yaml
expect 2 -e 'C4: no wall of the scene has it' "$lamella" check lacks.yaml

# a map over the exponent, and over the modulus
expect 0 "$lamella" map "$scene" -o m.h5
expect 0 "$lamella" plot --dpi 40 m.h5 -o m.svg
sed 's/quantity: k2, from: 0, to: 10/quantity: k1, from: 0.1 MPa, to: 1 MPa/' "$scene" >modulus.yaml
expect 0 "$lamella" map modulus.yaml -o m1.h5

# dispersed fibres: softer along the wall, as soft as the matrix in shear of small strain; not beyond 1/3
sed 's/k2: 5/k2: 5, dispersion: 0.25/' "$scene" >dispersed.yaml
expect 0 -o 'k2 5 (a number), dispersion 0.25 (a number)' "$lamella" check dispersed.yaml
expect 0 "$lamella" rve dispersed.yaml --json
awk "BEGIN { exit !($(first out.txt) < 0.9 * $(first stiff.txt)) }" || fail "not softer: $(first out.txt)"
sed 's/k2: 5/k2: 5, dispersion: 0.4/' "$scene" >beyond.yaml
expect 2 -e 'beyond.yaml:5:.*rve.wall.dispersion: 0.4' "$lamella" check beyond.yaml
sed 's/of: k1, law: fractional_conversion, rate: 0.5 .day, plateau: 0.4/of: dispersion, law: fractional_conversion, rate: 0.5 \/day, plateau: 2/' \
  dispersed.yaml >grows.yaml
expect 2 -e 'dispersion grows to 2 times its value, 0.5, beyond 0.333333' "$lamella" check grows.yaml

# what a law lacks, or needs
sed 's/k2: 5/k2: 5, C4: 1 MPa/' "$scene" >both.yaml
expect 2 -e 'law fibre_exponential has no C4; leave C4 out' "$lamella" check both.yaml
sed 's/, k2: 5//' "$scene" >missing.yaml
expect 2 -e 'rve.wall.k2: missing' "$lamella" check missing.yaml

# an exponential function beyond all numbers ends with a reason, without a NaN
sed 's/k2: 5/k2: 1e5/; s/1.15, 0\], \[0, 1/2, 0], [0, 2/' "$scene" >huge.yaml
expect 3 "$lamella" rve huge.yaml --json
grep -qi 'nan' out.txt && fail "a NaN: $(cat out.txt)"
grep -q '"reason": "[a-z]' out.txt || fail "no reason: $(cat out.txt)"
