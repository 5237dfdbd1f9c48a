# slow: lamella tradeoff: what it measures, tells and writes; the same errors in every run; its end by a signal.
. "$(dirname "$0")/common.sh"

tissue mesh='along: 6, through: 2' >scene.yaml <<'YAML'
load:
  - {F: [[1, 0.05], [0, 1]]}
accuracy: 0.05
YAML

expect 0 "$lamella" tradeoff scene.yaml -o out --budget 20 --repeats 2 --only mesh,tolerance,cells --json --quiet
cp out.txt one.jsonl
[ ! -s err.txt ] || fail "speaks: $(cat err.txt)"
[ "$(grep -c '"family": *"mesh"' one.jsonl)" = 36 ] || fail "measures $(grep -c '"family": *"mesh"' one.jsonl) meshes"
[ "$(grep -c '"planned": *true' one.jsonl)" = 3 ] || fail "the plan is not in each family: $(cat one.jsonl)"
grep -q '"optimal": *true' one.jsonl || fail "nothing is the best"
grep -q '"runs": *2' one.jsonl || fail "nothing is repeated"
! grep -q '"runs": *0' one.jsonl || fail "leaves out: $(grep '"runs": *0' one.jsonl)"
for file in tradeoff.json model.json tradeoff.png tradeoff.svg; do
  [ -s out/$file ] || fail "$file is missing: $(ls out)"
done
head -c 4 out/tradeoff.png | grep -q PNG || fail "tradeoff.png is no picture"
[ "$(grep -c error_P_max out/model.json)" = 36 ] || fail "model.json: $(cat out/model.json)"
grep -q '"format": *1' out/model.json || fail "model.json has no format"
grep -q '"core_seconds"' out/tradeoff.json || fail "tradeoff.json has no times"
if command -v python3 >/dev/null; then
  python3 - <<'PYTHON' || fail "the files are no JSON, or do not fit"
import json
data, model = json.load(open("out/tradeoff.json")), json.load(open("out/model.json"))
assert [json.loads(line) for line in open("one.jsonl")] and len(data["settings"]) == 36 + 7 + 3
assert data["tissue"] == model["tissue"] and data["reference"] == model["reference"]
assert set(data["left_out"]) == {"strategy", "sharpness", "database", "macro"}
for s in data["settings"]:
    t = s["core_seconds"]
    assert 0 < t["min"] <= t["median"] <= t["max"]
    assert s["error"]["P"]["mean"] <= s["error"]["P"]["max"] * (1 + 1e-12)
    assert s["error"]["P"]["resolved"] == (s["error"]["P"]["max"] >= 10 * data["reference"]["error"]["P"])
PYTHON
fi

# the same errors again; which are the best depends on times
expect 0 "$lamella" tradeoff scene.yaml --budget 20 --repeats 1 --only mesh,tolerance,cells --json --quiet
for file in one.jsonl out.txt; do sed -E 's/"(core|wall)_seconds": *\{[^}]*\}//g; s/"(seconds_per_state|runs)": *[^,]*//g; s/"optimal": *[a-z]*//g' $file >$file.bare; done
cmp -s one.jsonl.bare out.txt.bare || fail "two runs differ in more than time: $(diff one.jsonl.bare out.txt.bare | head -4)"

# for a person
expect 0 "$lamella" tradeoff scene.yaml --budget 20 --repeats 1 --only tolerance
has out.txt "planned mesh 6 x 2" "^reference" "> tolerance *rounding" "rounding"

# without a load: states of the sample box, or a few of its own
grep -v -e '^load' -e '^  - ' scene.yaml >free.yaml
expect 0 -o "7 states (default)" "$lamella" tradeoff free.yaml --budget 20 --repeats 1 --only tolerance

# the law of contact
expect 0 "$lamella" tradeoff "$source/tests/scenes/shear-contact.yaml" --budget 20 --repeats 1 --only sharpness
has out.txt "> sharpness exact" "sharpness smooth, width 0.01" "sharpness smooth, width 0.001"

# mistakes
expect 1 "$lamella" tradeoff scene.yaml --only meshes
expect 1 "$lamella" tradeoff scene.yaml --budget 0
expect 1 "$lamella" tradeoff scene.yaml --repeats 0
expect 4 "$lamella" tradeoff scene.yaml -o no/such/folder
expect 4 "$lamella" tradeoff scene.yaml -o scene.yaml
expect 2 "$lamella" tradeoff missing.yaml

# no time for a reference: told, with what is there
expect 3 -o "^reference *none" "$lamella" tradeoff scene.yaml --budget 0.02 --only mesh

# a signal: what is there is told and written
mkdir temporary
TMPDIR=$PWD/temporary "$lamella" tradeoff scene.yaml -o stopped --budget 60 --repeats 100 --quiet >out.txt 2>err.txt &
child=$!
sleep 1.5
ends INT 130 $child
grep -q "stopped by a signal" out.txt || fail "the stop is not told: $(tail -1 out.txt)"
grep -q '"stopped": *true' stopped/tradeoff.json || fail "nothing is written at a stop"
[ -z "$(find temporary -name 'lamella-*')" ] || fail "tables are left behind: $(ls temporary)"
