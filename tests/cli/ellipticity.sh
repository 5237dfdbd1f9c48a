# what the program says where tissue localises or its walls kink: rve, query, fe2
. "$(dirname "$0")/common.sh"
serve=1

# scene FIBRES LOADS...
scene() {
  tissue wall="law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa, fibres: $1" turgor='mode: none' \
    mesh='along: 6, through: 2' >scene.yaml </dev/null
  shift
  [ $# = 0 ] || printf 'load:\n' >>scene.yaml
  [ $# = 0 ] || printf '  - %s\n' "$@" >>scene.yaml
}
# value KEY FILE: a number of the last object
value() { tail -n 1 "$2" | sed -n "s/.*\"$1\": *\([-0-9.e+]*\)[,}].*/\1/p"; }
negative() { awk "BEGIN {exit !($1 < 0)}"; }

# compressed by 2 % the tangent has lost ellipticity, by 1 % not yet; the state is stable all the same
scene both "{F: [[0.99, 0], [0, 0.99]]}" "{F: [[0.98, 0], [0, 0.98]]}"
expect 0 "$lamella" rve scene.yaml --tangent -o states.h5
[ "$(grep -c 'lost ellipticity.*normal is at' out.txt)" = 1 ] || fail "localisation is not told once: $(cat out.txt)"
expect 0 "$lamella" rve scene.yaml --tangent --json
solved=$(value ellipticity out.txt)
negative "$solved" || fail "ellipticity of 2 % is $solved"
head -n 1 out.txt >first.txt
negative "$(value ellipticity first.txt)" && fail "ellipticity of 1 % is $(value ellipticity first.txt)"
expect 0 "$lamella" rve scene.yaml --json
grep -q '"ellipticity"' out.txt && fail "without a tangent there is an ellipticity"
expect 0 -o 'lost ellipticity' "$lamella" query states.h5 -F "0.98 0 0 0.98"
expect 0 "$lamella" query states.h5 -F "0.98 0 0 0.98" --json
awk "BEGIN {d = $(value ellipticity out.txt) - $solved; exit !(d * d < 1e-18)}" ||
  fail "query answers another ellipticity than $solved: $(value ellipticity out.txt)"

# walls that kink; with fibres in tension alone none do
scene both "{F: [[1, 0.5], [0, 1]]}"
expect 0 -e 'C4 (1 - I4) > C1 + C2' "$lamella" rve scene.yaml
expect 0 "$lamella" rve scene.yaml --json
awk "BEGIN {exit !($(value kinked_fraction out.txt) > 0.01)}" || fail "kinked_fraction is $(value kinked_fraction out.txt)"
expect 0 "$lamella" rve scene.yaml --quiet
grep -q 'C4' err.txt && fail "--quiet tells of kinks"
scene tension "{F: [[1, 0.5], [0, 1]]}"
expect 0 "$lamella" rve scene.yaml --json
grep -q 'C4' err.txt && fail "slack fibres kink: $(cat err.txt)"
[ "$(value kinked_fraction out.txt)" = 0.0 ] || fail "kinked_fraction of slack fibres is $(value kinked_fraction out.txt)"

# a body that is compressed in one direction: F = diag(1, 0.965) at all points
scene both
cat >>scene.yaml <<YAML
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary:
    - {on: bottom, displacement: [free, 0 mm]}
    - {on: left, displacement: [0 mm, free]}
    - {on: right, displacement: [0 mm, free]}
    - {on: top, displacement: [free, -0.35 mm]}
  steps: 2
YAML
expect 0 "$lamella" fe2 scene.yaml --json
[ "$(grep -c 'lost ellipticity' err.txt)" = 1 ] || fail "localisation of the body is not told once: $(cat err.txt)"
grep -q 'normal is at 90.0 degrees' err.txt || fail "the band is not across the compression: $(cat err.txt)"
[ "$(sed -n 1p out.txt | sed -n 's/.*"localised_points": \([0-9]*\).*/\1/p')" = 0 ] || fail "localised points of step 1"
[ "$(value localised_points out.txt)" = 9 ] || fail "localised points: $(value localised_points out.txt)"
negative "$(value ellipticity out.txt)" || fail "ellipticity of the body: $(value ellipticity out.txt)"
