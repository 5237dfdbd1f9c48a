# slow: lamella validate: docs/results/validation.md is what it writes; the modes are right, misses are those that are told.
. "$(dirname "$0")/common.sh"
package scipy matplotlib

expect 0 "$lamella" validate -o page
tail -2 out.txt
python3 - page/validation.md "$source/docs/results/validation.md" <<'PYTHON' || fail "the page"
import re, sys
found, shown = (open(path, encoding="utf-8").read() for path in sys.argv[1:])
NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?")
assert NUMBER.sub("#", found) == NUMBER.sub("#", shown), "other words"
# three digits, and other processors; there random tissues are others, and ends of the intervals of a few of them scatter
INTERVAL = re.compile(r"\(([-\d.e]+) to ([-\d.e]+)\)")
width = [abs(float(b) - float(a)) for a, b in INTERVAL.findall(shown) for _ in "ab"]
ends = {at: w for at, w in zip((m.start(k) for m in INTERVAL.finditer(shown) for k in (1, 2)), width)}
wrong = [(f, s[0]) for f, s in zip(NUMBER.findall(found), NUMBER.finditer(shown))
         if abs(float(f) - float(s[0])) > 0.03 * abs(float(s[0])) + 0.011 + 0.5 * ends.get(s.start(), 0)]
assert not wrong, wrong
assert not re.search(r"\| \*\*no\*\* \|$", found, re.M), "a mode or a trend is wrong"
PYTHON
[ -s page/validation.png ] || fail "no picture"
