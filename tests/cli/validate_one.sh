# lamella validate: one experiment, as JSON; names; mistakes.
. "$(dirname "$0")/common.sh"
package scipy

expect 0 "$lamella" validate --list
has out.txt '^calbo-nery$' '^paper$'
expect 0 "$lamella" validate --only calbo-nery,paper --json
python3 - <<'PYTHON' || fail "the objects"
import json
calbo, paper, last = map(json.loads, open("out.txt"))
assert calbo["verdict"] == "within" and len(calbo["rows"]) == 5 and paper["verdict"] == "none", (calbo, paper)
for row in calbo["rows"]:
    law = (row["low"] + row["high"]) / 2
    assert abs(row["predicted"] / law - 1) < 1e-3, row  # docs/results/validation.md: 0.07 %
assert all(mode["right"] for mode in paper["modes"]), paper
assert last["summary"] == {"experiments": 2, "predicted": 1, "within": 1, "figures": 5, "inside": 5,
                           "by_interval": 0, "modes": 3, "right": 3}, last
PYTHON
# a figure without an answer agrees with nothing, and one whose interval alone reaches what was measured is told as such
"$python" - <<'PYTHON' || fail "the rules"
import math
from lamella.validation import Row
nan = math.nan
assert not Row("", "", 1, 2, nan, (0.5, 3)).within and Row("", "", 1, 2, nan, (0.5, 3)).miss == math.inf
assert Row("", "", 1, 2, 1.5, (nan, nan)).within and Row("", "", 1, 2, 1.5).miss == 1
wide = Row("", "", 1, 2, 0.5, (0.4, 1.1))
assert wide.within and not wide.inside
assert math.isclose(Row("", "", 1, 2, 0.5, (0.4, 0.8)).miss, 1.25) and math.isclose(Row("", "", 1, 2, 6, (4, 8)).miss, 2)
PYTHON

expect 2 -e "no-such: there is no such experiment; there are calbo-nery" "$lamella" validate --only no-such
touch file
expect 4 "$lamella" validate --only paper -o file/folder
