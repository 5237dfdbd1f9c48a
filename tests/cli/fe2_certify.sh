# lamella fe2: reactions corrected by direct solves at all points or a sample, and the run itself as without.
. "$(dirname "$0")/common.sh"

sed 's/elements: \[8, 8\]/elements: [3, 3]/' "$source/tests/scenes/tissue-block.yaml" >block.yaml
grep -q '\[3, 3\]' block.yaml || fail "the scene has another mesh than this test thinks"
"$lamella" fe2 block.yaml --json --quiet >direct.txt || fail "the direct run"
"$lamella" fe2 block.yaml -d plain.h5 --no-certify --json --quiet >plain.txt || fail "the cached run"
"$lamella" fe2 block.yaml -d sample.h5 -o sampled.h5 --json --quiet >sample.txt || fail "the run with a sample"
expect 0 "$lamella" fe2 block.yaml -d certified.h5 -o out.h5 --certify --json --quiet
/usr/bin/python3 - <<'PYTHON' || fail "certified reactions: $(cut -c1-400 out.txt)"
import csv, json
names = "direct.txt", "plain.txt", "out.txt", "sample.txt"
direct, plain, certified, sample = ([json.loads(line) for line in open(name)] for name in names)
rows = list(csv.DictReader(open("out.csv")))
assert len(direct) == len(certified) == len(rows) == len(plain) == len(sample)
worst = off = 0
for d, p, c, s, row in zip(direct, plain, certified, sample, rows):
    assert "certified" not in p and "uncertified" not in p
    assert ("certified" in s) == (s is sample[-1])
    assert c["certified_points"] == c["interpolated_points"] if d["step"] else 1
    for i in range(2):
        wanted = d["reaction"]["top"][i]
        assert abs(float(row[f"top R{i + 1} certified (N/mm)"]) - c["certified"]["top"][i]) < 1e-9
        assert abs(float(row[f"top R{i + 1} margin (N/mm)"]) - c["certified_margin"]["top"][i]) < 1e-9
        assert abs(p["reaction"]["top"][i] - c["reaction"]["top"][i]) < 1e-9 * max(abs(wanted), 1e-3)
        assert p["reaction"]["top"] == s["reaction"]["top"]
        if d["step"]:
            worst = max(worst, abs(c["certified"]["top"][i] / wanted - 1))
            off = max(off, abs(c["reaction"]["top"][i] / wanted - 1))
            assert abs(c["certified"]["top"][i] - wanted) <= c["certified_margin"]["top"][i]
assert worst < 2e-4 < 1e-3 < off, (worst, off)
# the sample at the end
d, s, row = direct[-1], sample[-1], list(csv.DictReader(open("sampled.csv")))[-2:]
assert 12 <= s["certified_points"] < s["interpolated_points"] == 81, s
assert row[0]["top R1 certified (N/mm)"] == "" and row[1]["top R1 certified (N/mm)"]
for i in range(2):
    wanted = d["reaction"]["top"][i]
    assert abs(s["certified"]["top"][i] - wanted) <= s["certified_margin"]["top"][i] < 0.01 * abs(wanted), (i, s)
assert abs(s["certified"]["top"][0] / d["reaction"]["top"][0] - 1) < 2e-3
PYTHON

# on two ranks as on one, and in the table
last=$(/usr/bin/python3 -c 'import json; print("%.4e" % [json.loads(l) for l in open("out.txt")][-1]["certified"]["top"][0])')
expect 0 -o "certified .* $last" mpirun -n 2 "$lamella" fe2 block.yaml -d certified.h5 --certify --quiet
expect 1 -e 'here all are solved' "$lamella" fe2 block.yaml --certify
expect 1 -e 'exclude each other' "$lamella" fe2 block.yaml -d certified.h5 --certify --no-certify
sed '/^sample:/,/^macro:/{/^macro:/!d}; s/mode: prescribed/mode: sealed/' block.yaml >sealed.yaml
expect 2 -e 'cannot be certified' "$lamella" fe2 sealed.yaml -d sealed.h5 --certify
expect 0 -o 'certified  no: .*sealed' "$lamella" fe2 sealed.yaml -d sealed.h5 --quiet

# a sample is the same on two ranks; after --resume it is that of the run that was not interrupted
"$lamella" fe2 block.yaml -d plain.h5 --json --quiet >one.txt || fail "one rank"
mpirun -n 2 "$lamella" fe2 block.yaml -d plain.h5 --json --quiet >two.txt || fail "two ranks"
/usr/bin/python3 - <<'PYTHON' || fail "samples differ: $(tail -n 1 one.txt two.txt)"
import json
one, two = ([json.loads(line) for line in open(name)][-1] for name in ("one.txt", "two.txt"))
assert one["certified_points"] == two["certified_points"]
for key in "certified", "certified_margin":
    for a, b in zip(one[key]["top"], two[key]["top"]):
        assert abs(a - b) < 1e-6 * abs(one["certified"]["top"][0]), (key, a, b)
PYTHON
