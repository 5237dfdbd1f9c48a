#!/usr/bin/env bash
# Files that other programs have written anew: copies of h5py are read, packed ones are refused as what they are.
. "$(dirname "$0")/common.sh"

package h5py
for kind in contact rve fe2 map process; do
  gunzip -c "$source"/tests/verification/data/0.1/$kind.h5.gz >$kind.h5
done
"$python" - <<'PYTHON' || fail "the copies are not written"
import h5py

def repack(old, new, packing):
    new.attrs.update(old.attrs)
    for name, object in old.items():
        if isinstance(object, h5py.Group):
            repack(object, new.create_group(name), packing)
        else:
            options = dict(data=object[()], dtype=object.dtype, **(packing if object.size and object.shape else {}))
            new.create_dataset(name, **options).attrs.update(object.attrs)

for kind in "contact", "rve", "fe2", "map", "process":
    with h5py.File(kind + ".h5") as old:
        with h5py.File(kind + "-latest.h5", "w", libver="latest") as new:
            for name in old:
                old.copy(name, new)
            for name in old.attrs:
                new.attrs.create(name, old.attrs[name], dtype=old.attrs.get_id(name).dtype)
        for packing in {"compression": "gzip"}, {}:
            with h5py.File(kind + ("-gzip.h5" if packing else "-plain.h5"), "w") as new:
                repack(old, new, packing)
PYTHON

for kind in contact rve fe2 map process; do
  expect 0 -o '^state *sound$' "$lamella" info $kind-latest.h5 --check
  for packing in gzip plain; do
    expect 2 -e "^lamella: $kind-$packing.h5: .*another program has written it anew (h5py, h5repack)" "$lamella" info $kind-$packing.h5
  done
done
for file in contact contact-latest; do
  expect 0 "$lamella" query $file.h5 -F "1.01 0 0 1.01" --json
  grep -v seconds out.txt >$file.txt
done
cmp -s contact.txt contact-latest.txt || fail "a copy answers otherwise: $(cat contact.txt contact-latest.txt)"
