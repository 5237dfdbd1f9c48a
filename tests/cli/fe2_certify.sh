# lamella fe2 --certify: corrected reactions are those of the direct run, and the run itself is as without.
. "$(dirname "$0")/common.sh"

sed 's/elements: \[8, 8\]/elements: [3, 3]/' "$source/tests/scenes/tissue-block.yaml" >block.yaml
grep -q '\[3, 3\]' block.yaml || fail "the scene has another mesh than this test thinks"
"$lamella" fe2 block.yaml --json --quiet >direct.txt || fail "the direct run"
"$lamella" fe2 block.yaml -d plain.h5 --json --quiet >plain.txt || fail "the cached run"
expect 0 "$lamella" fe2 block.yaml -d certified.h5 -o out.h5 --certify --json --quiet
/usr/bin/python3 - <<'PYTHON' || fail "certified reactions: $(cut -c1-400 out.txt)"
import csv, json
direct, plain, certified = ([json.loads(line) for line in open(name)] for name in ("direct.txt", "plain.txt", "out.txt"))
rows = list(csv.DictReader(open("out.csv")))
assert len(direct) == len(certified) == len(rows) == len(plain)
worst = off = 0
for d, p, c, row in zip(direct, plain, certified, rows):
    assert "certified" not in p
    for i in range(2):
        wanted = d["reaction"]["top"][i]
        assert abs(float(row[f"top R{i + 1} certified (N/mm)"]) - c["certified"]["top"][i]) < 1e-9
        assert abs(p["reaction"]["top"][i] - c["reaction"]["top"][i]) < 1e-9 * max(abs(wanted), 1e-3)
        if d["step"]:
            worst = max(worst, abs(c["certified"]["top"][i] / wanted - 1))
            off = max(off, abs(c["reaction"]["top"][i] / wanted - 1))
assert worst < 1e-4 < 1e-3 < off, (worst, off)
PYTHON

# on two ranks as on one, and in the table
last=$(/usr/bin/python3 -c 'import json; print("%.4e" % [json.loads(l) for l in open("out.txt")][-1]["certified"]["top"][0])')
expect 0 -o "certified .* $last" mpirun -n 2 "$lamella" fe2 block.yaml -d certified.h5 --certify --quiet
expect 1 -e 'here all are solved' "$lamella" fe2 block.yaml --certify
sed '/^sample:/,/^macro:/{/^macro:/!d}; s/mode: prescribed/mode: sealed/' block.yaml >sealed.yaml
expect 2 -e 'cannot be certified' "$lamella" fe2 sealed.yaml -d sealed.h5 --certify
