# A time of day that jumps by hours changes nothing: the same records, and durations that are true.
. "$(dirname "$0")/common.sh"
jumps=$(dirname "$lamella")/tests/libclock_jumps.so
[ -f "$jumps" ] || exit 77
LD_PRELOAD=$jumps "$lamella" --version >out.txt 2>&1 || exit 77 # sanitizers want to be loaded first

# twice ARGUMENTS: the command, OUT being steady.h5, and again while the clock jumps; what it tells is in NAME.txt
twice() {
  for clock in steady jumping; do
    preload=
    [ $clock = steady ] || preload=$jumps
    begin=$(date +%s)
    LD_PRELOAD=$preload expect 0 "$lamella" $(echo "$@" | sed "s/OUT/$clock.h5/") --json --quiet
    grep -oE '"seconds": *[^,}]*' out.txt | tr -d '" ' | cut -d: -f2 >seconds.txt
    [ -s seconds.txt ] || fail "$1 tells no seconds: $(cat out.txt)"
    awk -v most=$(($(date +%s) - begin + 1)) '!($1 ~ /^[0-9]/) || $1 < 0 || $1 > most {exit 1}' seconds.txt ||
      fail "$1, clock $clock: seconds that cannot be: $(cat seconds.txt)"
    sed -E 's/"([a-z_]*seconds|peak_memory_mb)": *[^,}]*//g' out.txt >$clock.txt
  done
}

twice rve "$source/tests/scenes/shear-contact.yaml" -o r-OUT
cmp -s steady.txt jumping.txt || fail "rve: other states while the clock jumps: $(diff steady.txt jumping.txt | head -4)"

sed 's/elements: \[8, 8\]/elements: [2, 2]/; s/^  steps: 5/  steps: 2/' "$source/tests/scenes/tissue-block.yaml" >block.yaml
twice fe2 block.yaml -o f-OUT
cmp -s steady.txt jumping.txt || fail "fe2: other steps while the clock jumps: $(diff steady.txt jumping.txt | head -4)"

sed 's/^  accuracy: .*/  count: 40/' "$source/tests/scenes/tissue-block.yaml" >count.yaml
twice build count.yaml -d b-OUT

same b-steady.h5 b-jumping.h5 || fail "build: other records while the clock jumps"
