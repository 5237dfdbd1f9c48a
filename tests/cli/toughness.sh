# slow: the torn patch of docs/results/tearing.md, Toughness, at the largest turgor
. "$(dirname "$0")/common.sh"

expect 0 "$lamella" rve "$source/tests/scenes/toughness.yaml" --no-estimate --json --quiet
/usr/bin/python3 - <<'PYTHON' || fail "the crack: $(tail -1 out.txt)"
import json
crack = json.loads(open("out.txt").read().splitlines()[-1])["crack"]
assert crack["length"] > 600
assert abs(crack["resistance"] - 8.42) < 0.05 * 8.42 and abs(crack["toughness"] - 2.77) < 0.03 * 2.77
PYTHON
